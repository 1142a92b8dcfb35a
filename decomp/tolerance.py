"""The one tolerance of the package."""

from typing import Final

TOLERANCE: Final = 1e-9
"""Lengths below `TOLERANCE` times the model's diagonal count as zero.

It decides when two carriers coincide and when two points are one. Computed points are far
more exact than that: Newton's method brings them to about 1e-15 of the diagonal.
"""
