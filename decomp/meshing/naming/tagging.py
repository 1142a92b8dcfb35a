"""Which patch of the complex each triangle between different cells lies on."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from decomp.meshes.faces import NONE, Faces
from decomp.meshing.naming.boundary_tags import BoundaryTags
from decomp.meshing.naming.sheet_tags import SheetTags
from decomp.meshing.surface.cells import OUTSIDE, locate
from decomp.meshing.surface.followed import Followed
from decomp.sites.site import SiteKind
from decomp.vectors import Array, Bools, Ints


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

    def at(self, nodes: Ints) -> Tagged:
        """Those of them that have some of the nodes."""
        rows = np.isin(self.triangles, nodes).any(axis=1)
        return Tagged(self.triangles[rows], self.cells[rows], self.patches[rows])


class Tagger:
    """Finds the patches of triangles.

    Args:
        followed: what the mesh follows.
    """

    def __init__(self, followed: Followed) -> None:
        self._geometry, self._cells = followed.geometry, followed.cells
        self._plan = followed.plan
        self._boundary = BoundaryTags(followed)
        self._sheets = SheetTags(followed)
        self._part_of_face = {
            (site.region, site.index): int(followed.cells.part[number])
            for number, site in enumerate(followed.surface.sites)
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
        alone = self._sheets.alone(points, faces.triangles, parts)
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
        patches[outer] = self._boundary.patches(points, triangles[outer], regions[outer])
        patches[~outer & ~inner] = self._sheets.between(
            points, triangles[~outer & ~inner], sides[~outer & ~inner]
        )
        patches[inner] = self._sheets.inside(points, triangles[inner], parts[inner])
        patches = np.where(alone >= 0, alone, patches)
        kept = patches >= 0
        return Tagged(triangles[kept], sides[kept], patches[kept])

    def still_right(
        self, tagged: Tagged, points: Array, part: Ints, faces: Faces, at: Ints
    ) -> bool:
        """Whether triangles at some nodes would be told the same patches where nodes are now.

        Beside a sharp edge that a mesher has cut off, a triangle can be turned to either face until
        its other nodes are on the edge.

        Args:
            tagged: before.
            points, part, faces: as for `tagged`, now.
            at: the nodes.
        """
        rows = np.isin(faces.triangles, at).any(axis=1)
        now = self.tagged(points, part, Faces(faces.triangles[rows], faces.tets[rows]))
        old = tagged.at(at)
        before = np.column_stack([np.sort(old.triangles, axis=1), old.patches])
        after = np.column_stack([np.sort(now.triangles, axis=1), now.patches])
        return np.array_equal(np.unique(before, axis=0), np.unique(after, axis=0))

    def parts_at(self, points: Array) -> Ints:
        """The parts (k,) of cells that hold points (k, 3)."""
        return locate(self._geometry, self._cells, points).part

    def owner(self, tagged: Tagged, nodes: Ints) -> Ints:
        """The part (k,) that the one face around each node belongs to; OUTSIDE for none or more."""
        found = np.full(len(nodes), OUTSIDE, dtype=np.int64)
        tagged = tagged.at(nodes)
        for row, node in enumerate(nodes.tolist()):
            at = np.unique(tagged.patches[(tagged.triangles == node).any(axis=1)])
            sides = [self._plan.sides[patch] for patch in at.tolist() if self._plan.sides[patch]]
            if len(sides) == 1 and len(sides[0]) == 1:
                found[row] = self._part_of_face[sides[0][0]]
        return found

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
