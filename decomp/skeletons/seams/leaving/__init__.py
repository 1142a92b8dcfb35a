"""Where seams leave a junction, a reflexive axis or the centre of a ball.

Notation: g_k the gradients of the distances to the feet; seams leave along facets of their hull.
"""
