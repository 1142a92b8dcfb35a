"""Curves of the skeleton: trims, rims, reflexive loci, and all of a region's put together.

Notation: e(t) a point of an edge, n_f(t) the normal of its face f there, r(t) the radius of the
ball that touches e(t): a trim is e(t) + r(t) n_f(t).
"""
