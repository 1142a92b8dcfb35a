"""Distances from lines of segments."""

from __future__ import annotations

import numpy as np

from decomp.tolerance import TINY
from decomp.vectors import Array, norm


def polyline_distance(line: Array, places: Array) -> Array:
    """Distances (k,) of places (k, 3) from a polyline (n, 3)."""
    start, way = line[:-1], np.diff(line, axis=0)
    length = np.maximum((way**2).sum(axis=1), TINY)
    least = np.full(len(places), np.inf)
    for a, w, square in zip(start, way, length, strict=True):
        t = np.clip((places - a) @ w / square, 0, 1)
        least = np.minimum(least, norm(places - a - t[:, None] * w))
    return least
