"""The skeleton of a model: curves, sheets, one complex, cells and certificate.

1. The boundaries of all regions are triangulated as one conforming complex.
2. For each region all curves of the skeleton are traced (seams, trims, rims, reflexive loci).
3. The curves are sampled; sheets are triangulated between them.
4. The complex is refined to the chord tolerance.
5. Cells are put together, and the certificate is measured. If it falls short, everything is done
   again more finely.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np

from decomp.certificate.certificate import VOLUME
from decomp.complex.boundary import BoundaryMesh, boundary_mesh
from decomp.csg.model import Model
from decomp.csg.solid import Solid
from decomp.errors import GeometryError
from decomp.fineness import fine_enough, finer, volume_error
from decomp.geometry import Geometry
from decomp.medial.assembly import RegionAssembler, RegionParts
from decomp.medial.region_curves import RegionCurves, region_curves
from decomp.medial.result import Skeleton
from decomp.medial.sheets import CrossingError, MissingCurveError
from decomp.medial.trim_maker import BoundaryVertices
from decomp.whole import Whole

TOLERANCE = 5e-4
"""Default chord tolerance, relative to the model's diagonal."""
SHARE = 0.7
"""The part of the tolerance that curves may use up."""
SAMPLES = (2000, 20000)
"""Boundary points from which seams are looked for, attempt by attempt."""
FINER = 4
"""How much finer curves are sampled where they cross."""
LEVELS = 5
FINENESSES = 4
"""How often the tolerance is made finer for the volume's sake."""

Progress = Callable[[str, float], None]


def skeleton(
    source: Geometry | Model | Solid | dict[str, Solid] | str | Path,
    tolerance: float = TOLERANCE,
    progress: Progress | None = None,
) -> Skeleton:
    """The exact interior skeleton of a model.

    Args:
        source: a geometry, or what one can be made of.
        tolerance: largest distance of triangles from their exact surfaces, relative to the
            model's diagonal.
        progress: told what is being done, and which part of the whole (0 to 1) is behind.

    Raises:
        FileError: the file cannot be read.
        GeometryError: the solid, or its skeleton, cannot be computed; says where and what was
            tried.
    """
    geometry = source if isinstance(source, Geometry) else Geometry(source)
    tell = progress or (lambda what, done: None)
    failures: list[str] = []
    for samples in SAMPLES:
        try:
            result, failures = _Attempt(geometry, tolerance, samples, tell).result()
        except MissingCurveError as error:
            failures = [str(error)]
            continue
        if result is not None:
            return result
    raise GeometryError(
        f"the skeleton fails its certificate, with {SAMPLES[-1]} samples too: "
        + "; ".join(failures)
    )


class _Attempt:
    """One try at a skeleton, with seams looked for from `samples` boundary points."""

    def __init__(self, geometry: Geometry, tolerance: float, samples: int, tell: Progress) -> None:
        self._geometry, self._relative, self._samples = geometry, tolerance, samples
        self._tell = tell

    def result(self) -> tuple[Skeleton | None, list[str]]:
        """The skeleton, or None and what is wrong with it."""
        geometry = self._geometry
        curves = []
        for number, boundary in enumerate(geometry.regions):
            self._tell(f"tracing {boundary.name}", 0.6 * number / len(geometry.regions))
            curves.append(region_curves(geometry.index, boundary, number, self._samples))
        fineness = fine_enough(geometry, self._relative, SHARE)
        for left in reversed(range(FINENESSES)):
            self._tell("triangulating sheets", 0.6)
            surface, parts = self._parts(curves, fineness * geometry.diagonal)
            self._tell("refining", 0.7)
            whole = Whole(geometry, self._relative, fineness, surface, curves, parts)
            error = volume_error(geometry, surface, whole.complex)
            if error > VOLUME and left:
                fineness = finer(fineness, error)
                continue
            self._tell("measuring", 0.9)
            result = whole.result()
            if not result.only_volume:
                break
            fineness = finer(fineness, result.volume_error)
        return result.skeleton, result.failures

    def _parts(
        self, curves: list[RegionCurves], tolerance: float
    ) -> tuple[BoundaryMesh, list[RegionParts]]:
        """Triangulate; where curves cross in a footprint, sample them more finely."""
        tolerance *= SHARE
        nodes = [point for region in curves for point in region.turning_feet()]
        for level in range(LEVELS):
            try:
                surface = boundary_mesh(self._geometry, tolerance, nodes=nodes)
                return surface, self._regions(curves, surface, tolerance)
            except CrossingError:
                if level == LEVELS - 1:
                    raise
                tolerance /= FINER
        raise AssertionError

    def _regions(
        self, curves: list[RegionCurves], surface: BoundaryMesh, tolerance: float
    ) -> list[RegionParts]:
        points = surface.points
        parts = []
        for number, region in enumerate(curves):
            vertices = _vertices_of(surface, number, len(region.incidence.boundary.faces))
            maker = RegionAssembler(self._geometry.index, region, vertices, points, tolerance)
            parts.append(maker.assemble())
            points = np.concatenate([points, parts[-1].points])
        return parts


def _vertices_of(surface: BoundaryMesh, region: int, count: int) -> BoundaryVertices:
    """Where a region's vertices and edges are among the points of the boundary."""
    edges = []
    for run in surface.pieces.of_edge[region]:
        joined = [surface.samples.vertices[piece][::sense] for piece, sense in run]
        edges.append(np.concatenate([joined[0], *(line[1:] for line in joined[1:])]))
    faces = []
    for sides in surface.face_sides(region, count):
        parts = [surface.patches[patch].patch.triangles[:, ::sense] for patch, sense in sides]
        faces.append(np.concatenate([np.empty((0, 3), dtype=np.int64), *parts]))
    return BoundaryVertices(surface.points, surface.pieces.of_vertex[region], edges, faces)
