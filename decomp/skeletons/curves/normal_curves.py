"""Curves of boundary normals: where maximal balls pass from one site to a neighbour without a jump.

Along an edge the balls that touch one of its faces end; beyond a reentrant edge they touch the
edge itself, beyond a smooth edge the other face. Seen from the boundary these are the normals of
the face along the edge. At a vertex that is a site they are the normals across each reentrant edge.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from decomp.boundary.topology import Convexity, Edge
from decomp.curves.circle import Circle
from decomp.curves.line import Line
from decomp.errors import GeometryError
from decomp.skeletons.curves.incidence import ANGLE, Incidence, angle_between
from decomp.tolerance import TINY, TOLERANCE
from decomp.vectors import Array, cross, dot, nearest_rows, norm

REACH = 0.05
"""The longest step along an edge, as a part of it."""
APPROACHES = 30
"""Steps of the search for the nearest normal."""
FLAT = 1e-9
"""Points that move less than this part of a step along the edge are where normals meet."""
WORTH = 0.01
"""A step of the search is worth another one if it gains this part of the least that counts."""
DIFFERENCE = 1e-6
"""Step of differences of normals, as a part of the size."""
STEP = 1e-5
"""Step of differences of tangents, as a part of the edge."""
AT_REST = 1e-15
"""Newton's steps below this, relative to the parameter, are the last ones."""


@dataclass(frozen=True, eq=False)
class NormalCurve(ABC):
    """Feet and directions over a parameter.

    Args:
        start, end: first and last parameter.
        closed: whether the end is the start again.
        sites: the two sites that touch along it, the one of lower dimension first.
    """

    start: float
    end: float
    closed: bool
    sites: tuple[int, int]

    @property
    def touching(self) -> tuple[int, ...]:
        """All sites that touch along it: at a vertex more than one edge can have its normals."""
        return self.sites

    @abstractmethod
    def feet(self, s: Array) -> Array:
        """Boundary points (k, 3) at parameters (k,)."""

    @abstractmethod
    def directions(self, s: Array) -> Array:
        """Unit directions (k, 3) into the region."""

    @abstractmethod
    def rulings(self, points: Array, near: Array) -> tuple[Array, Array, Callable[[Array], Array]]:
        """The normals through points (k, 3) close to their ruled surface.

        Args:
            points: (k, 3).
            near: parameters (k,) close to theirs, for points close to many normals.

        Returns:
            feet and directions (k, 3), and a function that tells in which direction (k, 3) points
            at given heights (k,) above the feet move along the curve.
        """

    @abstractmethod
    def parameter(self, points: Array, near: Array | None = None) -> Array:
        """Parameters (k,) of points (k, 3) close to the ruled surface of the normals.

        Where several normals pass through a point, the one whose parameter is close to `near`.
        """


@dataclass(frozen=True, eq=False)
class EdgeNormals(NormalCurve):
    """The normals of one face along a reentrant or smooth edge."""

    edge: Edge
    face: int
    incidence: Incidence

    def feet(self, s: Array) -> Array:
        return self.edge.curve.point(s)

    def directions(self, s: Array) -> Array:
        return self.incidence.inward(self.face, self.feet(s))

    def parameter(self, points: Array, near: Array | None = None) -> Array:
        curve = self.edge.curve
        if isinstance(curve, (Line, Circle)):
            t = curve.parameter(points)
        else:
            t = self._descend(points, self._nearest(points) if near is None else near)
        if curve.closed:
            middle = np.asarray((self.start + self.end) / 2 if near is None else near)
            t = t + curve.period * np.round((middle - t) / curve.period)
        return np.asarray(t)

    def rulings(self, points: Array, near: Array) -> tuple[Array, Array, Callable[[Array], Array]]:
        s = self._approach(points, near)
        feet = self.feet(s)
        ways = self.incidence.inward(self.face, feet)

        def change(height: Array) -> Array:
            tangent, turn = self._turn(s, feet)
            along = _across(tangent + height[:, None] * turn, ways)
            flat = norm(along) <= FLAT * norm(tangent)
            along[flat] = turn[flat]
            return along

        return feet, ways, change

    def _approach(self, points: Array, start: Array) -> Array:
        """Parameters (k,) of the normals closest to points (k, 3), from others close by.

        Gauss and Newton's method; steps that lead farther away are halved twice.
        """
        least = TOLERANCE * self.incidence.boundary.diagonal
        s = self._bounded(start)
        away, feet, height = self._off(points, s)
        gap = norm(away)
        rows = np.flatnonzero(gap > least)
        reach = np.full(len(points), REACH * (self.end - self.start))
        for _ in range(APPROACHES):
            if not len(rows):
                break
            tangent, turn = self._turn(s[rows], feet[rows])
            ways = self.incidence.inward(self.face, feet[rows])
            along = _across(tangent + height[rows, None] * turn, ways)
            flat = FLAT * norm(tangent)
            step = dot(away[rows], along) / np.maximum(dot(along, along), flat**2)
            tried = self._bounded(s[rows] + np.clip(step, -reach[rows], reach[rows]))
            moved = np.abs(tried - s[rows]) * norm(tangent)
            off, at, up = self._off(points[rows], tried)
            gain = gap[rows] - norm(off)
            closer = gain > 0
            kept = rows[closer]
            s[kept], away[kept], feet[kept] = tried[closer], off[closer], at[closer]
            height[kept], gap[kept] = up[closer], norm(off[closer])
            reach[rows[~closer]] = np.abs(tried - s[rows])[~closer] / 4
            rows = rows[(moved > least) & (~closer | (gain > WORTH * least))]
        return s

    def _bounded(self, s: Array) -> Array:
        """Parameters within the edge, unless it is closed."""
        return np.array(s) if self.closed else np.clip(s, self.start, self.end)

    def _off(self, points: Array, s: Array) -> tuple[Array, Array, Array]:
        """What leads (k, 3) from normals to points across, their feet, the height (k,) there."""
        feet = self.feet(s)
        ways = self.incidence.inward(self.face, feet)
        height = dot(points - feet, ways)
        return points - feet - height[:, None] * ways, feet, height

    def _turn(self, s: Array, feet: Array) -> tuple[Array, Array]:
        """How feet and directions (k, 3) change with the parameter."""
        tangent = self.edge.curve.derivative(s)
        h = DIFFERENCE * self.incidence.boundary.diagonal
        unit = tangent / np.maximum(norm(tangent), TINY)[:, None]
        ahead = self.incidence.inward(self.face, feet + h * unit)
        behind = self.incidence.inward(self.face, feet - h * unit)
        return tangent, (ahead - behind) * (norm(tangent) / (2 * h))[:, None]

    def _nearest(self, points: Array) -> Array:
        """Parameters of the samples of the edge that are nearest to points."""
        samples, s = self._samples
        return np.asarray(s[nearest_rows(samples, points)])

    @cached_property
    def _samples(self) -> tuple[Array, Array]:
        s = np.linspace(self.start, self.end, 257)
        return self.feet(s), s

    def _descend(self, points: Array, guess: Array) -> Array:
        """Newton's method on (p - x).x' = 0, with differences for x''."""
        t = np.array(guess, dtype=np.float64)
        h = STEP * (self.end - self.start)
        limit = REACH * (self.end - self.start)
        rows = np.arange(len(t))
        for _ in range(30):
            x, d = self.edge.curve.point(t[rows]), self.edge.curve.derivative(t[rows])
            ahead = self.edge.curve.derivative(t[rows] + h)
            away = points[rows] - x
            slope = dot(away, (ahead - d) / h) - dot(d, d)
            move = np.where(slope < 0, -dot(away, d) / np.where(slope < 0, slope, 1.0), 0.0)
            t[rows] += np.clip(move, -limit, limit)
            rows = rows[np.abs(move) > AT_REST * (1 + np.abs(t[rows]))]
            if not len(rows):
                break
        return t


def _across(vectors: Array, ways: Array) -> Array:
    """The part of vectors (k, 3) across unit directions."""
    return np.asarray(vectors - dot(vectors, ways)[:, None] * ways)


@dataclass(frozen=True, eq=False)
class VertexNormals(NormalCurve):
    """The normals across a reentrant edge at its end in a vertex; the parameter is an angle."""

    vertex: Array
    first: Array
    second: Array
    others: tuple[int, ...] = ()
    """Edges that go on smoothly beyond the vertex."""

    @property
    def touching(self) -> tuple[int, ...]:
        return (*self.sites, *self.others)

    def feet(self, s: Array) -> Array:
        return np.broadcast_to(self.vertex, (*np.shape(s), 3)).copy()

    def directions(self, s: Array) -> Array:
        s = np.asarray(s)[..., None]
        return np.asarray(np.cos(s) * self.first + np.sin(s) * self.second)

    def rulings(self, points: Array, near: Array) -> tuple[Array, Array, Callable[[Array], Array]]:
        s = self.parameter(points)
        feet, ways = self.feet(s), self.directions(s)
        return feet, ways, lambda height: height[:, None] * self.directions(s + np.pi / 2)

    def parameter(self, points: Array, near: Array | None = None) -> Array:
        away = points - self.vertex
        return np.arctan2(away @ self.second, away @ self.first)


@dataclass(frozen=True, eq=False)
class VertexRay(NormalCurve):
    """A face's one normal at a vertex where two of its edges meet at a reflex angle.

    The parameter is the distance from the vertex: the whole ray is a curve of the skeleton, up to
    the centre of the maximal ball.
    """

    vertex: Array
    direction: Array

    def feet(self, s: Array) -> Array:
        return np.broadcast_to(self.vertex, (*np.shape(s), 3)).copy()

    def directions(self, s: Array) -> Array:
        return np.broadcast_to(self.direction, (*np.shape(s), 3)).copy()

    def rulings(self, points: Array, near: Array) -> tuple[Array, Array, Callable[[Array], Array]]:
        raise GeometryError("a single normal is no surface")

    def parameter(self, points: Array, near: Array | None = None) -> Array:
        return np.asarray((points - self.vertex) @ self.direction)


def normal_curves(incidence: Incidence) -> list[NormalCurve]:
    """All normal curves of a region but the rays."""
    boundary = incidence.boundary
    found: list[NormalCurve] = []
    for number, edge in enumerate(boundary.edges):
        if edge.convexity is Convexity.CONVEX:
            continue
        one, two = (incidence.face_site[f] for f in edge.faces)
        if edge.convexity is Convexity.SMOOTH:
            flanks = [((one, two), edge.faces[0])]
        else:
            own = incidence.edge_site[number]
            flanks = [((own, one), edge.faces[0]), ((own, two), edge.faces[1])]
        for sites, face in flanks:
            found.append(
                EdgeNormals(edge.start, edge.end, edge.closed, sites, edge, face, incidence)
            )
    for number, site in incidence.vertex_site.items():
        if boundary.vertices[number].convexity is Convexity.REENTRANT:
            found.extend(_fans(incidence, number, site))
    return found


def _fans(incidence: Incidence, number: int, site: int) -> list[NormalCurve]:
    vertex = incidence.boundary.vertices[number]
    between: list[tuple[int, Array, Array]] = []
    for k in vertex.edges:
        edge = incidence.boundary.edges[k]
        if edge.convexity is Convexity.REENTRANT:
            a, b = (incidence.inward(f, vertex.point[None])[0] for f in edge.faces)
            between.append((k, a, b))
    found: list[NormalCurve] = []
    for k, a, b in between:
        axis = incidence.tangent(k, vertex.point)
        angle = float(angle_between(a, b, axis))
        if angle < 0:
            axis, angle = -axis, -angle
        if angle <= ANGLE:
            continue
        others = tuple(
            incidence.edge_site[m] for m, c, d in between if m != k and _same(a, b, c, d)
        )
        ends = (site, incidence.edge_site[k])
        second = cross(axis, a)
        found.append(VertexNormals(0.0, angle, False, ends, vertex.point, a, second, others))
    return found


def _same(a: Array, b: Array, c: Array, d: Array) -> bool:
    """Whether two pairs of normals are the same two."""
    straight = max(float(norm(a - c)), float(norm(b - d)))
    crossed = max(float(norm(a - d)), float(norm(b - c)))
    return min(straight, crossed) <= ANGLE


def reflex_rays(incidence: Incidence) -> list[tuple[int, int, Array]]:
    """(vertex, face, direction) where reentrant edges of a face meet at a reflex angle in it."""
    boundary = incidence.boundary
    found = []
    for number, vertex in enumerate(boundary.vertices):
        if number not in incidence.vertex_site:
            continue
        for face in vertex.faces:
            edges = [
                e
                for e in vertex.edges
                if face in boundary.edges[e].faces
                and boundary.edges[e].convexity is Convexity.REENTRANT
            ]
            sharp = all(_bent(incidence, e, vertex.point) for e in edges)
            if len(edges) == 2 and sharp and _reflex(incidence, number, face, edges):
                found.append((number, face, incidence.inward(face, vertex.point[None])[0]))
    return found


def _bent(incidence: Incidence, edge: int, point: Array) -> bool:
    """Whether an edge's faces have different normals at a point."""
    one, two = (incidence.inward(f, point[None])[0] for f in incidence.boundary.edges[edge].faces)
    return float(norm(one - two)) > ANGLE


def _reflex(incidence: Incidence, vertex: int, face: int, edges: list[int]) -> bool:
    """Whether the face fills more than a half-plane between two of its edges at a vertex."""
    boundary = incidence.boundary
    point = boundary.vertices[vertex].point
    normal = -incidence.inward(face, point[None])[0]
    for loop in boundary.faces[face].loops:
        for (e, sense), (after, after_sense) in zip(loop, (*loop[1:], loop[0]), strict=True):
            ends = boundary.edges[e].vertices
            if {e, after} != set(edges) or ends is None or ends[sense > 0] != vertex:
                continue
            arriving = sense * incidence.tangent(e, point)
            leaving = after_sense * incidence.tangent(after, point)
            # the face is on the left: a turn to the right leaves more than a half-plane
            return float(cross(arriving, leaving) @ normal) < 0
    return False
