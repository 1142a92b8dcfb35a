"""Sheets of the skeleton, each drawn over its footprint: the points of a face that its balls touch.

Notation: (u, v) a point of a footprint, p(u, v) the centre of the maximal ball that touches there.
"""
