"""The complex that a mesh conforms to, from a sampled skeleton."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from decomp.complex.model import Complex
from decomp.complex.refining.refine import refined
from decomp.geometry import Geometry
from decomp.meshing.surface.surface import MeshSurface, RegionSurface, cells_of, checked, coarsest
from decomp.sampled.beside import with_traced
from decomp.sampled.patches import numbered_trims
from decomp.sampled.sampling import Sampled
from decomp.sampled.whole import without_trims
from decomp.skeletons.drafts import SHARE
from decomp.skeletons.model import TrimSurface
from decomp.skeletons.sheets.trim_maker import owners
from decomp.vectors import Ints


class SampledSurfaces:
    """Makes complexes of one model, of any fineness, from walls that are sampled once.

    Args:
        geometry: of the model.
        found: its skeleton, which holds its certificate.
    """

    def __init__(self, geometry: Geometry, found: Sampled) -> None:
        self._geometry, self._found = geometry, found

    def made(self, tolerance: float, by_face: bool) -> MeshSurface:
        """A complex.

        Args:
            tolerance: chord tolerance, in model units; what cannot be refined to it stays coarser.
            by_face: whether face cells are wanted, parted by trim surfaces.

        Raises:
            GeometryError: a cell is not closed, or the cells do not fill their region.
        """
        return coarsest(lambda fine: self._made(fine, by_face), tolerance)

    def _made(self, tolerance: float, by_face: bool) -> MeshSurface:
        geometry, found = self._geometry, self._found
        given, tools = found.given, found.tools
        shown = found.shown if by_face else without_trims(given, tools, found.shown)
        along = min(found.along, SHARE * tolerance)
        whole, traced = with_traced(
            geometry, given, found.mesh, found.curves, shown.complex, along, by_face
        )
        mesh = _used(refined(whole, tolerance, lenient=True)[0])
        regions = []
        for number, boundary in enumerate(geometry.regions):
            skeleton = found.skeleton.regions[number]
            sides = given.surface.face_sides(number, len(boundary.faces))
            if number in traced:
                own = traced[number]
                made = zip(own.sheet_patches, own.parts.sheets, strict=True)
                sheets = {patch: sheet.sites for patch, sheet in made}
                trims, owner = own.trims, owners(own.curves)
            else:
                walls, first = shown.walls[number], shown.first[number]
                sheets = {first + k: sites for k, sites in enumerate(walls.sheets)}
                every = found.shown.walls[number].trims
                trims = tuple(TrimSurface(-1, faces) for faces in every)
                if by_face:
                    trims = numbered_trims(walls, first + len(walls.sheets))
                owner = tools[number].owner
            cells = cells_of(mesh, boundary, sides, sheets, trims, owner, by_face)
            regions.append(
                RegionSurface(
                    boundary.name,
                    boundary,
                    sides,
                    sheets,
                    cells,
                    skeleton.method,
                    skeleton.cause,
                )
            )
        return checked(MeshSurface(geometry.sites, mesh, tolerance, tuple(regions)))


def _used(given: Complex) -> Complex:
    """A complex without the points that no triangle and no line has."""
    corners = [patch.triangles.reshape(-1) for patch in given.patches]
    used = np.unique(np.concatenate([*corners, *(line.vertices for line in given.lines)]))
    number: Ints = np.full(len(given.points), -1, dtype=np.int64)
    number[used] = np.arange(len(used))
    return Complex(
        given.points[used],
        tuple(replace(patch, triangles=number[patch.triangles]) for patch in given.patches),
        tuple(replace(line, vertices=number[line.vertices]) for line in given.lines),
    )
