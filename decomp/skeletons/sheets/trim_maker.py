"""Making the trim surfaces of a region: strips between its edges and the trims over them."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial import cKDTree  # type: ignore[import-untyped]

from decomp.complex.model import Line, LineKind, Patch, PatchKind
from decomp.errors import GeometryError
from decomp.skeletons.curves.curve_elements import RayCurve
from decomp.skeletons.curves.curves_of_region import LocusRun
from decomp.skeletons.curves.incidence import Incidence
from decomp.skeletons.curves.normal_curves import EdgeNormals, NormalCurve, VertexNormals
from decomp.skeletons.curves.region_curves import RegionCurves
from decomp.skeletons.model import TrimSurface
from decomp.skeletons.sheets.trim_surfaces import RuledSurface, strip
from decomp.tolerance import AT_END
from decomp.vectors import Array, Bools, Ints, cross, dot, norm

STRAIGHT = 1e-9
"""The area of a triangle on a straight line, in parts of the square of its side."""
AT_START = 1e-6
"""Parameters so little before the start, as a part of the period, are at it."""
DIFFERENCE = 1e-4
"""Step of differences along a curve, as a part of it."""


@dataclass(frozen=True, eq=False)
class BoundaryVertices:
    """Where a region's boundary is in the complex.

    Args:
        points: (n, 3) all points of the boundary complex; they are the first of the whole.
        of_vertex: the point of each of the region's vertices.
        of_edge: for each edge its polyline of points, along the edge; closed ones repeat the first.
        of_face: triangles (m, 3) of each face.
    """

    points: Array
    of_vertex: Sequence[int]
    of_edge: Sequence[Ints]
    of_face: Sequence[Ints]


def owners(curves: RegionCurves) -> dict[int, int]:
    """The face that owns each site: an edge's or vertex's is one of its faces."""
    incidence = curves.incidence
    boundary = incidence.boundary
    owner = {site: face for face, site in incidence.face_site.items()}
    for edge, site in incidence.edge_site.items():
        owner[site] = boundary.edges[edge].faces[0]
    for vertex, site in incidence.vertex_site.items():
        edges = [e for e in boundary.vertices[vertex].edges if e in incidence.edge_site]
        faces = boundary.vertices[vertex].faces
        owner[site] = boundary.edges[edges[0]].faces[0] if edges else faces[0]
    return owner


@dataclass(frozen=True, eq=False)
class _Strip:
    """A part of a trim surface.

    Args:
        curve: of its normals.
        lower, upper: vertices of its borders, along the edge and the trim.
        lower_s, upper_s: their parameters.
    """

    curve: NormalCurve
    lower: Ints
    lower_s: Array
    upper: Ints
    upper_s: Array


class _Centres:
    """The centres (k, 3) of a run along a reflexive locus, and what lies between them."""

    def __init__(self, points: Array, slack: float) -> None:
        self._points, self._slack = points, slack
        away = norm(points - points[0])
        self.closed = bool(away[-1] <= slack < away.max())
        self._tree = cKDTree(points)
        self._reach = float(norm(np.diff(points, axis=0)).max())

    def nearest(self, points: Array) -> Ints:
        """Which centre is nearest to each of some points."""
        return np.asarray(self._tree.query(points)[1], dtype=np.int64)

    def hold(self, points: Array) -> bool:
        """Whether all of some points of the locus are between the first and the last centre."""
        gaps, rows = self._tree.query(points)
        last = len(self._points) - 1
        beside = np.where(rows == 0, 1, np.where(rows == last, last - 1, rows))
        inwards = self._points[beside] - self._points[rows]
        past = (dot(points - self._points[rows], inwards) < 0) & (not self.closed)
        return bool(((gaps <= self._reach) & (~past | (gaps <= self._slack))).all())


class TrimMaker:
    """Makes the trim surfaces between the cells of different faces."""

    def __init__(
        self, curves: RegionCurves, boundary: BoundaryVertices, points: Array, lines: Sequence[Ints]
    ) -> None:
        self._curves, self._boundary = curves, boundary
        self._points, self._lines = points, lines
        self._owner = owners(curves)
        self._rulings: set[tuple[int, int]] = set()
        self._size = curves.incidence.boundary.diagonal

    def surfaces(self) -> list[tuple[TrimSurface, Patch]]:
        """Each with the faces on its two sides; the patch number is to be filled in."""
        found = []
        for number, curve in enumerate(self._curves.over):
            one, two = (self._owner[site] for site in curve.sites)
            if one == two:
                continue
            upper, upper_s = self._upper(number, curve)
            lower = self._lower(curve)
            for strip_ in self._strips(number, lower, upper, upper_s):
                triangles = self._strip(strip_)
                if len(triangles):
                    found.append(self._patch(strip_, triangles))
        return found

    def _strips(self, number: int, lower: Ints, upper: Ints, upper_s: Array) -> list[_Strip]:
        """The strips over a normal curve, cut at the normals over which centres turn back.

        There the surface folds along its upper border; each strip is on one side of the fold.
        """
        curve = self._curves.over[number]
        turns = self._curves.turns(number)
        if not turns:
            if not curve.closed:
                self._end(lower[0], upper[0])
                self._end(lower[-1], upper[-1])
            lower_s = self._along(curve, self._points[lower]) if len(lower) > 1 else np.zeros(1)
            return [_Strip(curve, lower, lower_s, upper, upper_s)]
        lower_s = self._along(curve, self._points[lower])
        if lower_s[-1] < lower_s[0]:
            lower, lower_s = lower[::-1], lower_s[::-1]
        stops = [curve.start, *turns, curve.end]
        if curve.closed:
            period = curve.end - curve.start
            lower, lower_s = _from(lower, lower_s, turns[0], period)
            upper, upper_s = _from(upper, upper_s, turns[0], period)
            stops = [*turns, turns[0] + period]
        below = [int(np.argmin(np.abs(lower_s - s))) for s in stops]
        above = [int(np.argmin(np.abs(upper_s - s))) for s in stops]
        feet = curve.feet(np.array(stops))
        off = norm(self._points[lower[below]] - feet) > AT_END * self._size
        if off.any():
            raise GeometryError("the edge has no vertex at {at}", at=feet[np.argmax(off)])
        found = []
        for k, (first, last) in enumerate(itertools.pairwise(stops)):
            one, two = slice(below[k], below[k + 1] + 1), slice(above[k], above[k + 1] + 1)
            part = replace(curve, start=first, end=last, closed=False)
            found.append(_Strip(part, lower[one], lower_s[one], upper[two], upper_s[two]))
            self._end(lower[below[k]], upper[above[k]])
            self._end(lower[below[k + 1]], upper[above[k + 1]])
        return found

    def _end(self, a: int, b: int) -> None:
        """Note the ruling in which a strip ends."""
        self._rulings.add((min(int(a), int(b)), max(int(a), int(b))))

    def rulings(self) -> list[Line]:
        """The normals in which the surfaces end, as far as they are no other lines."""
        known = {
            (int(min(side)), int(max(side)))
            for line in self._lines
            for side in itertools.pairwise(line)
        }
        found = []
        for a, b in sorted(self._rulings - known):
            if a != b:
                way = self._points[b] - self._points[a]
                curve = RayCurve(self._points[a], way / float(norm(way)))
                found.append(Line(LineKind.TRIM, curve, np.array([a, b], dtype=np.int64)))
        return found

    def _lower(self, curve: NormalCurve) -> Ints:
        if isinstance(curve, EdgeNormals):
            edges = self._curves.incidence.boundary.edges
            number = next(k for k, edge in enumerate(edges) if edge is curve.edge)
            return self._boundary.of_edge[number]
        assert isinstance(curve, VertexNormals)
        vertex = int(np.argmin(norm(self._curves.nodes[: self._curves.vertices] - curve.vertex)))
        return np.array([self._boundary.of_vertex[vertex]], dtype=np.int64)

    def _upper(self, number: int, curve: NormalCurve) -> tuple[Ints, Array]:
        """The trim over a normal curve as one polyline in the sense of its parameter."""
        runs = []
        for piece, line in zip(self._curves.pieces, self._lines, strict=True):
            if number in piece.over:
                s = self._along(curve, self._points[line])
                if s[0] > s[-1]:
                    line, s = line[::-1], s[::-1]
                runs.append((line, s))
        runs += [self._on_locus(run) for run in self._curves.runs if run.over == number]
        runs.sort(key=lambda run: float(run[1].mean()))
        lines, parameters = [runs[0][0]], [runs[0][1]]
        for (before, _), (line, s) in itertools.pairwise(runs):
            if line[0] != before[-1]:
                raise GeometryError("the trim near {at} has a gap", at=self._points[line[0]])
            lines.append(line[1:])
            parameters.append(s[1:])
        return np.concatenate(lines), np.concatenate(parameters)

    def _on_locus(self, run: LocusRun) -> tuple[Ints, Array]:
        """The polyline along a reflexive locus from the first to the last centre of a run."""
        ends = [self._vertex_at(run.points[k]) for k in (0, -1)]
        if run.resting:
            return np.array(ends), run.s[[0, -1]]
        centres = _Centres(run.points, AT_END * self._size)
        line = [ends[0]]
        while line[-1] != ends[1] or (centres.closed and len(line) == 1):
            step = self._next_on_locus(line, centres)
            if step is None:
                middle = run.points[len(run.points) // 2]
                raise GeometryError("no reflexive curve leads past {at}", at=middle)
            line.extend(step)
        vertices = np.array(line, dtype=np.int64)
        return vertices, run.s[centres.nearest(self._points[vertices])]

    def _next_on_locus(self, line: list[int], centres: _Centres) -> list[int] | None:
        """The vertices of the reflexive piece that goes on from a polyline along known centres."""
        for piece, vertices in zip(self._curves.pieces, self._lines, strict=True):
            if piece.kind is not LineKind.REFLEXIVE:
                continue
            for way in (vertices, vertices[::-1]):
                if way[0] != line[-1] or (len(line) > 1 and way[1] == line[-2]):
                    continue
                if centres.hold(np.stack([piece.middle, self._points[way[-1]]])):
                    return [int(v) for v in way[1:]]
        return None

    def _vertex_at(self, point: Array) -> int:
        gaps = norm(self._points - point)
        number = int(np.argmin(gaps))
        if float(gaps[number]) > AT_END * self._size:
            raise GeometryError("no reflexive curve leads to {at}", at=point)
        return number

    def _along(self, curve: NormalCurve, points: Array) -> Array:
        """Parameters of the vertices of a polyline, made continuous."""
        s = np.array(curve.parameter(points))
        if curve.closed:
            period = curve.end - curve.start
            turn = np.diff(s)
            s[1:] -= period * np.cumsum(np.round(turn / period))
        return s

    def _strip(self, given: _Strip) -> Ints:
        if given.curve.closed and len(given.lower) > 1:
            return self._ring(given.curve, given.lower, given.lower_s, given.upper, given.upper_s)
        return self._between(given.curve, given.lower, given.lower_s, given.upper, given.upper_s)

    def _between(
        self, curve: NormalCurve, lower: Ints, lower_s: Array, upper: Ints, upper_s: Array
    ) -> Ints:
        """The triangles between two borders, without folds under hollows of the upper one."""
        found = strip(lower, lower_s, upper, upper_s, self._heights(curve, upper, upper_s))
        if self._on_lines(found).any():
            # the upper border is straight in space, as where all normals end in a cylinder's axis
            found = strip(lower, lower_s, upper, upper_s, np.ones(len(upper)))
        return found

    def _on_lines(self, triangles: Ints) -> Bools:
        """Which triangles have their three vertices on a straight line."""
        a, b, c = (self._points[triangles[:, k]] for k in range(3))
        square = np.maximum(norm(b - a), norm(c - a)) ** 2
        return np.asarray(norm(cross(b - a, c - a)) <= STRAIGHT * square)

    def _heights(self, curve: NormalCurve, upper: Ints, upper_s: Array) -> Array:
        """How high (k,) vertices are above the edge, in units of its parameter."""
        span = curve.end - curve.start
        length = float(
            norm(np.diff(curve.feet(np.linspace(curve.start, curve.end, 17)), axis=0)).sum()
        )
        return norm(self._points[upper] - curve.feet(upper_s)) * (span / length if length else 1.0)

    def _ring(
        self, curve: NormalCurve, lower: Ints, lower_s: Array, upper: Ints, upper_s: Array
    ) -> Ints:
        """A strip that closes: the upper loop is turned to start beside the lower one's start."""
        period = curve.end - curve.start
        if lower_s[-1] < lower_s[0]:
            lower, lower_s = lower[::-1], lower_s[::-1]
        if (upper == upper[0]).all():
            return strip(lower, lower_s, upper[:1], lower_s[:1], np.ones(1))
        body, s = upper[:-1], upper_s[:-1]
        s = lower_s[0] + np.mod(s - lower_s[0], period)
        order = np.argsort(s, kind="stable")
        body, s = body[order], s[order]
        body, s = np.append(body, body[0]), np.append(s, s[0] + period)
        return self._between(curve, lower, lower_s, body, s)

    def _patch(self, given: _Strip, triangles: Ints) -> tuple[TrimSurface, Patch]:
        """Orient: normals point from the higher-dimensional site's side to the other's."""
        curve, upper, upper_s = given.curve, given.upper, given.upper_s
        near, far = curve.sites[1], curve.sites[0]
        s = np.linspace(curve.start, curve.end, 257)
        height = np.interp(s, upper_s, norm(self._points[upper] - curve.feet(upper_s)))
        surface = RuledSurface(curve, self._sense(curve), s, height)
        corners = self._points[triangles]
        normals = cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        wanted = surface.normal(corners.mean(axis=1))
        oriented = triangles[:, ::-1] if float(dot(normals, wanted).sum()) < 0 else triangles
        faces = (self._owner[near], self._owner[far])
        return TrimSurface(-1, faces), Patch(PatchKind.TRIM, surface, oriented)

    def _sense(self, curve: NormalCurve) -> float:
        """The sign that makes normals point from the second site's side to the first's."""
        middle = np.array([(curve.start + curve.end) / 2])
        feet, ways = curve.feet(middle), curve.directions(middle)
        h = DIFFERENCE * (curve.end - curve.start)
        either = curve.feet(middle + h) - curve.feet(middle - h)
        if isinstance(curve, VertexNormals):
            either = curve.directions(middle + h) - curve.directions(middle - h)
        up = cross(either, ways)[0]
        away = self._off_second(curve, feet[0])
        return 1.0 if float(up @ away) > 0 else -1.0

    def _off_second(self, curve: NormalCurve, foot: Array) -> Array:
        """A direction at a foot that leads away from the second site."""
        incidence = self._curves.incidence
        if isinstance(curve, VertexNormals):
            # the edge leaves the vertex: away from it is against the edge
            edge = incidence.sites[curve.sites[1]].index
            samples = incidence.boundary.edges[edge].samples
            ends = samples[0], samples[-1]
            near = samples[1] if norm(ends[0] - foot) < norm(ends[1] - foot) else samples[-2]
            return np.asarray(foot - near)
        assert isinstance(curve, EdgeNormals)
        second = incidence.sites[curve.sites[1]].index
        edge = next(k for k, e in enumerate(incidence.boundary.edges) if e is curve.edge)
        return _out_of_face(incidence, second, edge, foot)


def _from(loop: Ints, s: Array, start: float, period: float) -> tuple[Ints, Array]:
    """A closed polyline that starts at its vertex of a given parameter."""
    slack = AT_START * period
    s = start - slack + np.mod(s[:-1] - start + slack, period)
    order = np.argsort(s, kind="stable")
    turned, s = loop[:-1][order], s[order]
    return np.append(turned, turned[0]), np.append(s, s[0] + period)


def _out_of_face(incidence: Incidence, face: int, edge: int, foot: Array) -> Array:
    """The direction in a face's tangent plane that leaves it across one of its edges."""
    boundary = incidence.boundary
    outward = -incidence.inward(face, foot[None])[0]
    tangent = incidence.tangent(edge, foot)
    for loop in boundary.faces[face].loops:
        for number, sense in loop:
            if number == edge:
                # the face lies on the left of its loop, seen from outside
                return np.asarray(-cross(outward, sense * tangent))
    raise GeometryError("the edge at {at} is not one of its face's", at=foot)
