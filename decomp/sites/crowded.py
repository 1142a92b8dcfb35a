"""Which face holds a point, where one carrier has several faces of a region."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.spatial import cKDTree  # type: ignore[import-untyped]

from decomp.boundary.topology import RegionBoundary
from decomp.curves.base import Curve
from decomp.sites.occupancy import OccupancyTree
from decomp.sites.occupancy_cells import circumradius
from decomp.sites.on_boundary import ANYWHERE
from decomp.vectors import Array, Ints, dot, norm

FaceLookup = Callable[[int, int, Array], Ints]
"""(region, carrier, points on it) -> the faces of the region that hold the points."""

UNKNOWN, SEVERAL = -2, -1
NEIGHBOURS_ASKED = (12, 96)
CROWDED_STEPS = 8
POINTS_AT_ONCE = 256
"""So many points are looked at together."""
EQUAL_DISTANCES = 1e-6
"""Distances that differ by less than this part of them are equal."""


class FaceFinder:
    """Finds faces of one region, by the nearest edges and, where these leave a doubt, by `lookup`.

    A carrier is connected within any ball, as the distance to the ball's centre has one local
    minimum on it. So if all edges in a ball belong to one face of the carrier, no other face of
    it is in the ball. Hence a point is in the face whose edge is nearest to it; and leaves of the
    octree that see edges of one face only are remembered.
    """

    def __init__(
        self, boundary: RegionBoundary, region: int, occupancy: OccupancyTree, lookup: FaceLookup
    ) -> None:
        self._boundary, self._region = boundary, region
        self._occupancy, self._lookup = occupancy, lookup
        self._known = np.full(len(occupancy.leaves.carriers), UNKNOWN, dtype=np.int64)
        self._edges: dict[int, _EdgeBalls] = {}

    def find(self, carriers: Ints, feet: Array, slots: Ints) -> Ints:
        """Faces (n,) that hold feet (n, 3) on carriers (n,); slots as `on_boundary` gave them."""
        faces = np.full(len(feet), SEVERAL, dtype=np.int64)
        inside = np.flatnonzero(slots != ANYWHERE)
        new, which = np.unique(slots[inside], return_index=True)
        for slot, k in zip(new, which, strict=True):
            if self._known[slot] == UNKNOWN:
                self._known[slot] = self._only_face(int(slot), int(carriers[inside[k]]))
        faces[inside] = self._known[slots[inside]]
        left = np.flatnonzero(faces == SEVERAL)
        faces[left] = self.by_edges(carriers[left], feet[left])
        return faces

    def by_edges(
        self, carriers: Ints, feet: Array, neighbours: Sequence[int] = NEIGHBOURS_ASKED
    ) -> Ints:
        """Faces (n,) that hold feet (n, 3) on carriers (n,), by the nearest edges.

        Args:
            carriers: (n,).
            feet: (n, 3).
            neighbours: how many edges' parts are looked at, ever more until there is no doubt.
        """
        faces = np.full(len(feet), SEVERAL, dtype=np.int64)
        for count in neighbours:
            for carrier, rows in _groups(carriers, np.flatnonzero(faces == SEVERAL)):
                faces[rows] = self._edges_on(carrier).owners(feet[rows], count)
        for carrier, rows in _groups(carriers, np.flatnonzero(faces == SEVERAL)):
            faces[rows] = self._edges_on(carrier).nearest(feet[rows])
        for carrier, rows in _groups(carriers, np.flatnonzero(faces == SEVERAL)):
            faces[rows] = self._lookup(self._region, carrier, feet[rows])
        return faces

    @cached_property
    def _balls(self) -> Array:
        return leaf_balls(self._occupancy)

    def _only_face(self, slot: int, carrier: int) -> int:
        leaf = int(np.searchsorted(self._occupancy.leaves.first_carrier, slot, side="right")) - 1
        seen = self._edges_on(carrier).within(self._balls[leaf, :3], self._balls[leaf, 3])
        return int(seen[0]) if len(seen) == 1 else SEVERAL

    def _edges_on(self, carrier: int) -> _EdgeBalls:
        if carrier not in self._edges:
            self._edges[carrier] = _edge_balls(self._boundary, carrier)
        return self._edges[carrier]


@dataclass(frozen=True, eq=False)
class _EdgeBalls:
    """Balls that cover the edges of the faces on one carrier.

    Args:
        centres, radii: of the balls (n,).
        faces: the face (n,) of each.
        edges: curves with their start, their end and the number of balls on them, in order.
    """

    centres: cKDTree
    radii: Array
    faces: Ints
    edges: list[tuple[Curve, float, float, int]]

    def within(self, centre: Array, radius: float) -> Ints:
        """The faces that may have an edge within a ball."""
        reach = radius + self.radii.max()
        near = np.array(self.centres.query_ball_point(centre, reach), dtype=np.int64)
        gaps = np.linalg.norm(self.centres.data[near] - centre, axis=1)
        return np.unique(self.faces[near[gaps <= radius + self.radii[near]]])

    def owners(self, points: Array, count: int) -> Ints:
        """The faces with the edges nearest to points (n, 3), SEVERAL where that is not certain.

        That is told from the `count` nearest balls.
        """
        count = min(count, len(self.faces))
        gaps, near = self.centres.query(points, k=np.arange(1, count + 1))
        reach = gaps + self.radii[near]
        row, first = np.arange(len(points)), reach.argmin(axis=1)
        bound, owner = reach[row, first], self.faces[near[row, first]]
        rivals = (self.faces[near] != owner[:, None]) & (gaps - self.radii[near] <= bound[:, None])
        certain = ~rivals.any(axis=1)
        if count < len(self.faces):
            certain &= gaps[:, -1] - self.radii.max() > bound
        return np.where(certain, owner, SEVERAL)

    def nearest(self, points: Array) -> Ints:
        """The faces with the edges exactly nearest to points (n, 3), SEVERAL for equally near ones.

        Near a point where edges cross tangentially balls say nothing.
        """
        found = np.empty(len(points), dtype=np.int64)
        for start in range(0, len(points), POINTS_AT_ONCE):
            found[start : start + POINTS_AT_ONCE] = self._nearest(
                points[start : start + POINTS_AT_ONCE]
            )
        return found

    def _nearest(self, points: Array) -> Ints:
        gaps = norm(points[:, None] - self.centres.data[None])
        near = gaps - self.radii <= (gaps + self.radii).min(axis=1)[:, None]
        names = np.unique(self.faces)
        least = np.full((len(points), len(names) + 1), np.inf)
        first = 0
        for curve, start, end, count in self.edges:
            row, ball = np.nonzero(near[:, first : first + count])
            if len(row):
                column, part = int(np.searchsorted(names, self.faces[first])), (end - start) / count
                low: Array = start + ball.astype(np.float64) * part
                np.minimum.at(least[:, column], row, _gaps(curve, low, low + part, points[row]))
            first += count
        order = np.argsort(least, axis=1, kind="stable")
        best, second = (np.take_along_axis(least, order[:, [k]], axis=1)[:, 0] for k in (0, 1))
        one = ~(second <= (1 + EQUAL_DISTANCES) * best)
        return np.where(one, names[np.minimum(order[:, 0], len(names) - 1)], SEVERAL)


def _gaps(curve: Curve, low: Array, high: Array, points: Array) -> Array:
    """The distance of points (k, 3) from a part (k,) each of a curve that is close to them."""
    t = (low + high) / 2
    for _ in range(CROWDED_STEPS):
        tangent = curve.derivative(curve.wrapped(t))
        step = dot(points - curve.point(curve.wrapped(t)), tangent) / dot(tangent, tangent)
        t = np.clip(t + step, low, high)
    return norm(points - curve.point(curve.wrapped(t)))


def _groups(carriers: Ints, rows: Ints) -> list[tuple[int, Ints]]:
    """Rows by their carriers."""
    return [(int(k), rows[carriers[rows] == k]) for k in np.unique(carriers[rows])]


def _edge_balls(boundary: RegionBoundary, carrier: int) -> _EdgeBalls:
    on_carrier = [
        (edge, face)
        for edge in boundary.edges
        for face in edge.faces
        if boundary.faces[face].carrier == carrier
    ]
    chord = min(edge.length for edge, _ in on_carrier) / 16
    centres, radii, faces, edges = [], [], [], []
    for edge, face in on_carrier:
        count = int(np.clip(edge.length / chord, 32, 1024))
        points = edge.curve.point(np.linspace(edge.start, edge.end, count + 1))
        centres.append((points[1:] + points[:-1]) / 2)
        radii.append(0.75 * np.linalg.norm(np.diff(points, axis=0), axis=1))
        faces.append(np.full(count, face))
        edges.append((edge.curve, edge.start, edge.end, count))
    tree = cKDTree(np.concatenate(centres))
    return _EdgeBalls(tree, np.concatenate(radii), np.concatenate(faces), edges)


def leaf_balls(occupancy: OccupancyTree) -> Array:
    """Centre and radius (n, 4) of a ball around each leaf."""
    grid, links = occupancy.tree.grid, occupancy.tree.links.astype(np.int64)
    index = np.stack(np.meshgrid(*(np.arange(s) for s in grid.shape), indexing="ij"), axis=-1)
    centres = grid.low + grid.size * (index.reshape(-1, 3) + 0.5)
    octants = 2 * np.array([[o >> 2 & 1, o >> 1 & 1, o & 1] for o in range(8)]) - 1
    balls = np.empty((len(occupancy.leaves.whole), 4))
    nodes, half = np.arange(len(centres)), grid.size / 2
    while len(nodes):
        link = links[nodes]
        ends = link < 0
        # leaves that share a number have no carriers, so that nobody asks for their ball
        balls[-1 - link[ends], :3] = centres[ends]
        balls[-1 - link[ends], 3] = circumradius(half, occupancy.rounding)
        half /= 2
        nodes = (link[~ends, None] + np.arange(8)).ravel()
        centres = (centres[~ends, None, :] + half * octants).reshape(-1, 3)
    return balls
