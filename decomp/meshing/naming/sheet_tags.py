"""Which sheet each triangle inside a region lies on."""

from __future__ import annotations

import numpy as np

from decomp.meshing.surface.cells import locate
from decomp.meshing.surface.followed import ASKED_OFF, Followed
from decomp.skeletons.certificate.distance import triangle_distance, triangle_tree
from decomp.tolerance import TINY
from decomp.vectors import Array, Bools, Ints, cross, norm

FEET_JUMP = 4.0
"""Feet jump across a sheet by at least so many tolerances."""
OWN_SHEET = 1.2
"""Nodes on the sheet of an edge with itself are at most so many tolerances off it at first."""


class SheetTags:
    """Finds the sheets of triangles.

    Args:
        followed: what the mesh follows.
    """

    def __init__(self, followed: Followed) -> None:
        self._geometry, self._surface = followed.geometry, followed.surface
        self._cells, self._plan = followed.cells, followed.plan
        self._tolerance = followed.tolerance

    def between(self, points: Array, triangles: Ints, sides: Ints) -> Ints:
        """The sheets of triangles between cells (k, 2) of one region.

        Where no sheet parts the two it is the nearest one of either.
        """
        found = np.full(len(triangles), -1, dtype=np.int64)
        corners = points[triangles]
        pairs, which = np.unique(sides, axis=0, return_inverse=True)
        for number, (low, high) in enumerate(pairs.tolist()):
            rows = np.flatnonzero(which.reshape(-1) == number)
            candidates = self._plan.between.get((low, high), ())
            if len(candidates) == 1:
                found[rows] = candidates[0]
            else:
                found[rows] = self._nearest(corners[rows], candidates or self._of_either(low, high))
        return found

    def inside(self, points: Array, triangles: Ints, parts: Ints) -> Ints:
        """The sheets inside cells that triangles lie on, -1 for those on none.

        Between two sites there may be a trim as well, across which the foot does not jump.
        """
        found = np.full(len(triangles), -1, dtype=np.int64)
        if not len(triangles):
            return found
        pairs: dict[tuple[int, int], list[int]] = {}
        for region in self._surface.regions:
            for patch, sites in region.sheets.items():
                low, high = sorted(int(self._cells.part[site]) for site in sites)
                if patch in self._plan.inside and low != high:
                    pairs.setdefault((low, high), []).append(patch)
        corners = points[triangles]
        jumps = self._jumps(corners)
        ordered = np.sort(parts, axis=1)
        for (low, high), patches in pairs.items():
            rows = np.flatnonzero(jumps & (ordered == (low, high)).all(axis=1))
            if len(rows):
                found[rows] = self._nearest(corners[rows], tuple(patches))
        return found

    def alone(self, points: Array, triangles: Ints, parts: Ints) -> Ints:
        """The sheet of an edge with itself that each triangle lies on, -1 for those on none."""
        found = np.full(len(triangles), -1, dtype=np.int64)
        mesh = self._plan.complex
        for region in self._surface.regions:
            for patch, (one, two) in region.sheets.items():
                if one != two:
                    continue
                rows = np.flatnonzero((parts == self._cells.part[one]).all(axis=1))
                corners = mesh.points[mesh.patches[patch].triangles]
                near = self._near(points, np.unique(triangles[rows]), corners)
                rows = rows[near[triangles[rows]].all(axis=1)]
                found[rows[self._jumps(points[triangles[rows]])]] = patch
        return found

    def _near(self, points: Array, nodes: Ints, corners: Array) -> Bools:
        """Which of all points are nodes within some tolerances of triangles with given corners."""
        reach = OWN_SHEET * self._tolerance
        low, high = corners.min(axis=(0, 1)) - reach, corners.max(axis=(0, 1)) + reach
        nodes = nodes[((points[nodes] >= low) & (points[nodes] <= high)).all(axis=1)]
        near = np.zeros(len(points), dtype=np.bool_)
        near[nodes] = triangle_distance(triangle_tree(corners), points[nodes]) <= reach
        return near

    def _of_either(self, low: int, high: int) -> tuple[int, ...]:
        """The patches at either of two cells that no patch parts."""
        return tuple(
            patch
            for pair, patches in self._plan.between.items()
            if low in pair or high in pair
            for patch in patches
        )

    def _nearest(self, corners: Array, candidates: tuple[int, ...]) -> Ints:
        """The nearest of some patches to the middles of triangles."""
        mesh, middles = self._plan.complex, corners.mean(axis=1)
        trees = [triangle_tree(mesh.points[mesh.patches[k].triangles]) for k in candidates]
        away = np.stack([triangle_distance(tree, middles) for tree in trees])
        return np.asarray(np.array(candidates)[away.argmin(axis=0)])

    def _jumps(self, corners: Array) -> Bools:
        """Whether the feet on both sides of triangles, given by their corners, are far apart."""
        normal = cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        way = normal * (ASKED_OFF * self._tolerance / np.maximum(norm(normal), TINY))[:, None]
        middle = corners.mean(axis=1)
        asked = np.concatenate([middle - way, middle + way])
        feet = locate(self._geometry, self._cells, asked).foot.reshape(2, -1, 3)
        return np.asarray(norm(feet[0] - feet[1]) > FEET_JUMP * self._tolerance)
