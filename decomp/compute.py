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
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from decomp.cells.partition import TrimSurface, face_cells, skeleton_cells
from decomp.certificate.certificate import VOLUME, Certified, certified, explained, shortcomings
from decomp.certificate.evidence import Evidence
from decomp.complex.boundary import BoundaryMesh, boundary_mesh
from decomp.complex.model import Complex, LineKind, Patch, PatchKind
from decomp.complex.refine import refined
from decomp.csg.model import Model
from decomp.csg.solid import Solid
from decomp.errors import GeometryError
from decomp.fineness import fine_enough, finer, volume_error
from decomp.geometry import Geometry
from decomp.medial.assembly import RegionAssembler, RegionParts
from decomp.medial.radius_range import SheetRadius, range_along
from decomp.medial.region_curves import RegionCurves, region_curves
from decomp.medial.result import (
    Junction,
    Parity,
    Reflexive,
    RegionSkeleton,
    Sheet,
    Skeleton,
    SkeletonLine,
)
from decomp.medial.sheets import CrossingError, MissingCurveError, SheetPart
from decomp.medial.trim_maker import BoundaryVertices, owners
from decomp.sites.site import SiteKind
from decomp.tracing.queries import region_queries
from decomp.vectors import Array, Ints, cross, norm

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
            whole = _Whole(geometry, self._relative, fineness, surface, curves, parts)
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


@dataclass(frozen=True, eq=False)
class _Result:
    """What has come of a try.

    Args:
        skeleton: None if it fails its certificate.
        failures: why.
        only_volume: whether only the cells' volumes are too far off.
        volume_error: the largest.
    """

    skeleton: Skeleton | None
    failures: list[str]
    only_volume: bool
    volume_error: float


class _Whole:
    """The complex of all regions, refined, and what its parts are."""

    def __init__(
        self,
        geometry: Geometry,
        relative: float,
        fineness: float,
        surface: BoundaryMesh,
        curves: list[RegionCurves],
        parts: list[RegionParts],
    ) -> None:
        self._geometry, self._relative = geometry, relative
        self._surface, self._curves, self._parts = surface, curves, parts
        patches = [each.patch for each in surface.patches]
        lines = list(surface.lines)
        self._sheet_patch: list[list[int]] = []
        self._trims: list[list[TrimSurface]] = []
        self._line: list[list[int]] = []
        for part in parts:
            self._sheet_patch.append([len(patches) + k for k in range(len(part.sheets))])
            patches += [Patch(PatchKind.SHEET, s.surface, s.triangles) for s in part.sheets]
            own = []
            for trim, patch in part.trims:
                own.append(TrimSurface(len(patches), trim.faces))
                patches.append(patch)
            self._trims.append(own)
            self._line.append([len(lines) + k for k in range(len(part.lines))])
            lines += part.lines + part.rulings
        points = np.concatenate([surface.points, *(part.points for part in parts)])
        given = Complex(points, tuple(patches), tuple(lines))
        self.complex, self._number = refined(given, fineness * geometry.diagonal)

    def result(self) -> _Result:
        """The finished skeleton, or what its certificate lacks."""
        geometry = self._geometry
        radius = self._radius()
        regions: list[RegionSkeleton] = []
        failures: list[str] = []
        short: set[str] = set()
        for number in range(len(geometry.regions)):
            region, found = self._region(number, radius)
            regions.append(region)
            short |= set(shortcomings(found.certificate, self._relative))
            lines = explained(found, self._relative, geometry.sites)
            failures += [f"region {region.name}: {line}" for line in lines]
        made = Skeleton(
            geometry.model.name,
            geometry.diagonal,
            self._relative * geometry.diagonal,
            geometry.sites,
            self.complex,
            radius,
            tuple(regions),
        )
        return _Result(
            None if failures else made,
            failures,
            short == {"volume_error"},
            max(region.certificate.volume_error for region in regions),
        )

    def _radius(self) -> Array:
        points = self.complex.points
        radius = np.zeros(len(points))
        boundary = [p.triangles for p in self.complex.patches[: len(self._surface.patches)]]
        on = np.zeros(len(points), dtype=np.bool_)
        for triangles in boundary:
            on[triangles] = True
        rows = np.flatnonzero(~on)
        index = self._geometry.index
        for region in range(len(self._geometry.regions)):
            inside, depth = region_queries(index, region).depth(points[rows])
            radius[rows[inside]] = depth[inside]
            rows = rows[~inside]
        if len(rows):
            radius[rows] = index.nearest(points[rows]).distance
        return radius

    def _region(self, number: int, radius: Array) -> tuple[RegionSkeleton, Certified]:
        curves, parts = self._curves[number], self._parts[number]
        boundary = self._geometry.regions[number]
        sheets = tuple(
            self._sheet(number, part, patch, radius)
            for part, patch in zip(parts.sheets, self._sheet_patch[number], strict=True)
        )
        lines = self._lines(number, sheets)
        sheets = self._with_extrema(number, sheets, [line for _, line in lines], radius)
        reflexive = self._reflexive(number)
        face_sides = self._surface.face_sides(number, len(boundary.faces))
        trims = self._trims[number]
        owner = owners(curves)
        mesh = self.complex
        cells_of_faces = face_cells(mesh, boundary, face_sides, sheets, trims, owner)
        cells = skeleton_cells(mesh, boundary, cells_of_faces, trims)
        evidence = Evidence(
            self._geometry.index,
            number,
            self._geometry.diagonal,
            mesh,
            radius,
            sheets,
            reflexive,
            face_sides,
            cells,
            cells_of_faces,
        )
        found = certified(evidence)
        return (
            RegionSkeleton(
                boundary.name,
                boundary,
                sheets,
                tuple(line for kind, line in lines if kind is LineKind.SEAM),
                tuple(line for kind, line in lines if kind is LineKind.TRIM),
                tuple(line for kind, line in lines if kind is LineKind.RIM),
                self._junctions(number, radius),
                reflexive,
                face_sides,
                cells,
                cells_of_faces,
                found.certificate,
            ),
            found,
        )

    def _sheet(self, number: int, part: SheetPart, patch: int, radius: Array) -> Sheet:
        triangles = self.complex.patches[patch].triangles
        corners = self.complex.points[triangles]
        doubled = norm(cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]))
        queries = region_queries(self._geometry.index, number)
        over = SheetRadius(queries, part.sites, part.surface)
        return Sheet(
            part.sites,
            _parity(self._curves[number], part.sites),
            patch,
            float(doubled.sum() / 2),
            over.range(self.complex.points, triangles, radius),
        )

    def _with_extrema(
        self,
        number: int,
        sheets: tuple[Sheet, ...],
        lines: list[SkeletonLine],
        radius: Array,
    ) -> tuple[Sheet, ...]:
        """The sheets with least and greatest radius widened by those along their borders."""
        queries = region_queries(self._geometry.index, number)
        ranges = [sheet.radius for sheet in sheets]
        for line in lines:
            drawn = self.complex.lines[line.line]
            own = self.complex.points[drawn.vertices], radius[drawn.vertices]
            low, high = range_along(queries, drawn.curve, *own)
            for k in line.sheets:
                ranges[k] = (min(ranges[k][0], low), max(ranges[k][1], high))
        return tuple(replace(sheet, radius=own) for sheet, own in zip(sheets, ranges, strict=True))

    def _lines(self, number: int, sheets: tuple[Sheet, ...]) -> list[tuple[LineKind, SkeletonLine]]:
        """Seams, trims and rims, by the number of sheets that meet along them."""
        meeting: dict[tuple[int, int], list[int]] = {}
        drawn = [self.complex.lines[line].vertices for line in self._line[number]]
        firsts = np.array([np.sort(vertices[:2]) for vertices in drawn]).reshape(-1, 2)
        for k, sheet in enumerate(sheets):
            for side in _sides_among(self.complex.patches[sheet.patch].triangles, firsts).tolist():
                meeting.setdefault((side[0], side[1]), []).append(k)
        found = []
        curves = self._curves[number]
        for piece, first, line_number in zip(
            curves.pieces, firsts.tolist(), self._line[number], strict=True
        ):
            vertices = self.complex.lines[line_number].vertices
            around = meeting.get((first[0], first[1]), [])
            if not around:
                continue
            kind = _kind(len(around))
            sites = tuple(dict.fromkeys(site for c in piece.contacts for site in c))
            length = float(norm(np.diff(self.complex.points[vertices], axis=0)).sum())
            closed = piece.ends is None
            line = SkeletonLine(sites, tuple(sorted(set(around))), line_number, length, closed)
            found.append((kind, line))
        return found

    def _junctions(self, number: int, radius: Array) -> tuple[Junction, ...]:
        """The nodes at which seams end: all but those where one seam merely crosses a trim."""
        curves, parts = self._curves[number], self._parts[number]
        ending: dict[int, int] = {}
        sites: dict[int, list[int]] = {}
        for piece in curves.pieces:
            for end in piece.ends or ():
                if len(piece.pairs) > 2:
                    ending[end] = ending.get(end, 0) + 1
                sites.setdefault(end, []).extend(s for c in piece.contacts for s in c)
        found = []
        for node, count in sorted(ending.items()):
            if count == 2:
                continue
            vertex = int(self._number[parts.node[node]])
            found.append(Junction(vertex, float(radius[vertex]), tuple(dict.fromkeys(sites[node]))))
        return tuple(found)

    def _reflexive(self, number: int) -> tuple[Reflexive, ...]:
        curves, parts = self._curves[number], self._parts[number]
        found = []
        for piece, line_number in zip(curves.pieces, self._line[number], strict=True):
            if piece.kind is not LineKind.REFLEXIVE:
                continue
            vertices = self.complex.lines[line_number].vertices
            length = float(norm(np.diff(self.complex.points[vertices], axis=0)).sum())
            found.append(
                Reflexive(piece.contacts[0][0], 1, line_number, None, length, piece.ends is None)
            )
        for k, part in enumerate(curves.points):
            vertex = int(self._number[parts.node[curves.vertices + k]])
            found.append(Reflexive(part.sites[0], 0, None, vertex, 0.0, False))
        return tuple(found)


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


def _kind(sheets: int) -> LineKind:
    if sheets >= 3:
        return LineKind.SEAM
    return LineKind.TRIM if sheets == 2 else LineKind.RIM


def _sides_among(triangles: Ints, segments: Ints) -> Ints:
    """Those sides of triangles (lower vertex first) that are among segments (k, 2).

    A segment stands as often as triangles meet there: twice where a sheet lies on both sides.
    """
    sides = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    sides = np.sort(sides, axis=1)
    stride = int(max(triangles.max(initial=0), segments.max(initial=0))) + 1
    wanted = segments[:, 0] * stride + segments[:, 1]
    return np.asarray(sides[np.isin(sides[:, 0] * stride + sides[:, 1], wanted)])


def _parity(curves: RegionCurves, pair: tuple[int, int]) -> Parity | None:
    incidence = curves.incidence
    sites = [incidence.sites[s] for s in pair]
    if any(site.kind is not SiteKind.FACE for site in sites):
        return None
    a, b = (incidence.boundary.faces[site.index].outward for site in sites)
    return Parity.EVEN if a == b else Parity.ODD
