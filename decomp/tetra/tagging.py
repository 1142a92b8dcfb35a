"""Which patch of the complex each triangle between different cells lies on."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree  # type: ignore[import-untyped]

from decomp.certificate.distance import triangle_distance, triangle_tree
from decomp.geometry import Geometry
from decomp.sites.site import SiteKind
from decomp.tetra.cells import OUTSIDE, CellMap, locate
from decomp.tetra.faces import NONE, Faces
from decomp.tetra.layout import Layout, samples
from decomp.tetra.surface import MeshSurface
from decomp.vectors import Array, Bools, Ints, cross, dot, norm

ASIDE = 0.5
"""Triangles' own sides are asked so many epsilons off them."""
JUMP = 4.0
"""Feet jump across a sheet by at least so many epsilons."""
OWN = 1.2
"""Nodes on the sheet of an edge with itself are at most so many epsilons off it at first."""
TURNED = 3.0
"""A normal at right angles to a face's counts as much as a distance of so many epsilons."""


@dataclass(frozen=True, eq=False)
class Tagged:
    """Triangles that lie on patches.

    Args:
        triangles: (k, 3), pointing out of the first of their cells.
        cells: (k, 2) the cells on both sides; a boundary triangle has OUTSIDE second, an
            interface the cell of the lower region first, a sheet the lower cell.
        patches: (k,) the patch of each.
    """

    triangles: Ints
    cells: Ints
    patches: Ints


class Tagger:
    """Finds the patches of triangles.

    Args:
        geometry, surface: of the model.
        cells: the cells that tetrahedra were classified by.
        plan: the complex laid out for them.
        epsilon: how far the mesh may be off the complex.
    """

    def __init__(
        self,
        geometry: Geometry,
        surface: MeshSurface,
        cells: CellMap,
        plan: Layout,
        epsilon: float,
    ) -> None:
        self._geometry, self._surface, self._cells = geometry, surface, cells
        self._plan, self._epsilon = plan, epsilon
        self._part_of_face = {
            (site.region, site.index): int(cells.part[number])
            for number, site in enumerate(surface.sites)
            if site.kind is SiteKind.FACE and site.region >= 0
        }

    def tagged(self, points: Array, part: Ints, faces: Faces) -> Tagged:
        """The triangles between tetrahedra of different cells, and those on sheets inside cells.

        Args:
            points: (n, 3).
            part: (m,) the part of a cell that each tetrahedron is in.
            faces: of the tetrahedra.
        """
        parts = np.where(faces.tets == NONE, OUTSIDE, part[faces.tets])
        alone = self._on_own_sheets(points, faces.triangles, parts)
        rows = np.flatnonzero((parts[:, 0] != parts[:, 1]) | (alone >= 0))
        alone, parts, triangles = alone[rows], parts[rows], faces.triangles[rows]
        sides, regions = self._cells.cell_of(parts), self._cells.region_of(parts)
        swapped = self._second_first(sides, regions)
        triangles = np.where(swapped[:, None], triangles[:, ::-1], triangles)
        sides = np.where(swapped[:, None], sides[:, ::-1], sides)
        regions = np.where(swapped[:, None], regions[:, ::-1], regions)
        patches = np.full(len(rows), -1, dtype=np.int64)
        outer = regions[:, 0] != regions[:, 1]
        inner = sides[:, 0] == sides[:, 1]
        patches[outer] = self._boundary(points, triangles[outer], regions[outer])
        patches[~outer & ~inner] = self._sheets(
            points, triangles[~outer & ~inner], sides[~outer & ~inner]
        )
        patches[inner] = self._inside(points, triangles[inner], parts[inner])
        patches = np.where(alone >= 0, alone, patches)
        kept = patches >= 0
        return Tagged(triangles[kept], sides[kept], patches[kept])

    def parts_at(self, points: Array) -> Ints:
        """The parts (k,) of cells that hold points (k, 3)."""
        return locate(self._geometry, self._cells, points).part

    def owner(self, tagged: Tagged, nodes: Ints) -> Ints:
        """The part (k,) that the one face around each node belongs to; OUTSIDE for none or more."""
        found = np.full(len(nodes), OUTSIDE, dtype=np.int64)
        for row, node in enumerate(nodes.tolist()):
            at = np.unique(tagged.patches[(tagged.triangles == node).any(axis=1)])
            sides = [self._plan.sides[patch] for patch in at.tolist() if self._plan.sides[patch]]
            if len(sides) == 1 and len(sides[0]) == 1:
                found[row] = self._part_of_face[sides[0][0]]
        return found

    def _inside(self, points: Array, triangles: Ints, parts: Ints) -> Ints:
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

    def _on_own_sheets(self, points: Array, triangles: Ints, parts: Ints) -> Ints:
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
        """Which of all points are nodes within some epsilons of triangles with given corners."""
        reach = OWN * self._epsilon
        low, high = corners.min(axis=(0, 1)) - reach, corners.max(axis=(0, 1)) + reach
        nodes = nodes[((points[nodes] >= low) & (points[nodes] <= high)).all(axis=1)]
        near = np.zeros(len(points), dtype=np.bool_)
        near[nodes] = triangle_distance(triangle_tree(corners), points[nodes]) <= reach
        return near

    def _jumps(self, corners: Array) -> Bools:
        """Whether the feet on both sides of triangles, given by their corners, are far apart."""
        normal = cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        way = normal * (ASIDE * self._epsilon / np.maximum(norm(normal), 1e-300))[:, None]
        middle = corners.mean(axis=1)
        asked = np.concatenate([middle - way, middle + way])
        feet = locate(self._geometry, self._cells, asked).foot.reshape(2, -1, 3)
        return np.asarray(norm(feet[0] - feet[1]) > JUMP * self._epsilon)

    @staticmethod
    def _second_first(sides: Ints, regions: Ints) -> Bools:
        """Whether the second of two cells has to come first."""
        outer = regions[:, 0] != regions[:, 1]
        lower = np.where(
            outer,
            np.where(
                regions[:, 0] < 0, True, (regions[:, 1] >= 0) & (regions[:, 1] < regions[:, 0])
            ),
            sides[:, 1] < sides[:, 0],
        )
        return np.asarray(lower)

    def _boundary(self, points: Array, triangles: Ints, regions: Ints) -> Ints:
        """The patches of triangles that bound regions[:, 0]."""
        faces = self._faces(points, triangles, regions[:, 0])
        known: dict[tuple[int, int, int], int] = {}
        for number, own in enumerate(self._plan.sides):
            for region, face in own:
                other = next((r for r, _ in own if r != region), OUTSIDE)
                known.setdefault((region, face, other), number)
                known.setdefault((region, face, -2), number)
        keys = np.stack([regions[:, 0], faces, regions[:, 1]], axis=1)
        unique, which = np.unique(keys, axis=0, return_inverse=True)
        found = [known.get((r, f, other), known[r, f, -2]) for r, f, other in unique.tolist()]
        return np.array(found, dtype=np.int64)[which.reshape(-1)]

    def _faces(self, points: Array, triangles: Ints, regions: Ints) -> Ints:
        """The face of its region that each triangle lies on: nearest, and turned alike."""
        corners = points[triangles]
        normal = cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        normal /= np.maximum(norm(normal), 1e-300)[:, None]
        middle = corners.mean(axis=1, keepdims=True)
        asked = np.concatenate([middle, middle + 0.7 * (corners - middle)], axis=1)
        asked = asked - ASIDE * self._epsilon * normal[:, None]
        found = locate(self._geometry, self._cells, asked.reshape(-1, 3))
        candidates = self._cells.face[found.site].reshape(-1, 4)
        own = self._cells.region_of(found.part).reshape(-1, 4) == regions[:, None]
        best = np.full(len(triangles), -1, dtype=np.int64)
        least = np.full(len(triangles), np.inf)
        for region in np.unique(regions).tolist():
            boundary = self._surface.regions[region].boundary
            for face in range(len(boundary.faces)):
                rows = np.flatnonzero(
                    (regions == region) & ((candidates == face) & own).any(axis=1)
                )
                cost = self._cost(region, face, corners[rows], normal[rows])
                better = rows[cost < least[rows]]
                least[better] = cost[cost < least[rows]]
                best[better] = face
            for row in np.flatnonzero((regions == region) & (best < 0)):
                costs = [
                    float(self._cost(region, face, corners[[row]], normal[[row]])[0])
                    for face in range(len(boundary.faces))
                ]
                best[row] = int(np.argmin(costs))
        return best

    def _cost(self, region: int, face: int, corners: Array, normal: Array) -> Array:
        """How badly (k,) triangles fit a face."""
        boundary = self._surface.regions[region].boundary
        carrier = boundary.carriers[boundary.faces[face].carrier]
        outward = boundary.faces[face].outward * carrier.normal(carrier.foot(corners.mean(axis=1)))
        off = np.abs(carrier.signed_distance(corners)).max(axis=1) / self._epsilon
        return np.asarray(off + TURNED * (1 - dot(outward, normal)))

    def _sheets(self, points: Array, triangles: Ints, sides: Ints) -> Ints:
        """The patches of triangles between cells of one region."""
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
        mesh = self._plan.complex
        spacing = float(np.median(norm(corners[:, 1] - corners[:, 0]))) / 2
        places, which = [], []
        for patch in candidates:
            some, _ = samples(mesh.points, mesh.patches[patch].triangles, spacing)
            places.append(some)
            which.append(np.full(len(some), patch))
        tree = cKDTree(np.concatenate(places))
        return np.asarray(np.concatenate(which)[tree.query(corners.mean(axis=1))[1]])
