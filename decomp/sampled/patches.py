"""Walls of all regions as patches and lines of one complex over the boundary.

Walls across which the nearest point jumps are sheets, the others trim surfaces; of these only what
parts the cells of different faces is kept.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_array  # type: ignore[import-untyped]
from scipy.sparse.csgraph import connected_components  # type: ignore[import-untyped]

from decomp.complex.model import SIDES, Patch, PatchKind
from decomp.errors import GeometryError
from decomp.sampled.elements import NormalsSurface
from decomp.sampled.extracted import Extracted
from decomp.sampled.placing import Placer
from decomp.skeletons.curves.incidence import Incidence
from decomp.skeletons.model import TrimSurface
from decomp.skeletons.sheets.sheet_surface import SheetSurface
from decomp.vectors import Array, Ints


@dataclass(frozen=True, eq=False)
class RegionWalls:
    """The walls of one region, by what they are.

    Args:
        sheets: the sites of each sheet.
        sheet_patches: their patches.
        trims: what each trim surface parts; patches are counted from the region's first.
        trim_patches: their patches.
    """

    sheets: tuple[tuple[int, int], ...]
    sheet_patches: tuple[Patch, ...]
    trims: tuple[tuple[int, int], ...]
    trim_patches: tuple[Patch, ...]


class WallMaker:
    """Sorts the walls of one region.

    Args:
        incidence, placer: of the region.
        owner: the face that owns each site.
    """

    def __init__(self, incidence: Incidence, placer: Placer, owner: dict[int, int]) -> None:
        self._it, self._placer, self._owner = incidence, placer, owner

    def made(self, found: Extracted, points: Array, vertices: Ints) -> RegionWalls:
        """Sheets and trim surfaces.

        Args:
            found: the walls.
            points: (n, 3) of the complex.
            vertices: the point of the complex that each of the walls' vertices is.
        """
        links = found.links
        triangles = vertices[found.triangles]
        sheets, sheet_patches = self._sheets(
            triangles[links[:, 0] < 0], found.between[links[:, 0] < 0], points
        )
        trims, trim_patches = self._trims(found, links, triangles)
        return RegionWalls(tuple(sheets), tuple(sheet_patches), tuple(trims), tuple(trim_patches))

    def _sheets(
        self, triangles: Ints, between: Ints, points: Array
    ) -> tuple[list[tuple[int, int]], list[Patch]]:
        names, patches = [], []
        pairs, which = np.unique(between, axis=0, return_inverse=True)
        for number, pair in enumerate(pairs.tolist()):
            own = triangles[which.reshape(-1) == number]
            sites = (int(pair[0]), int(pair[1]))
            for part in parts(own):
                used = np.unique(part)
                feet = self._it.feet(sites, points[used])
                surface = SheetSurface(self._it, sites, points[used], feet)
                names.append(sites)
                patches.append(Patch(PatchKind.SHEET, surface, part))
        return names, patches

    def _trims(
        self, found: Extracted, links: Ints, triangles: Ints
    ) -> tuple[list[tuple[int, int]], list[Patch]]:
        owner = np.full(max(self._owner) + 1, -1, dtype=np.int64)
        owner[list(self._owner)] = list(self._owner.values())
        faces = owner[found.between]
        rows = np.flatnonzero((links[:, 0] >= 0) & (faces[:, 0] != faces[:, 1]))
        turned = faces[rows, 0] > faces[rows, 1]
        own = np.where(turned[:, None], triangles[rows][:, ::-1], triangles[rows])
        key = np.concatenate([links[rows], np.sort(faces[rows], axis=1)], axis=1)
        names, patches = [], []
        keys, which = np.unique(key, axis=0, return_inverse=True)
        for number, (a, b, one, two) in enumerate(keys.tolist()):
            if not self._placer.normals.takes_over(a, b):
                at = own[which.reshape(-1) == number][0, 0]
                raise GeometryError(
                    f"the cells of {' and '.join(self._placer.names((a, b)))} cannot be parted "
                    f"near point {at}"
                )
            # the surface's normal leads to what takes over, whichever of the two that is
            first, second = a, b
            if self._placer.normals.later(a, b) == a:
                first, second = b, a
            ahead = self._owner[second] == two or self._owner[first] == one
            towards = 1.0 if ahead else -1.0
            surface = NormalsSurface(self._placer, (a, b), towards)
            for part in parts(own[which.reshape(-1) == number]):
                names.append((one, two))
                patches.append(Patch(PatchKind.TRIM, surface, part))
        return names, patches


def parts(triangles: Ints) -> list[Ints]:
    """Triangles (m, 3) cut apart where they are not joined two by two."""
    sides = np.sort(triangles[:, SIDES].reshape(-1, 2), axis=1)
    _, which, many = np.unique(sides, axis=0, return_inverse=True, return_counts=True)
    which = which.reshape(-1)
    order = np.argsort(which, kind="stable")
    first = np.searchsorted(which[order], np.flatnonzero(many == 2))
    one, two = order[first] // 3, order[first + 1] // 3
    count = len(triangles)
    joined = coo_array((np.ones(len(one)), (one, two)), shape=(count, count))
    number, part = connected_components(joined, directed=False)
    return [triangles[part == k] for k in range(number)]


def numbered_trims(made: RegionWalls, first: int) -> tuple[TrimSurface, ...]:
    """Trim surfaces with the numbers of their patches, which begin at a given one."""
    return tuple(TrimSurface(first + k, faces) for k, faces in enumerate(made.trims))
