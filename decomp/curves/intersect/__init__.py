"""Intersection of two carriers: every curve, contact point and node of it."""

from decomp.curves.intersect.dispatch import intersect
from decomp.curves.intersect.result import Intersection, PairCurve

__all__ = ["Intersection", "PairCurve", "intersect"]
