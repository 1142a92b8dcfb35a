"""Sheets cut exactly along the curve on which the angle between their feet has a given value.

1. Edges are halved until the angle is nearly linear along those that the curve may cross, and the
   radius along all.
2. On each sheet, edges whose ends are on different sides are cut at the exact point between.

All sheets are cut as one, so that they go on sharing their edges. A sheet's angle at a point is one
number, also where the sheet ends and it has none by itself (at the end of a reentrant edge, on the
axis of a cylinder): there the mean over what is seen from a little way inside counts.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import radians

import numpy as np

from decomp.complex.model import SIDES, CurveElement
from decomp.errors import GeometryError
from decomp.midsurfaces.bisecting import Bisected
from decomp.midsurfaces.facing_sheets import FacingSheet
from decomp.vectors import Array, Bools, Ints, norm

LINEAR = radians(1.0)
"""How far the angle at the middle of an edge may be off the mean of its ends."""
EQUAL_ANGLES = 1e-7
"""Angles that differ by less count as equal."""
LOOK_INSIDE = 1e-3
"""How far towards a triangle's centre is looked, in parts of the way, where a corner has none."""
HALVING_ROUNDS, SEARCHES = 14, 80
AT_CORNER = 1e-6
"""A crossing nearer to a corner than this part of the tolerance is at it."""
AT_LEVEL = 1e-12
"""An angle (radians) so near to the level is on it."""
NO_MORE_OF_EDGE = 1e-13
"""Part of an edge below which its crossing is not looked for more closely."""


class LevelCut:
    """Triangles of sheets, cut along a level of the angle between their feet.

    Args:
        surfaces: of the sheets.
        points: (n, 3), on the sheets.
        triangles: (m, 3).
        owner: (m,) the sheet of each triangle.
        curves: the curve of each edge (lower point first) that lies on one.
        level: the angle, in radians.
        tolerance: by how much a linear radius may be off; edges shorter than this are not halved.
    """

    def __init__(
        self,
        surfaces: Sequence[FacingSheet],
        points: Array,
        triangles: Ints,
        owner: Ints,
        curves: dict[tuple[int, int], CurveElement],
        level: float,
        tolerance: float,
    ) -> None:
        self._surfaces, self._level, self._tolerance = surfaces, level, tolerance
        self.mesh = Bisected(points, triangles, owner, curves)
        corners = points[triangles]
        key = owner[:, None] * len(points) + triangles
        self.mesh.value = self._filled(
            key.reshape(-1),
            np.repeat(owner, 3),
            corners.reshape(-1, 3),
            np.repeat(corners.mean(axis=1), 3, axis=0),
        ).reshape(-1, 3)

    def done(self) -> Bisected:
        """Halve and cut; every triangle is then on one side of the level.

        Raises:
            GeometryError: the angle stays far from linear however short the edges are.
        """
        for _ in range(HALVING_ROUNDS):
            if not self._halve():
                break
        else:
            raise GeometryError(
                f"sheets cannot be cut where their feet face each other by "
                f"{np.degrees(self._level):g} degrees: edges were halved {HALVING_ROUNDS} times "
                "and the angle still changes unevenly along them; ask for a little more or less"
            )
        while self._cut():
            pass
        return self.mesh

    def above(self) -> Bools:
        """Which triangles are on the side of larger angles, after `done`."""
        mesh = self.mesh
        value = mesh.value - self._level
        middle = mesh.points[mesh.triangles].mean(axis=1)
        even = (np.abs(value) <= EQUAL_ANGLES).all(axis=1)
        value[even] = self._facing(mesh.owner[even], middle[even])[0][:, None] - self._level
        return np.asarray((value > EQUAL_ANGLES).any(axis=1))

    def _halve(self) -> int:
        """Cut at their middles edges along which angle or radius is far from linear; how many."""
        mesh = self.mesh
        edges, which = mesh.sides()
        owner, side, t, k = self._of_sheets(which)
        middle = self._placed(edges, mesh.points[edges].mean(axis=1), owner, side)
        at = middle[side]
        facing = self._filled(
            owner * len(edges) + side, owner, at, mesh.points[mesh.triangles[t]].mean(axis=1)
        )
        a, b = mesh.value[t, SIDES[k, 0]], mesh.value[t, SIDES[k, 1]]
        ends = mesh.points[edges[side]]
        short = norm(ends[:, 1] - ends[:, 0]) <= self._tolerance
        off = np.abs(facing - (a + b) / 2)
        low, high = np.minimum(np.minimum(a, b), facing), np.maximum(np.maximum(a, b), facing)
        bad = (off > LINEAR) & (low - off < self._level) & (high + off > self._level)
        radii = [self._facing(owner, x)[1] for x in (ends[:, 0], at, ends[:, 1])]
        bad |= np.abs(radii[1] - (radii[0] + radii[2]) / 2) > self._tolerance
        chosen = np.unique(side[bad & ~short])
        if len(chosen):
            table = self._table(len(edges), owner, side, facing)
            mesh.cut(edges[chosen], middle[chosen], table[chosen])
        return len(chosen)

    def _cut(self) -> int:
        """Cut edges whose ends are on different sides of the level on one sheet; how many."""
        mesh = self.mesh
        edges, which = mesh.sides()
        owner, side, t, k = self._of_sheets(which)
        start = mesh.triangles[t, SIDES[k, 0]] == edges[side, 0]
        ends = np.stack([mesh.value[t, SIDES[k, j]] for j in (0, 1)], axis=1) - self._level
        ends = np.where(start[:, None], ends, ends[:, ::-1])
        crossing = np.flatnonzero(
            (ends.min(axis=1) < -EQUAL_ANGLES) & (ends.max(axis=1) > EQUAL_ANGLES)
        )
        # a point lies on the levels of several sheets at different places: one sheet at a time
        _, first = np.unique(side[crossing], return_index=True)
        rows = crossing[first]
        if not len(rows):
            return 0
        along, points = self._crossings(edges[side[rows]], owner[rows], ends[rows])
        gap = norm(points[:, None] - mesh.points[edges[side[rows]]]).min(axis=1)
        near = gap <= AT_CORNER * self._tolerance
        for row, share in zip(rows[near], along[near], strict=True):
            # the crossing is at a corner, which counts as on the level from now on
            corner = edges[side[row], int(share > 0.5)]
            own = mesh.owner[:, None] == owner[row]
            mesh.value[own & (mesh.triangles == corner)] = self._level
        rows, points = rows[~near], points[~near]
        if len(rows):
            chosen = np.isin(side, side[rows])
            number = np.searchsorted(side[rows], side[chosen])
            centre = mesh.points[mesh.triangles[t[chosen]]].mean(axis=1)
            key = owner[chosen] * len(edges) + side[chosen]
            facing = self._filled(key, owner[chosen], points[number], centre)
            table = self._table(len(rows), owner[chosen], number, facing)
            table[np.arange(len(rows)), owner[rows]] = self._level
            mesh.cut(edges[side[rows]], points, table)
        return len(rows) + int(near.sum())

    def _crossings(self, edges: Ints, owner: Ints, ends: Array) -> tuple[Array, Array]:
        """Where edges (k, 2) cross the level on a sheet each: share of the way (k,), point (k, 3).

        Args:
            edges, owner: of each crossing; the edges are distinct.
            ends: (k, 2) the angle at both ends above the level.

        The method of false position, with the Illinois rule, and halving where it is slow.
        """
        corners = self.mesh.points[edges]
        low, high = np.zeros(len(edges)), np.ones(len(edges))
        at_low, at_high = ends[:, 0].copy(), ends[:, 1].copy()
        along, points = np.zeros(len(edges)), corners[:, 0].copy()
        left = np.arange(len(edges))
        for turn in range(SEARCHES):
            share = at_low / (at_low - at_high) if turn % 3 else np.full(len(edges), 0.5)
            along[left] = (low + share * (high - low))[left]
            chord = corners[:, 0] + along[:, None] * (corners[:, 1] - corners[:, 0])
            own = np.arange(len(left))
            points[left] = self._placed(edges[left], chord[left], owner[left], own)
            value = np.zeros(len(edges))
            value[left] = self._facing(owner[left], points[left])[0] - self._level
            value = np.where(np.isnan(value), at_low, value)
            same = np.sign(value) == np.sign(at_low)
            at_high = np.where(same, at_high / (2 if turn % 3 else 1), value)
            at_low = np.where(same, value, at_low / (2 if turn % 3 else 1))
            low, high = np.where(same, along, low), np.where(same, high, along)
            left = left[(np.abs(value[left]) > AT_LEVEL) & ((high - low)[left] > NO_MORE_OF_EDGE)]
            if not len(left):
                break
        return along, points

    def _of_sheets(self, which: Ints) -> tuple[Ints, Ints, Ints, Ints]:
        """For each side of each triangle: sheet, edge, triangle, number of the side."""
        owner = np.repeat(self.mesh.owner, 3)
        t, k = np.divmod(np.arange(which.size), 3)
        return owner, which.reshape(-1), t, k

    def _table(self, count: int, owner: Ints, side: Ints, value: Array) -> Array:
        """Values (count, s) at points on edges, on each sheet that has them."""
        table = np.full((count, len(self._surfaces)), np.nan)
        table[side, owner] = value
        return table

    def _placed(self, edges: Ints, points: Array, owner: Ints, side: Ints) -> Array:
        """Points (k, 3) near edges (k, 2), moved onto the edges' curves or else the sheets.

        Args:
            edges, points: each edge once.
            owner, side: sheets, and the edges on them (rows of `edges`).
        """
        moved = points.copy()
        groups: dict[int, tuple[CurveElement | FacingSheet, list[int]]] = {}
        sheet = np.empty(len(edges), dtype=np.int64)
        sheet[side] = owner
        for row, (a, b) in enumerate(edges.tolist()):
            element = self.mesh.curves.get((a, b)) or self._surfaces[sheet[row]]
            groups.setdefault(id(element), (element, []))[1].append(row)
        for element, rows in groups.values():
            moved[rows] = element.place(points[rows])
        return moved

    def _filled(self, key: Ints, owner: Ints, points: Array, centre: Array) -> Array:
        """Angles (k,) at points on sheets, one for each key, also where a point has none.

        Args:
            key: (k,) equal where the same point of the same sheet is meant.
            owner, points: of each.
            centre: (k, 3) of a triangle at the point.
        """
        _, first, place_of = np.unique(key, return_index=True, return_inverse=True)
        value = self._facing(owner[first], points[first])[0]
        lost = np.flatnonzero(np.isnan(value)[place_of])
        if len(lost):
            inside = points[lost] + LOOK_INSIDE * (centre[lost] - points[lost])
            for sheet in np.unique(owner[lost]):
                rows = owner[lost] == sheet
                inside[rows] = self._surfaces[sheet].place(inside[rows])
            seen = self._facing(owner[lost], inside)[0]
            if np.isnan(seen).any():
                raise GeometryError(
                    "the angle between the feet of the sheet at {at} is unknown",
                    at=inside[np.argmax(np.isnan(seen))],
                )
            total = np.bincount(place_of[lost], seen, minlength=len(first))
            count = np.bincount(place_of[lost], minlength=len(first))
            value = np.where(count > 0, total / np.maximum(count, 1), value)
        return np.asarray(value[place_of])

    def _facing(self, owner: Ints, points: Array) -> tuple[Array, Array]:
        """The angle and the radius (k,) at points on a sheet each."""
        angle, radius = np.empty(len(points)), np.empty(len(points))
        order = np.argsort(owner, kind="stable")
        for rows in np.split(order, np.flatnonzero(np.diff(owner[order])) + 1):
            if len(rows):
                surface = self._surfaces[owner[rows[0]]]
                angle[rows], radius[rows] = surface.facing(points[rows])
        return angle, radius
