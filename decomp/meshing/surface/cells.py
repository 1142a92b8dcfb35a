"""Which cell holds a point, exactly: its region, its nearest site, and the cell with its face."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from decomp.geometry import Geometry
from decomp.meshing.surface.surface import MeshSurface
from decomp.skeletons.cells.owners import site_owners
from decomp.skeletons.model import Cell
from decomp.vectors import Array, Ints

OUTSIDE = -1


@dataclass(frozen=True, eq=False)
class CellMap:
    """The cells of all regions under one numbering, and their parts under another.

    A cell that a sheet leads into without cutting it in two has a part for each site that such
    sheets part, and one for all its other sites; other cells are their only part.

    Args:
        cells: all, region after region.
        region: (c,) the region of each cell.
        part: (s,) the part that holds the points nearest to each site, OUTSIDE for the sites of
            the outside.
        cell: (p,) the cell of each part.
        face: (s,) the face, as an index into its region's, that owns each site.
    """

    cells: tuple[Cell, ...]
    region: Ints
    part: Ints
    cell: Ints
    face: Ints

    def cell_of(self, part: Ints) -> Ints:
        """The cells of parts, OUTSIDE for OUTSIDE."""
        return np.where(part < 0, OUTSIDE, self.cell[np.maximum(part, 0)])

    def region_of(self, part: Ints) -> Ints:
        """The regions of parts, -1 for OUTSIDE."""
        return np.where(part < 0, -1, self.region[self.cell[np.maximum(part, 0)]])


@dataclass(frozen=True, eq=False)
class Located:
    """Where points are.

    Args:
        part: (n,) of cells, OUTSIDE where no region is.
        site: (n,) nearest ones.
        foot: (n, 3) nearest points of the boundary of the region, or of the outside.
    """

    part: Ints
    site: Ints
    foot: Array


def cell_map(surface: MeshSurface) -> CellMap:
    """Number the cells of all regions."""
    cells: list[Cell] = []
    region: list[int] = []
    of_face: dict[tuple[int, int], int] = {}
    for number, each in enumerate(surface.regions):
        names = {face.name: k for k, face in enumerate(each.boundary.faces)}
        for cell in each.cells:
            for name in cell.faces:
                of_face[number, names[name]] = len(cells)
            cells.append(cell)
            region.append(number)
    owner = site_owners(surface.sites, [each.boundary for each in surface.regions])
    of_site = np.array(
        [
            OUTSIDE if site.region < 0 else of_face[site.region, int(face)]
            for site, face in zip(surface.sites, owner, strict=True)
        ],
        dtype=np.int64,
    )
    part, cell_of_part = of_site.copy(), list(range(len(cells)))
    for each in surface.regions:
        for one, two in each.sheets.values():
            if of_site[one] == of_site[two] and one != two:
                for site in (one, two):
                    if part[site] < len(cells):
                        part[site] = len(cell_of_part)
                        cell_of_part.append(int(of_site[site]))
    return CellMap(
        tuple(cells),
        np.array(region, dtype=np.int64),
        part,
        np.array(cell_of_part, dtype=np.int64),
        owner,
    )


def locate(geometry: Geometry, cells: CellMap, points: Array) -> Located:
    """Find the parts of cells that hold points (n, 3)."""
    found = geometry.index.nearest(points)
    part = np.where(found.region < 0, OUTSIDE, cells.part[found.site])
    return Located(part, found.site.astype(np.int64), found.foot)
