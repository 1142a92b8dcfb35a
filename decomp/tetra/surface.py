"""The complex that a mesh conforms to: the skeleton's, as coarse as it may be.

TetWild's time goes with the number of triangles and their shape, and nodes are moved onto the
exact surfaces afterwards, so chords may be coarser here than in a skeleton that is an end in
itself. Trim surfaces are left out unless cells of single faces are wanted. In place of the
skeleton's certificate the surfaces of all cells must be closed and hold the regions' volumes.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from decomp.boundary.topology import RegionBoundary
from decomp.cells.partition import face_cells, skeleton_cells
from decomp.cells.surface import is_closed
from decomp.complex.boundary import BoundaryMesh, boundary_mesh
from decomp.complex.model import Complex, Patch, PatchKind
from decomp.complex.refine import refined
from decomp.errors import GeometryError
from decomp.geometry import Geometry
from decomp.medial.assembly import RegionAssembler, RegionParts
from decomp.medial.region_curves import RegionCurves, region_curves
from decomp.medial.result import Cell, Sheet, TrimSurface
from decomp.medial.sheets import CrossingError, MissingCurveError
from decomp.medial.trim_maker import BoundaryVertices, owners
from decomp.sites.site import Site
from decomp.tetra.content import contents
from decomp.vectors import Ints

SHARE = 0.7
"""The part of the tolerance that curves may use up."""
FINER = 4.0
LEVELS = 5
"""How often, and how much more finely, curves are sampled where they cross."""
SAMPLES = (2000, 20000)
"""Boundary points from which seams are looked for, attempt by attempt."""
VOLUME = 2e-3
"""How far the cells' volumes may sum up off the region's, relative to it."""


@dataclass(frozen=True, eq=False)
class RegionSurface:
    """One region's part of a complex.

    Args:
        name: the region's.
        boundary: its exact boundary.
        face_sides: for each face its patches, +1 where their normals point out of the region.
        sheets: the sites of each sheet by its patch; its normal points from the first's side.
        cells: that the mesh is to have.
    """

    name: str
    boundary: RegionBoundary
    face_sides: tuple[tuple[tuple[int, int], ...], ...]
    sheets: dict[int, tuple[int, int]]
    cells: tuple[Cell, ...]


@dataclass(frozen=True, eq=False)
class MeshSurface:
    """All regions over one complex.

    Args:
        sites: what points can be nearest to.
        complex: triangles and lines.
        tolerance: its chord tolerance, in model units.
        regions: in the model's order.
    """

    sites: tuple[Site, ...]
    complex: Complex
    tolerance: float
    regions: tuple[RegionSurface, ...]


class SurfaceMaker:
    """Makes complexes of one model, of any fineness, from curves that are traced once.

    Args:
        geometry: of the model.
        tell: is told what is being done.

    Raises:
        GeometryError: the skeleton cannot be computed; says where.
    """

    def __init__(self, geometry: Geometry, tell: Callable[[str], None]) -> None:
        self._geometry, self._tell = geometry, tell
        self._curves: list[RegionCurves] = []
        self._tried = 0
        self._trace()

    def _trace(self) -> None:
        curves = []
        for number, boundary in enumerate(self._geometry.regions):
            self._tell(f"tracing {boundary.name}")
            curves.append(
                region_curves(self._geometry.index, boundary, number, SAMPLES[self._tried])
            )
        self._curves = curves
        self._tried += 1

    def made(self, tolerance: float, by_face: bool) -> MeshSurface:
        """A complex.

        Args:
            tolerance: chord tolerance, in model units.
            by_face: whether face cells are wanted, parted by trim surfaces.

        Raises:
            GeometryError: a cell is not closed, or the cells do not fill their region.
        """
        self._tell("triangulating sheets")
        while True:
            try:
                surface, parts = self._parts(tolerance)
                break
            except MissingCurveError:
                if self._tried == len(SAMPLES):
                    raise
                self._trace()
        return _assembled(self._geometry, self._curves, surface, parts, tolerance, by_face)

    def _parts(self, tolerance: float) -> tuple[BoundaryMesh, list[RegionParts]]:
        """Triangulate; where curves cross in a footprint, sample them more finely."""
        along = SHARE * tolerance
        for level in range(LEVELS):
            try:
                surface = boundary_mesh(self._geometry, along)
                return surface, self._regions(surface, along)
            except CrossingError:
                if level == LEVELS - 1:
                    raise
                along /= FINER
        raise AssertionError

    def _regions(self, surface: BoundaryMesh, along: float) -> list[RegionParts]:
        points = surface.points
        parts = []
        for number, curves in enumerate(self._curves):
            vertices = _vertices(surface, number, len(curves.incidence.boundary.faces))
            maker = RegionAssembler(self._geometry.index, curves, vertices, points, along)
            parts.append(maker.assemble())
            points = np.concatenate([points, parts[-1].points])
        return parts


def _assembled(
    geometry: Geometry,
    curves: Sequence[RegionCurves],
    surface: BoundaryMesh,
    parts: Sequence[RegionParts],
    tolerance: float,
    by_face: bool,
) -> MeshSurface:
    """Join the parts, refine them to the tolerance, and put the cells together."""
    patches = [each.patch for each in surface.patches]
    lines = list(surface.lines)
    sheets: list[dict[int, tuple[int, int]]] = []
    trims: list[list[TrimSurface]] = []
    for part in parts:
        sheets.append({len(patches) + k: sheet.sites for k, sheet in enumerate(part.sheets)})
        patches += [Patch(PatchKind.SHEET, s.surface, s.triangles) for s in part.sheets]
        first = len(patches) if by_face else None
        trims.append(
            [
                TrimSurface(-1 if first is None else first + k, trim.faces)
                for k, (trim, _) in enumerate(part.trims)
            ]
        )
        lines += part.lines
        if by_face:
            patches += [patch for _, patch in part.trims]
            lines += part.rulings
    points = np.concatenate([surface.points, *(part.points for part in parts)])
    mesh, _ = refined(Complex(points, tuple(patches), tuple(lines)), tolerance)
    regions = []
    for number, boundary in enumerate(geometry.regions):
        sides = surface.face_sides(number, len(boundary.faces))
        cells = _cells(mesh, curves[number], sides, sheets[number], trims[number], by_face)
        regions.append(RegionSurface(boundary.name, boundary, sides, sheets[number], cells))
    return _checked(MeshSurface(geometry.sites, mesh, tolerance, tuple(regions)))


def _cells(
    mesh: Complex,
    curves: RegionCurves,
    face_sides: tuple[tuple[tuple[int, int], ...], ...],
    sheets: dict[int, tuple[int, int]],
    trims: Sequence[TrimSurface],
    by_face: bool,
) -> tuple[Cell, ...]:
    """The cells of a region; their volumes are measured later."""
    boundary = curves.incidence.boundary
    owner = owners(curves)
    parting = [
        Sheet(sites, None, patch, float("nan"), (0.0, 0.0)) for patch, sites in sheets.items()
    ]
    found = face_cells(mesh, boundary, face_sides, parting, trims if by_face else (), owner)
    return found if by_face else skeleton_cells(mesh, boundary, found, trims)


def _checked(made: MeshSurface) -> MeshSurface:
    """Fill in the cells' volumes.

    Raises:
        GeometryError: a cell is not closed, or the cells do not fill their region.
    """
    every = [cell for region in made.regions for cell in region.cells]
    for cell in every:
        if not is_closed(made.complex, cell.sides):
            raise GeometryError(f"the surface of cell {cell.name} is not closed")
    found = iter(contents(made.complex, [cell.sides for cell in every]))
    regions = []
    for region in made.regions:
        cells = tuple(replace(cell, volume=float(next(found))) for cell in region.cells)
        whole, exact = sum(cell.volume for cell in cells), region.boundary.volume
        if abs(whole - exact) > VOLUME * abs(exact):
            raise GeometryError(
                f"the cells of region {region.name} hold {whole:.6g}, the region {exact:.6g}"
            )
        regions.append(replace(region, cells=cells))
    return replace(made, regions=tuple(regions))


def _vertices(surface: BoundaryMesh, region: int, count: int) -> BoundaryVertices:
    """Where a region's vertices, edges and faces are among the points of the boundary."""
    edges = []
    for run in surface.pieces.of_edge[region]:
        joined = [surface.samples.vertices[piece][::sense] for piece, sense in run]
        edges.append(np.concatenate([joined[0], *(line[1:] for line in joined[1:])]))
    faces: list[Ints] = []
    for sides in surface.face_sides(region, count):
        parts = [surface.patches[patch].patch.triangles[:, ::sense] for patch, sense in sides]
        faces.append(np.concatenate([np.empty((0, 3), dtype=np.int64), *parts]))
    return BoundaryVertices(surface.points, surface.pieces.of_vertex[region], edges, faces)
