"""Curves in which two carriers meet, and the points where curves meet carriers."""

from decomp.curves.base import Curve
from decomp.curves.circle import Circle
from decomp.curves.crossings import Crossings, crossing_candidates, crossings, may_cross
from decomp.curves.ellipse import Ellipse
from decomp.curves.hyperbola import Hyperbola
from decomp.curves.intersect import Intersection, PairCurve, intersect
from decomp.curves.line import Line
from decomp.curves.meeting import may_meet, meeting_pairs
from decomp.curves.parabola import Parabola
from decomp.curves.traced import TracedCurve

__all__ = [
    "Circle",
    "Crossings",
    "Curve",
    "Ellipse",
    "Hyperbola",
    "Intersection",
    "Line",
    "PairCurve",
    "Parabola",
    "TracedCurve",
    "crossing_candidates",
    "crossings",
    "intersect",
    "may_cross",
    "may_meet",
    "meeting_pairs",
]
