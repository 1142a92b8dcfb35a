"""Points that are asked for, as users give them."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from decomp.errors import InputError
from decomp.vectors import Array, reals

QUERIES_AT_ONCE = 1 << 17
"""So many points are looked at together."""


def checked_points(points: ArrayLike) -> Array:
    """Return points as an array (n, 3) of finite floats, without a copy where that can be."""
    try:
        given = np.ascontiguousarray(reals(points), dtype=np.float64)
    except (TypeError, ValueError, OverflowError):
        raise InputError("points must be an array of numbers of shape (n, 3)") from None
    if given.shape == (0,):
        return np.empty((0, 3))
    if given.ndim != 2 or given.shape[1] != 3:
        raise InputError(f"points must be an array of shape (n, 3), got {given.shape}")
    for start in range(0, len(given), QUERIES_AT_ONCE):
        bad = np.flatnonzero(~np.isfinite(given[start : start + QUERIES_AT_ONCE]).all(axis=1))
        if len(bad):
            at = start + int(bad[0])
            raise InputError(f"points must be finite, got {given[at].tolist()} at index {at}")
    return given
