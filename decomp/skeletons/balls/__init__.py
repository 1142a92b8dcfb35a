"""Maximal balls and equidistant points: what everything else is traced by.

Notation: p a centre, r its radius, q_k its feet, g_k = (p - q_k) / r; balance is the measure by
which distances to several sites differ at p.
"""
