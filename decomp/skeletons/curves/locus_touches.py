"""Where a trim comes to a reflexive locus and turns back.

The balls over an edge have their centres on the normals of a face. Where such a centre reaches the
face's reflexive locus without going on along it, the trim has a cusp: it must be cut there.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from decomp.skeletons.seams.minima import least_values
from decomp.vectors import Array

CLOSE = 0.05
"""Minima of the gap below this part of the size are looked at more closely."""
ZERO = 1e-9
RESOLUTION = 1e-9
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
    rows = np.flatnonzero(least) + 1
    places, values = least_values(lambda _, at: gap(at), s[rows - 1], s[rows + 1], RESOLUTION)
    found: list[float] = []
    for at, value, width in zip(
        places.tolist(), values.tolist(), (s[rows + 1] - s[rows - 1]).tolist(), strict=True
    ):
        slack = BESIDE * width
        inside = s[0] + slack < at < s[-1] - slack
        if inside and value <= ZERO * size and all(abs(at - x) > slack for x in found):
            found.append(at)
    return found
