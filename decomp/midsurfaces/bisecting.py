"""Triangles of several surfaces that share edges, cut at points on edges; all stay conforming."""

from __future__ import annotations

import numpy as np

from decomp.complex.model import SIDES, CurveElement
from decomp.vectors import Array, Ints, norm


class Bisected:
    """Triangles whose edges can be cut, with a value at each corner.

    Args:
        points: (n, 3).
        triangles: (m, 3).
        owner: (m,) the surface of each triangle.
        curves: the curve of each edge (lower point first) that lies on one.

    Attributes:
        value: (m, 3) at each triangle's corners; a point has one value for each surface.
    """

    def __init__(
        self,
        points: Array,
        triangles: Ints,
        owner: Ints,
        curves: dict[tuple[int, int], CurveElement],
    ) -> None:
        self.points, self.triangles, self.owner = points, triangles, owner
        self.curves = curves
        self.value: Array = np.zeros(triangles.shape)

    def sides(self) -> tuple[Ints, Ints]:
        """The distinct edges (e, 2), lower point first, and which each side (m, 3) is."""
        every = np.sort(self.triangles[:, SIDES].reshape(-1, 2), axis=1)
        edges, which = np.unique(every, axis=0, return_inverse=True)
        return edges, which.reshape(-1, 3)

    def cut(self, edges: Ints, points: Array, value: Array) -> None:
        """Cut edges, and all triangles that have them.

        Args:
            edges: (k, 2) distinct, lower point first.
            points: (k, 3) where each is cut.
            value: (k, s) at each of these points on each of the surfaces.
        """
        first = len(self.points)
        self.points = np.concatenate([self.points, points])
        for row, (a, b) in enumerate(edges.tolist()):
            curve = self.curves.pop((a, b), None)
            if curve is not None:
                self.curves[a, first + row] = self.curves[b, first + row] = curve
        base = first + len(points)
        keys = edges[:, 0] * base + edges[:, 1]
        order = np.argsort(keys)
        keys = keys[order]
        while True:
            ends = np.sort(self.triangles[:, SIDES], axis=2)
            sought = ends[..., 0] * base + ends[..., 1]
            place = np.minimum(np.searchsorted(keys, sought), len(keys) - 1)
            found = keys[place] == sought
            rows = np.flatnonzero(found.any(axis=1))
            if not len(rows):
                return
            ends = ends[rows]
            length = norm(self.points[ends[..., 1]] - self.points[ends[..., 0]])
            side = np.where(found[rows], length, -1.0).argmax(axis=1)
            row = order[place[rows, side]]
            self._halve(rows, side, first + row, value[row, self.owner[rows]])

    def _halve(self, rows: Ints, side: Ints, vertex: Ints, value: Array) -> None:
        """Cut each of some triangles from a new vertex on one side to the opposite corner."""
        a, b, c = (side + k for k in (0, 1, 2))
        corner = [self.triangles[rows, k % 3] for k in (a, b, c)]
        at = [self.value[rows, k % 3] for k in (a, b, c)]
        self.triangles[rows] = np.stack([corner[0], vertex, corner[2]], axis=1)
        self.value[rows] = np.stack([at[0], value, at[2]], axis=1)
        self.triangles = np.concatenate(
            [self.triangles, np.stack([vertex, corner[1], corner[2]], axis=1)]
        )
        self.value = np.concatenate([self.value, np.stack([value, at[1], at[2]], axis=1)])
        self.owner = np.concatenate([self.owner, self.owner[rows]])
