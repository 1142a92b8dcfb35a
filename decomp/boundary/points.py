"""A table of points in which equal points (within a tolerance) have one index."""

from __future__ import annotations

from itertools import product

import numpy as np

from decomp.vectors import Array

CELLS_AROUND = tuple(product((-1, 0, 1), repeat=3))


class PointTable:
    """Points met one by one, welded by position with the help of a hash grid."""

    def __init__(self, tolerance: float) -> None:
        self._tolerance = tolerance
        self._points: list[Array] = []
        self._cells: dict[tuple[int, ...], list[int]] = {}

    def add(self, point: Array) -> int:
        """Index of the point, a new one unless a point within the tolerance is known."""
        cell = tuple(int(c) for c in np.floor(point / (4 * self._tolerance)))
        for step in CELLS_AROUND:
            for index in self._cells.get(tuple(c + s for c, s in zip(cell, step, strict=True)), ()):
                if float(np.linalg.norm(self._points[index] - point)) <= self._tolerance:
                    return index
        self._points.append(point)
        self._cells.setdefault(cell, []).append(len(self._points) - 1)
        return len(self._points) - 1

    def points(self) -> Array:
        """All points (n, 3) in order of their indices."""
        return np.array(self._points).reshape(-1, 3)
