"""What is a touch of a curve and a carrier, where the curve dips through by a tolerance at most.

Where two carriers are tangent the curves of the one touch the other, and what little they go
through is rounding. Elsewhere such a dip is two crossings: three carriers that pass close to one
another cross in points apart from each other, and each of their three curves has to find the same.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from decomp.vectors import Array, Bools

Touching = Callable[[Array], Bools]
"""Tells for points (n, 3) whether a curve that dips through a carrier there touches it."""

CROSSINGS_APART = 20.0
"""Crossings are two if they are further from each other than so many tolerances."""


def anywhere(points: Array) -> Bools:
    """Every dip is a touch."""
    return np.ones(len(points), dtype=np.bool_)
