"""Where points are in the cells of a skeleton, for checking meshes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from decomp.checking.names import face_names
from decomp.geometry import Geometry
from decomp.meshing.surface.surface import MeshSurface, Surfaces
from decomp.sites.site import Site, SiteKind
from decomp.skeletons.certificate.distance import triangle_distance, triangle_tree
from decomp.skeletons.model import Cell
from decomp.vectors import Array, Ints

NONE = -1


@dataclass(frozen=True, eq=False)
class KnownCells:
    """The cells of all regions.

    Args:
        surface: boundary and skeleton that they are of.
        cells: all, region after region.
        regions: (c,) the region of each.
        of_site: (s,) the cell of the points nearest to each site, NONE for sites of the outside.
    """

    surface: MeshSurface
    cells: tuple[Cell, ...]
    regions: Ints
    of_site: Ints

    @property
    def names(self) -> list[str]:
        """Of all cells."""
        return [cell.name for cell in self.cells]

    @property
    def name_of_site(self) -> list[str]:
        """The name (s,) of each site's cell, empty for sites of the outside."""
        return [self.cells[k].name if k != NONE else "" for k in self.of_site.tolist()]

    def depth(self, points: Array, regions: Ints) -> Array:
        """Distance (n,) of points to the walls between cells of their regions (n,).

        Exact to the surface's tolerance; infinite where there is one cell.
        """
        mesh = self.surface.complex
        result = np.zeros(len(points))
        for number, region in enumerate(self.surface.regions):
            rows = np.flatnonzero(regions == number)
            own = [cell for cell, r in zip(self.cells, self.regions, strict=True) if r == number]
            outer = {patch for sides in region.face_sides for patch, _ in sides}
            walls = sorted({patch for cell in own for patch, _ in cell.sides} - outer)
            corners = [mesh.points[mesh.patches[patch].triangles] for patch in walls]
            tree = triangle_tree(np.concatenate([np.empty((0, 3, 3)), *corners]))
            result[rows] = triangle_distance(tree, points[rows])
        return result


def cells_named(
    geometry: Geometry,
    names: set[str],
    tolerance: float,
    surfaces: Surfaces,
    tell: Callable[[str, float], None],
) -> KnownCells:
    """The skeleton's cells or its face cells, whichever more of some names are of.

    Args:
        geometry: of the model.
        names: of cells.
        tolerance: chord tolerance of the sheets, in model units.
        surfaces: makes the skeletons.
        tell: is told what is being done, and which part (0 to 1) is behind.

    Raises:
        GeometryError: the skeleton cannot be computed.
    """
    maker = surfaces(geometry, tell)
    whole = known_cells(maker.made(tolerance, False))
    if names <= set(whole.names) or not names & set(face_names(geometry)):
        return whole
    parted = known_cells(maker.made(tolerance, True))
    return max((whole, parted), key=lambda known: len(names & set(known.names)))


def known_cells(surface: MeshSurface) -> KnownCells:
    """The cells of a complex."""
    parts = [region.cells for region in surface.regions]
    cells = tuple(cell for part in parts for cell in part)
    place = {cell.name: k for k, cell in enumerate(cells)}
    of_face = {
        (number, face): place[cell.name]
        for number, part in enumerate(parts)
        for cell in part
        for face in cell.faces
    }
    of_site = [
        NONE if site.region < 0 else of_face[site.region, _owner(surface, site)]
        for site in surface.sites
    ]
    regions = np.repeat(np.arange(len(parts)), [len(part) for part in parts])
    return KnownCells(surface, cells, regions, np.array(of_site, dtype=np.int64))


def _owner(surface: MeshSurface, site: Site) -> str:
    """The face whose cell has the points nearest to a site (`decomp.skeletons.cells.partition`)."""
    boundary = surface.regions[site.region].boundary
    if site.kind is SiteKind.FACE:
        face = site.index
    elif site.kind is SiteKind.EDGE:
        face = boundary.edges[site.index].faces[0]
    else:
        vertex = boundary.vertices[site.index]
        reentrant = {
            other.index
            for other in surface.sites
            if other.region == site.region and other.kind is SiteKind.EDGE
        }
        edges = [edge for edge in vertex.edges if edge in reentrant]
        face = boundary.edges[edges[0]].faces[0] if edges else vertex.faces[0]
    return boundary.faces[face].name
