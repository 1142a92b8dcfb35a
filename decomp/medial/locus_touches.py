"""Where a trim comes to a reflexive locus and turns back.

The balls over an edge have their centres on the normals of a face. Where such a centre reaches the
face's reflexive locus without going on along it, the trim has a cusp: it must be cut there.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.optimize import minimize_scalar  # type: ignore[import-untyped]

from decomp.vectors import Array

CLOSE = 0.05
"""Minima of the gap below this part of the size are looked at more closely."""
ZERO = 1e-9
BESIDE = 1e-3
"""Touches nearer to the ends than this part of an interval between samples are the ends."""


def touches(size: float, s: Array, gap: Callable[[Array], Array]) -> list[float]:
    """Parameters at which the gap between a trim and a reflexive locus vanishes, and grows again.

    Args:
        size: of the region.
        s: (n,) parameters of samples, ascending.
        gap: of parameters (k,), in units of length.
    """
    if len(s) < 3:
        return []
    values = gap(s)
    inner = values[1:-1]
    least = (inner <= values[:-2]) & (inner <= values[2:]) & (inner < CLOSE * size)
    found: list[float] = []
    for k in np.flatnonzero(least) + 1:
        low, high = float(s[k - 1]), float(s[k + 1])
        best = minimize_scalar(
            lambda x: float(gap(np.array([x]))[0]),
            bounds=(low, high),
            method="bounded",
            options={"xatol": 1e-9 * (high - low)},
        )
        at, slack = float(best.x), BESIDE * (high - low)
        inside = s[0] + slack < at < s[-1] - slack
        if inside and float(best.fun) <= ZERO * size and all(abs(at - x) > slack for x in found):
            found.append(at)
    return found
