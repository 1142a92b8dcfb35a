"""The complex that a mesh conforms to: the skeleton's, as coarse as it may be.

A mesher's time goes with the number of triangles and their shape, and nodes are moved onto the
exact surfaces afterwards, so chords may be coarser here than in a skeleton that is an end in
itself. Trim surfaces are left out unless cells of single faces are wanted. In place of the
skeleton's certificate the surfaces of all cells must be closed and hold the regions' volumes.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Protocol

from decomp.attempts import Way, first_of
from decomp.boundary.topology import RegionBoundary
from decomp.complex.model import Complex
from decomp.complex.refining.refine import refined
from decomp.errors import GeometryError
from decomp.geometry import Geometry
from decomp.meshing.surface.content import contents
from decomp.sites.site import Site
from decomp.skeletons.cells.partition import face_cells, skeleton_cells
from decomp.skeletons.cells.surface import is_closed
from decomp.skeletons.curves.region_curves import RegionCurves
from decomp.skeletons.drafts import SAMPLES, Draft, drafted, traced
from decomp.skeletons.model import Cell, Method, Sheet, TrimSurface
from decomp.skeletons.sheets.component_votes import MissingCurveError
from decomp.skeletons.sheets.trim_maker import owners

FINER_COMPLEX, FINER_TRIES = 3.0, 2
"""So much finer a complex is tried if one cannot be made, and so often."""
TRACED_SHARE = 0.7
"""Which part of the work is behind when all curves are traced."""
CELLS_VOLUME = 2e-3
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
        method, cause: how its skeleton was found, and why it was not traced.
    """

    name: str
    boundary: RegionBoundary
    face_sides: tuple[tuple[tuple[int, int], ...], ...]
    sheets: dict[int, tuple[int, int]]
    cells: tuple[Cell, ...]
    method: Method = Method.TRACED
    cause: str | None = None


@dataclass(frozen=True, eq=False)
class MeshSurface:
    """All regions over one complex.

    Args:
        sites: what points can be nearest to.
        complex: triangles and lines.
        tolerance: its chord tolerance, in model units.
        regions: in the model's order.
        has_skeleton: whether the complex holds the skeleton beside the boundary.
    """

    sites: tuple[Site, ...]
    complex: Complex
    tolerance: float
    regions: tuple[RegionSurface, ...]
    has_skeleton: bool = True


class CellSurfaces(Protocol):
    """Makes complexes of one model, of any fineness, with its skeleton."""

    def made(self, tolerance: float, by_face: bool) -> MeshSurface:
        """A complex.

        Args:
            tolerance: chord tolerance, in model units; a finer one is taken if that fails.
            by_face: whether face cells are wanted, parted by trim surfaces.

        Raises:
            GeometryError: there is none, or its cells are not closed or do not fill their region.
        """


Surfaces = Callable[[Geometry, Callable[[str, float], None]], CellSurfaces]
"""What makes them for a geometry, telling of the progress."""


def coarsest(make: Callable[[float], MeshSurface], tolerance: float) -> MeshSurface:
    """What is made with a tolerance, or with a finer one if that fails.

    Raises:
        GeometryError: the finest one fails too.
    """

    def way(fine: float) -> Way[MeshSurface]:
        return Way(f"chords within {fine:.3g}", lambda: make(fine))

    return first_of(way(tolerance / FINER_COMPLEX**k) for k in range(FINER_TRIES + 1))


class SurfaceMaker:
    """Makes complexes of one model, of any fineness, from curves that are traced once.

    Args:
        geometry: of the model.
        tell: is told what is being done, and which part (0 to 1) of a first complex is behind.

    Raises:
        GeometryError: the skeleton cannot be computed; says where.
    """

    def __init__(self, geometry: Geometry, tell: Callable[[str, float], None]) -> None:
        self._geometry, self._tell = geometry, tell
        self._curves: list[RegionCurves] = []
        self._tried = 0
        self._trace()

    def _trace(self) -> None:
        self._curves = traced(
            self._geometry,
            SAMPLES[self._tried],
            lambda what, done: self._tell(what, TRACED_SHARE * done),
        )
        self._tried += 1

    def made(self, tolerance: float, by_face: bool) -> MeshSurface:
        """A complex.

        Args:
            tolerance: chord tolerance, in model units; a finer one is taken if that fails.
            by_face: whether face cells are wanted, parted by trim surfaces.

        Raises:
            GeometryError: a cell is not closed, or the cells do not fill their region.
        """
        self._tell("triangulating sheets", TRACED_SHARE)
        return coarsest(lambda fine: self._made(fine, by_face), tolerance)

    def _made(self, tolerance: float, by_face: bool) -> MeshSurface:
        while True:
            try:
                draft = drafted(self._geometry, self._curves, tolerance, with_trims=by_face)
                break
            except MissingCurveError:
                if self._tried == len(SAMPLES):
                    raise
                self._trace()
        return _assembled(self._geometry, self._curves, draft, tolerance, by_face)


def _assembled(
    geometry: Geometry,
    curves: Sequence[RegionCurves],
    draft: Draft,
    tolerance: float,
    by_face: bool,
) -> MeshSurface:
    """Refine a draft to the tolerance, and put the cells together."""
    mesh, _ = refined(draft.complex, tolerance)
    regions = []
    for number, boundary in enumerate(geometry.regions):
        sides = draft.surface.face_sides(number, len(boundary.faces))
        made = zip(draft.sheet_patches[number], draft.parts[number].sheets, strict=True)
        sheets = {patch: sheet.sites for patch, sheet in made}
        owner, trims = owners(curves[number]), draft.trims[number]
        cells = cells_of(mesh, boundary, sides, sheets, trims, owner, by_face)
        regions.append(RegionSurface(boundary.name, boundary, sides, sheets, cells))
    return checked(MeshSurface(geometry.sites, mesh, tolerance, tuple(regions)))


def cells_of(
    mesh: Complex,
    boundary: RegionBoundary,
    face_sides: tuple[tuple[tuple[int, int], ...], ...],
    sheets: dict[int, tuple[int, int]],
    trims: Sequence[TrimSurface],
    owner: dict[int, int],
    by_face: bool,
) -> tuple[Cell, ...]:
    """The cells of a region; their volumes are measured later.

    Args:
        mesh: boundaries and sheets; if `by_face`, trim surfaces too.
        boundary: of the region.
        face_sides: for each face its patches, +1 where their normals point out of the region.
        sheets: the sites of each sheet by its patch.
        trims: which faces' space each trim surface parts.
        owner: the face that owns each site.
        by_face: whether cells are those of single faces.
    """
    parting = [
        Sheet(sites, None, patch, float("nan"), (0.0, 0.0)) for patch, sites in sheets.items()
    ]
    found = face_cells(mesh, boundary, face_sides, parting, trims if by_face else (), owner)
    return found if by_face else skeleton_cells(mesh, boundary, found, trims)


def checked(made: MeshSurface) -> MeshSurface:
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
        if abs(whole - exact) > CELLS_VOLUME * abs(exact):
            raise GeometryError(
                f"the cells of region {region.name} hold {whole:.6g}, the region {exact:.6g}"
            )
        regions.append(replace(region, cells=cells))
    return replace(made, regions=tuple(regions))
