"""Which face or interface each triangle on the boundary of a region lies on."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from decomp.meshing.surface.cells import OUTSIDE, locate
from decomp.meshing.surface.followed import ASKED_OFF, Followed
from decomp.skeletons.certificate.distance import TriangleTree, triangle_distance, triangle_tree
from decomp.tolerance import TINY
from decomp.vectors import Array, Ints, cross, dot, norm

TURNED_COST = 3.0
"""A normal at right angles to a face's counts as much as a distance of so many tolerances."""
ANY = -2


class BoundaryTags:
    """Finds the patches of boundary triangles.

    Args:
        followed: what the mesh follows.
    """

    def __init__(self, followed: Followed) -> None:
        self._geometry, self._surface = followed.geometry, followed.surface
        self._cells, self._plan = followed.cells, followed.plan
        self._tolerance = followed.tolerance
        self._trees: dict[int, TriangleTree] = {}

    def patches(self, points: Array, triangles: Ints, regions: Ints) -> Ints:
        """The patches of triangles that bound regions[:, 0].

        A face has a say only if it has the region on their other side behind it, where any has: on
        either side of a contact regions are close that do not meet there. Of several patches of a
        face it is the nearest.
        """
        known: dict[tuple[int, int, int], list[int]] = {}
        for number, own in enumerate(self._plan.sides):
            for region, face in own:
                other = next((r for r, _ in own if r != region), OUTSIDE)
                known.setdefault((region, face, other), []).append(number)
                known.setdefault((region, face, ANY), []).append(number)
        found = np.empty(len(triangles), dtype=np.int64)
        for region, other in np.unique(regions, axis=0).tolist():
            behind = other if any((r, o) == (region, other) for r, _, o in known) else ANY
            listed = [face for r, face, o in known if (r, o) == (region, behind)]
            rows = np.flatnonzero((regions == [region, other]).all(axis=1))
            faces = self._faces(points, triangles[rows], region, listed)
            for face in np.unique(faces).tolist():
                own_rows = rows[faces == face]
                candidates = known[region, face, behind]
                found[own_rows] = self._nearest(points[triangles[own_rows]], candidates)
        return found

    def _nearest(self, corners: Array, candidates: Sequence[int]) -> Ints:
        """The nearest of some patches to the middles of triangles, given by their corners."""
        if len(candidates) == 1:
            return np.full(len(corners), candidates[0], dtype=np.int64)
        middles = corners.mean(axis=1)
        away = np.stack([triangle_distance(self._tree(k), middles) for k in candidates])
        return np.asarray(np.array(candidates)[away.argmin(axis=0)])

    def _tree(self, patch: int) -> TriangleTree:
        """The triangles of a patch; made once."""
        if patch not in self._trees:
            mesh = self._plan.complex
            self._trees[patch] = triangle_tree(mesh.points[mesh.patches[patch].triangles])
        return self._trees[patch]

    def _faces(self, points: Array, triangles: Ints, region: int, listed: Sequence[int]) -> Ints:
        """The face, of some of a region, that each triangle lies on: nearest, and turned alike."""
        corners = points[triangles]
        normal = cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        normal /= np.maximum(norm(normal), TINY)[:, None]
        middle = corners.mean(axis=1, keepdims=True)
        asked = np.concatenate([middle, middle + 0.7 * (corners - middle)], axis=1)
        asked = asked - ASKED_OFF * self._tolerance * normal[:, None]
        found = locate(self._geometry, self._cells, asked.reshape(-1, 3))
        candidates = self._cells.face[found.site].reshape(-1, 4)
        own = self._cells.region_of(found.part).reshape(-1, 4) == region
        best = np.full(len(triangles), -1, dtype=np.int64)
        least = np.full(len(triangles), np.inf)
        for face in listed:
            rows = np.flatnonzero(((candidates == face) & own).any(axis=1))
            cost = self._cost(region, face, corners[rows], normal[rows])
            better = rows[cost < least[rows]]
            least[better] = cost[cost < least[rows]]
            best[better] = face
        rows = np.flatnonzero(best < 0)
        if len(rows):
            costs = [self._cost(region, face, corners[rows], normal[rows]) for face in listed]
            best[rows] = np.asarray(listed)[np.argmin(costs, axis=0)]
        return best

    def _cost(self, region: int, face: int, corners: Array, normal: Array) -> Array:
        """How badly (k,) triangles fit a face."""
        boundary = self._surface.regions[region].boundary
        carrier = boundary.carriers[boundary.faces[face].carrier]
        outward = boundary.faces[face].outward * carrier.normal(carrier.foot(corners.mean(axis=1)))
        off = np.abs(carrier.signed_distance(corners)).max(axis=1) / self._tolerance
        return np.asarray(off + TURNED_COST * (1 - dot(outward, normal)))
