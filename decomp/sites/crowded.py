"""Which face holds a point, where one carrier has several faces of a region."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from decomp.boundary.topology import RegionBoundary
from decomp.sites.occupancy import ANYWHERE, OccupancyTree
from decomp.vectors import Array, Ints

FaceLookup = Callable[[int, int, Array], Ints]
"""(region, carrier, points on it) -> the faces of the region that hold the points."""

UNKNOWN, SEVERAL = -2, -1


class FaceFinder:
    """Finds faces of one region, remembering leaves of the octree that see only one face.

    Within the ball around a leaf a carrier is connected. So if the edges in the ball belong to
    one face of the carrier, or if there are none, only one face is there.
    """

    def __init__(
        self, boundary: RegionBoundary, region: int, occupancy: OccupancyTree, lookup: FaceLookup
    ) -> None:
        self._boundary, self._region = boundary, region
        self._occupancy, self._lookup = occupancy, lookup
        self._known = np.full(len(occupancy.leaves.carriers), UNKNOWN, dtype=np.int64)
        self._balls = leaf_balls(occupancy)
        self._edges: dict[int, tuple[Array, Array, Ints]] = {}

    def find(self, carriers: Ints, feet: Array, slots: Ints) -> Ints:
        """Faces (n,) that hold feet (n, 3) on carriers (n,); slots as `on_boundary` gave them."""
        faces = np.full(len(feet), SEVERAL, dtype=np.int64)
        inside = np.flatnonzero(slots != ANYWHERE)
        new, which = np.unique(slots[inside], return_index=True)
        for slot, k in zip(new, which, strict=True):
            if self._known[slot] == UNKNOWN:
                at = inside[k]
                self._known[slot] = self._only_face(int(slot), int(carriers[at]), feet[at])
        faces[inside] = self._known[slots[inside]]
        rest = np.flatnonzero(faces == SEVERAL)
        for carrier in np.unique(carriers[rest]):
            part = rest[carriers[rest] == carrier]
            faces[part] = self._lookup(self._region, int(carrier), feet[part])
        return faces

    def _only_face(self, slot: int, carrier: int, foot: Array) -> int:
        leaf = int(np.searchsorted(self._occupancy.leaves.first_carrier, slot, side="right")) - 1
        centre, radius = self._balls[leaf, :3], self._balls[leaf, 3]
        points, reach, faces = self._edges_on(carrier)
        near = np.linalg.norm(points - centre, axis=1) <= radius + reach
        seen = np.unique(faces[near])
        if len(seen) > 1:
            return SEVERAL
        if len(seen) == 1:
            return int(seen[0])
        return int(self._lookup(self._region, carrier, foot[None])[0])

    def _edges_on(self, carrier: int) -> tuple[Array, Array, Ints]:
        """Balls that cover the edges of a carrier's faces: centres, radii, and the face."""
        if carrier not in self._edges:
            centres: list[Array] = [np.empty((0, 3))]
            radii: list[Array] = [np.empty(0)]
            faces: list[Ints] = [np.empty(0, dtype=np.int64)]
            for edge in self._boundary.edges:
                points = edge.curve.point(np.linspace(edge.start, edge.end, 65))
                chord = np.linalg.norm(np.diff(points, axis=0), axis=1)
                for face in edge.faces:
                    if self._boundary.faces[face].carrier == carrier:
                        centres.append((points[1:] + points[:-1]) / 2)
                        radii.append(0.75 * chord)
                        faces.append(np.full(len(chord), face))
            self._edges[carrier] = (
                np.concatenate(centres), np.concatenate(radii), np.concatenate(faces)
            )
        return self._edges[carrier]


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
        balls[-1 - link[ends], 3] = np.sqrt(3.0) * half * (1 + 1e-9) + occupancy.rounding
        half /= 2
        nodes = (link[~ends, None] + np.arange(8)).ravel()
        centres = (centres[~ends, None, :] + half * octants).reshape(-1, 3)
    return balls
