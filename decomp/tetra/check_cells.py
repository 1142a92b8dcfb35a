"""Where points are in the cells of a skeleton, for checking meshes; shares nothing with meshing."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from decomp.certificate.distance import triangle_distance, triangle_tree
from decomp.medial.result import Cell, RegionSkeleton, Skeleton
from decomp.sites.site import Site, SiteKind
from decomp.vectors import Array, Ints

NONE = -1


@dataclass(frozen=True, eq=False)
class KnownCells:
    """The cells of all regions.

    Args:
        skeleton: that they are of.
        cells: all, region after region.
        regions: (c,) the region of each.
        of_site: (s,) the cell of the points nearest to each site, NONE for sites of the outside.
    """

    skeleton: Skeleton
    cells: tuple[Cell, ...]
    regions: Ints
    of_site: Ints

    @property
    def names(self) -> list[str]:
        """Of all cells."""
        return [cell.name for cell in self.cells]

    def depth(self, points: Array, regions: Ints) -> Array:
        """Distance (n,) of points to the walls between cells of their regions (n,).

        Exact to the skeleton's tolerance; infinite where there is one cell.
        """
        mesh = self.skeleton.complex
        result = np.zeros(len(points))
        for number, region in enumerate(self.skeleton.regions):
            rows = np.flatnonzero(regions == number)
            own = [cell for cell, r in zip(self.cells, self.regions, strict=True) if r == number]
            outer = {patch for sides in region.face_sides for patch, _ in sides}
            walls = sorted({patch for cell in own for patch, _ in cell.sides} - outer)
            corners = [mesh.points[mesh.patches[patch].triangles] for patch in walls]
            tree = triangle_tree(np.concatenate([np.empty((0, 3, 3)), *corners]))
            result[rows] = triangle_distance(tree, points[rows])
        return result


def known_cells(skeleton: Skeleton, names: set[str]) -> KnownCells:
    """The skeleton's cells or its face cells, whichever more of some names are of."""

    def fit(by_face: bool) -> int:
        return len(names & {c.name for r in skeleton.regions for c in _cells(r, by_face)})

    by_face = fit(True) > fit(False)
    parts = [_cells(region, by_face) for region in skeleton.regions]
    cells = tuple(cell for part in parts for cell in part)
    place = {cell.name: k for k, cell in enumerate(cells)}
    of_face = {
        (number, face): place[cell.name]
        for number, part in enumerate(parts)
        for cell in part
        for face in cell.faces
    }
    of_site = [
        NONE if site.region < 0 else of_face[site.region, _owner(skeleton, site)]
        for site in skeleton.sites
    ]
    regions = np.repeat(np.arange(len(parts)), [len(part) for part in parts])
    return KnownCells(skeleton, cells, regions, np.array(of_site, dtype=np.int64))


def _cells(region: RegionSkeleton, by_face: bool) -> tuple[Cell, ...]:
    return region.face_cells if by_face else region.cells


def _owner(skeleton: Skeleton, site: Site) -> str:
    """The face whose cell has the points nearest to a site (see `decomp.cells.partition`)."""
    boundary = skeleton.regions[site.region].boundary
    if site.kind is SiteKind.FACE:
        face = site.index
    elif site.kind is SiteKind.EDGE:
        face = boundary.edges[site.index].faces[0]
    else:
        vertex = boundary.vertices[site.index]
        reentrant = {
            other.index
            for other in skeleton.sites
            if other.region == site.region and other.kind is SiteKind.EDGE
        }
        edges = [edge for edge in vertex.edges if edge in reentrant]
        face = boundary.edges[edges[0]].faces[0] if edges else vertex.faces[0]
    return boundary.faces[face].name
