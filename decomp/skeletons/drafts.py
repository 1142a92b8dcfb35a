"""All regions' curves, and the coarse complex between them: where skeletons and meshes start."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from decomp.attempts import stage
from decomp.complex.boundary.boundary import BoundaryMesh, boundary_mesh
from decomp.complex.model import Complex
from decomp.errors import ContactError
from decomp.geometry import Geometry
from decomp.skeletons.assembly import RegionAssembler, RegionParts
from decomp.skeletons.balls.region_context import RegionContext
from decomp.skeletons.curves.region_curves import RegionCurves, region_curves
from decomp.skeletons.joining import Joined, fine_enough_to_part
from decomp.skeletons.model import TrimSurface
from decomp.skeletons.sheets.trim_maker import BoundaryVertices
from decomp.skeletons.traceable import refuse_untraceable
from decomp.vectors import Array, Ints

SAMPLES = (2000, 20000)
"""Boundary points from which seams are looked for, attempt by attempt."""
SHARE = 0.7
"""The part of the tolerance that curves may use up."""


@dataclass(frozen=True, eq=False)
class Draft:
    """A complex that is to be refined, and where in it everything is.

    Args:
        surface: the boundaries of all regions; their patches and lines come first.
        parts: of each region.
        complex: conforming, with exact vertices.
        sheet_patches: for each region the patch of each of its sheets.
        trims: for each region its trim surfaces; their patch is -1 where they were left out.
        part_lines: for each region the line of each of its parts' lines.
    """

    surface: BoundaryMesh
    parts: tuple[RegionParts, ...]
    complex: Complex
    sheet_patches: tuple[tuple[int, ...], ...]
    trims: tuple[tuple[TrimSurface, ...], ...]
    part_lines: tuple[tuple[int, ...], ...]

    def patch_limits(self, of_region: Array) -> Array:
        """What each patch is allowed (p,): what its region is (r,), the least of both at faces."""
        found = np.full(len(self.complex.patches), np.inf)
        for region, limit in enumerate(of_region):
            own = [k for k, each in enumerate(self.surface.patches) if each.outward_of(region)]
            own += self.sheet_patches[region]
            own += [trim.patch for trim in self.trims[region] if trim.patch >= 0]
            found[own] = np.minimum(found[own], limit)
        return found


def traced(
    geometry: Geometry, samples: int, tell: Callable[[str, float], None]
) -> list[RegionCurves]:
    """The curves of all regions.

    Args:
        geometry: of the model.
        samples: boundary points from which seams are looked for that no node leads to.
        tell: is told what is being done, and which part (0 to 1) of the tracing is behind.

    Raises:
        ContactError: a region touches itself; says where.
        GeometryError: a curve cannot be traced.
    """
    for boundary in geometry.regions:
        if boundary.touches:
            raise ContactError(boundary.touches[0])
    return [
        traced_alone(geometry, number, samples, tell) for number in range(len(geometry.regions))
    ]


def traced_alone(
    geometry: Geometry, number: int, samples: int, tell: Callable[[str, float], None]
) -> RegionCurves:
    """The curves of one region; arguments and errors as of `traced`."""
    boundary = geometry.regions[number]
    tell(f"tracing {boundary.name}", number / len(geometry.regions))
    with stage("tracing", boundary.name):
        refuse_untraceable(boundary)
        return region_curves(RegionContext(geometry.index, number), samples)


def drafted(
    geometry: Geometry,
    curves: Sequence[RegionCurves],
    tolerances: Array | float,
    with_trims: bool = True,
) -> Draft:
    """Triangulate the boundary and all sheets; where curves cross they are sampled more finely.

    Args:
        geometry: of the model.
        curves: of its regions.
        tolerances: that the complex is to be refined to, in model units; (r,) of the regions, or
            one for all.
        with_trims: whether trim surfaces are to be in the complex.

    Raises:
        MissingCurveError: there are more curves than are known.
        CrossingError, GeometryError: a sheet cannot be triangulated.
    """
    along = SHARE * np.broadcast_to(tolerances, len(curves))
    nodes = [point for region in curves for point in region.turning_feet()]
    return fine_enough_to_part(
        lambda finer, chords, finest: _drafted(
            geometry, curves, (along / finer, chords, finest), nodes, with_trims
        )
    )


def _drafted(
    geometry: Geometry,
    curves: Sequence[RegionCurves],
    sampling: tuple[Array, int, bool],
    nodes: Sequence[Array],
    with_trims: bool,
) -> Draft:
    along, chords, finest = sampling
    surface = boundary_mesh(geometry, float(along.max()), nodes=nodes)
    points = surface.points
    parts = []
    for number, region in enumerate(curves):
        vertices = _vertices_of(surface, number, len(region.incidence.boundary.faces))
        own = float(along[number]), chords, finest
        maker = RegionAssembler(region, vertices, points, *own)
        with stage("sheets", geometry.regions[number].name):
            parts.append(maker.assemble())
        points = np.concatenate([points, parts[-1].points])
    return _joined(surface, parts, with_trims)


def _joined(surface: BoundaryMesh, parts: Sequence[RegionParts], with_trims: bool) -> Draft:
    joined = Joined([each.patch for each in surface.patches], surface.lines, with_trims)
    numbers = [joined.add(each) for each in parts]
    points = np.concatenate([surface.points, *(each.points for each in parts)])
    return Draft(
        surface,
        tuple(parts),
        Complex(points, tuple(joined.patches), tuple(joined.lines)),
        tuple(each.sheets for each in numbers),
        tuple(each.trims for each in numbers),
        tuple(each.lines for each in numbers),
    )


def _vertices_of(surface: BoundaryMesh, region: int, count: int) -> BoundaryVertices:
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
