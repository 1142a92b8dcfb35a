"""One complex of boundary, sheets and trim surfaces, and the skeleton that it shows."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from decomp.complex.model import Complex, CurveElement, Line, LineKind, Patch
from decomp.errors import GeometryError
from decomp.geometry import Geometry
from decomp.sampled.bisecting import Bisected
from decomp.sampled.elements import PlacedCurve
from decomp.sampled.extracted import Extracted
from decomp.sampled.interior import Interior
from decomp.sampled.lines import Chain, chains
from decomp.sampled.loci import Run, runs, welded
from decomp.sampled.patches import RegionWalls, WallMaker, numbered_trims
from decomp.sampled.placing import Placer
from decomp.sites.site import SiteKind
from decomp.skeletons.balls.queries import region_queries
from decomp.skeletons.balls.region_context import RegionContext
from decomp.skeletons.cells.partition import face_cells, skeleton_cells
from decomp.skeletons.certificate.certificate import Certified
from decomp.skeletons.certificate.evidence import Evidence
from decomp.skeletons.certified_region import certified_region
from decomp.skeletons.curves.curve_elements import LocusCurve
from decomp.skeletons.curves.incidence import Incidence
from decomp.skeletons.curves.reflexive import ReflexivePart, reflexive_parts
from decomp.skeletons.model import (
    Junction,
    Method,
    Parity,
    Reflexive,
    RegionSkeleton,
    Sheet,
    SkeletonLine,
)
from decomp.skeletons.traced_region import TracedRegion
from decomp.vectors import Array, Ints, cross, norm


@dataclass(frozen=True, eq=False)
class RegionTools:
    """What the walls of one region are made with, if it is sampled and not traced."""

    incidence: Incidence
    placer: Placer
    owner: dict[int, int]
    loci: tuple[ReflexivePart, ...]
    sampled: bool


@dataclass(frozen=True, eq=False)
class Drawn:
    """A complex of all regions.

    Args:
        complex: boundaries' patches first, then each region's sheets and trim surfaces.
        chains: its lines, in their order.
        walls: of each region.
        first: the number of each region's first patch.
        vertices: for each region the point that each of its walls' vertices is.
        loci: of each region, with their points; what is of dimension 1 is a line behind `chains`.
    """

    complex: Complex
    chains: tuple[Chain, ...]
    walls: tuple[RegionWalls, ...]
    first: tuple[int, ...]
    vertices: tuple[Ints, ...]
    loci: tuple[tuple[tuple[Run, Ints], ...], ...]


def drawn(
    geometry: Geometry,
    given: Interior,
    mesh: Bisected,
    tools: Sequence[RegionTools],
    extracted: Sequence[Extracted],
    spacing: float,
) -> Drawn:
    """Put boundaries and walls together.

    Args:
        geometry: of the model.
        given: the boundaries' elements.
        mesh: the tetrahedra whose triangles show the boundaries.
        tools, extracted: of each region.
        spacing: about the length of chords of loci.
    """
    used, corners = np.unique(mesh.triangles, return_inverse=True)
    number = np.full(len(mesh.points), -1, dtype=np.int64)
    number[used] = np.arange(len(used))
    points, count = [mesh.points[used]], len(used)
    vertices = []
    for found in extracted:
        own = np.where(found.node >= 0, number[found.node], -1)
        inner = np.flatnonzero(found.node < 0)
        own[inner] = count + np.arange(len(inner))
        points.append(found.points[inner])
        count += len(inner)
        vertices.append(own)
    every = np.concatenate(points)
    triangles = corners.reshape(-1, 3)
    patches = [
        replace(patch, triangles=triangles[mesh.patches == k])
        for k, patch in enumerate(given.plan.complex.patches)
    ]
    walls, first = [], []
    for tool, found, own in zip(tools, extracted, vertices, strict=True):
        made = WallMaker(tool.incidence, tool.placer, tool.owner).made(found, every, own)
        walls.append(made)
        first.append(len(patches))
        patches += [*made.sheet_patches, *made.trim_patches]
    loci = []
    nodes = np.arange(len(used))
    for tool, made in zip(tools, walls, strict=True):
        size = tool.incidence.boundary.diagonal
        none = np.empty((0, 3), dtype=np.int64)
        sheets = np.concatenate([none, *(patch.triangles for patch in made.sheet_patches)])
        found_runs = runs(tool.loci, every, sheets, nodes, size, spacing)
        new, chains_of = welded(found_runs, size, len(every))
        every = np.concatenate([every, new])
        loci.append(tuple(zip(found_runs, chains_of, strict=True)))
    shown = _with_lines(given, tools, every, patches, walls, first, vertices)
    return replace(shown, loci=tuple(loci), complex=_with_loci(shown.complex, loci))


def without_trims(given: Interior, tools: Sequence[RegionTools], shown: Drawn) -> Drawn:
    """The same without trim surfaces; lines are those along which sheets and faces meet."""
    patches = list(shown.complex.patches[: len(given.plan.complex.patches)])
    walls, first = [], []
    for made, start in zip(shown.walls, shown.first, strict=True):
        first.append(len(patches))
        patches += shown.complex.patches[start : start + len(made.sheets)]
        walls.append(replace(made, trims=(), trim_patches=()))
    points, vertices = shown.complex.points, list(shown.vertices)
    left = _with_lines(given, tools, points, patches, walls, first, vertices)
    return replace(left, loci=shown.loci, complex=_with_loci(left.complex, shown.loci))


def _with_loci(given: Complex, loci: Sequence[Sequence[tuple[Run, Ints]]]) -> Complex:
    lines = list(given.lines)
    for own in loci:
        for run, vertices in own:
            if run.part.locus is not None and len(vertices) > 1:
                lines.append(Line(LineKind.REFLEXIVE, LocusCurve(run.part.locus), vertices))
    return replace(given, lines=tuple(lines))


def _with_lines(
    given: Interior,
    tools: Sequence[RegionTools],
    points: Array,
    patches: list[Patch],
    walls: list[RegionWalls],
    first: list[int],
    vertices: list[Ints],
) -> Drawn:
    patch = np.repeat(np.arange(len(patches)), [len(p.triangles) for p in patches])
    triangles = np.concatenate([p.triangles for p in patches])
    found = chains(triangles, patch)
    of_patch: dict[int, tuple[int, int]] = {}
    region_of: dict[int, int] = {}
    for number, (made, start) in enumerate(zip(walls, first, strict=True)):
        for k, sites in enumerate(made.sheets):
            of_patch[start + k] = sites
        for k, part in enumerate(made.trim_patches):
            of_patch[start + len(made.sheets) + k] = part.surface.sites  # type: ignore[attr-defined]
        for k in range(len(made.sheets) + len(made.trims)):
            region_of[start + k] = number
    boundary = len(given.plan.complex.patches)
    known: dict[tuple[int, ...], list[int]] = {}
    for number, around in enumerate(given.plan.around_line):
        known.setdefault(around, []).append(number)
    lines = []
    for chain in found:
        own = tuple(sorted({p for p in chain.patches if p < boundary}))
        ends = np.array(chain.vertices, dtype=np.int64)
        curve: CurveElement
        if own in known:
            kind = LineKind.EDGE
            curve = _nearest(given, known[own], points[ends])
        else:
            walls_at = [p for p in chain.patches if p >= boundary]
            if own or not walls_at:
                raise GeometryError(
                    "faces or walls meet where there is no edge, at {at}", at=points[ends[0]]
                )
            meeting: tuple[int, ...] = tuple(
                sorted({site for p in walls_at for site in of_patch[p]})
            )
            curve = PlacedCurve(tools[region_of[walls_at[0]]].placer, meeting)
            kind = _kind([p for p in walls_at if _is_sheet(p, walls, first)])
        lines.append(Line(kind, curve, ends))
    return Drawn(
        Complex(points, tuple(patches), tuple(lines)),
        tuple(found),
        tuple(walls),
        tuple(first),
        tuple(vertices),
        (),
    )


def _nearest(given: Interior, lines: Sequence[int], points: Array) -> CurveElement:
    """Of some lines of the boundary the one that holds points."""
    curves = [given.plan.complex.lines[k].curve for k in lines]
    off = [float(norm(curve.place(points) - points).max()) for curve in curves]
    return curves[int(np.argmin(off))]


def _is_sheet(patch: int, walls: Sequence[RegionWalls], first: Sequence[int]) -> bool:
    return any(
        start <= patch < start + len(made.sheets) for made, start in zip(walls, first, strict=True)
    )


def _kind(sheets: Sequence[int]) -> LineKind:
    if len(sheets) >= 3:
        return LineKind.SEAM
    return LineKind.TRIM if len(sheets) == 2 else LineKind.RIM


class Described:
    """What the parts of a complex are in the regions' skeletons."""

    def __init__(
        self,
        geometry: Geometry,
        given: Interior,
        tools: Sequence[RegionTools],
        shown: Drawn,
        mesh: Complex,
        number: Ints,
        traced: Mapping[int, TracedRegion],
    ) -> None:
        """Args: `number` tells the new number of each of `shown`'s points in `mesh`."""
        self._traced = traced
        self._geometry, self._given, self._tools = geometry, given, tools
        self._shown, self.mesh, self._number = shown, mesh, number
        self.radius = self._radius()

    def _radius(self) -> Array:
        mesh, count = self.mesh, len(self._given.plan.complex.patches)
        radius = np.zeros(len(mesh.points))
        on = np.zeros(len(mesh.points), dtype=np.bool_)
        for patch in mesh.patches[:count]:
            on[patch.triangles] = True
        rows = np.flatnonzero(~on)
        radius[rows] = self._geometry.index.nearest(mesh.points[rows]).distance
        return radius

    def region(self, number: int) -> tuple[RegionSkeleton, Certified]:
        """The skeleton of one region, with its certificate."""
        geometry, mesh = self._geometry, self.mesh
        if number in self._traced:
            return self._traced[number].finished(geometry, mesh, self.radius, self._number)
        boundary = geometry.regions[number]
        made, first = self._shown.walls[number], self._shown.first[number]
        sheets = tuple(self._sheet(number, first + k, sites) for k, sites in enumerate(made.sheets))
        trims = numbered_trims(made, first + len(made.sheets))
        face_sides = self._given.surface.face_sides(number, len(boundary.faces))
        owner = self._tools[number].owner
        of_faces = face_cells(mesh, boundary, face_sides, sheets, trims, owner)
        cells = skeleton_cells(mesh, boundary, of_faces, trims)
        reflexive = self._reflexive(number)
        evidence = Evidence(
            geometry.index,
            number,
            geometry.diagonal,
            mesh,
            self.radius,
            sheets,
            reflexive,
            face_sides,
            cells,
            of_faces,
        )
        lines = self._lines(number)
        junctions = self._junctions(number, lines)
        return certified_region(evidence, boundary, lines, junctions, Method.SAMPLED)

    def _sheet(self, region: int, patch: int, sites: tuple[int, int]) -> Sheet:
        triangles = self.mesh.patches[patch].triangles
        corners = self.mesh.points[triangles]
        doubled = norm(cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]))
        used = self.radius[triangles]
        return Sheet(
            sites,
            self._parity(region, sites),
            patch,
            float(doubled.sum() / 2),
            (float(used.min()), float(used.max())),
        )

    def _parity(self, region: int, pair: tuple[int, int]) -> Parity | None:
        sites = [self._geometry.sites[s] for s in pair]
        if any(site.kind is not SiteKind.FACE for site in sites):
            return None
        faces = self._geometry.regions[region].faces
        a, b = (faces[site.index].outward for site in sites)
        return Parity.EVEN if a == b else Parity.ODD

    def _lines(self, region: int) -> list[tuple[LineKind, SkeletonLine]]:
        """Seams, trims and rims of a region."""
        made, first = self._shown.walls[region], self._shown.first[region]
        found = []
        for number, chain in enumerate(self._shown.chains):
            sheets = [p - first for p in chain.patches if 0 <= p - first < len(made.sheets)]
            if not sheets or min(chain.patches) < len(self._given.plan.complex.patches):
                continue
            vertices = self.mesh.lines[number].vertices
            length = float(norm(np.diff(self.mesh.points[vertices], axis=0)).sum())
            sites = tuple(sorted({site for k in sheets for site in made.sheets[k]}))
            line = SkeletonLine(sites, tuple(sorted(set(sheets))), number, length, chain.closed)
            found.append((_kind(sheets), line))
        return found

    def _reflexive(self, region: int) -> tuple[Reflexive, ...]:
        number = len(self._shown.chains)
        found = []
        for k, own in enumerate(self._shown.loci):
            for run, vertices in own:
                site = run.part.sites[0]
                if len(vertices) > 1:
                    if k == region:
                        at = self.mesh.points[self.mesh.lines[number].vertices]
                        length = float(norm(np.diff(at, axis=0)).sum())
                        found.append(Reflexive(site, 1, number, None, length, run.closed))
                    number += 1
                elif k == region:
                    found.append(
                        Reflexive(site, 0, None, int(self._number[vertices[0]]), 0.0, False)
                    )
        return tuple(found)

    def _junctions(
        self, region: int, lines: Sequence[tuple[LineKind, SkeletonLine]]
    ) -> tuple[Junction, ...]:
        """Where seams end: all but the points where one seam merely crosses a trim."""
        ending: dict[int, int] = {}
        sites: dict[int, set[int]] = {}
        for kind, line in lines:
            ends = self.mesh.lines[line.line].vertices[[0, -1]]
            for end in [] if line.closed else ends.tolist():
                sites.setdefault(end, set()).update(line.sites)
                if kind is LineKind.SEAM:
                    ending[end] = ending.get(end, 0) + 1
        return tuple(
            Junction(end, float(self.radius[end]), tuple(sorted(sites[end])))
            for end, count in sorted(ending.items())
            if count != 2
        )


def tools_of(geometry: Geometry, number: int, owner: Ints, sampled: bool) -> RegionTools:
    """The tools of a region, which is sampled or not."""
    queries = region_queries(geometry.index, number)
    incidence = Incidence(RegionContext(geometry.index, number))
    own = {
        site: int(owner[site]) for site, each in enumerate(geometry.sites) if each.region == number
    }
    loci = tuple(reflexive_parts(incidence)) if sampled else ()
    return RegionTools(incidence, Placer(incidence, queries), own, loci, sampled)
