"""Where one site takes over from another without a jump of the nearest point: along normals.

A face hands over to its reentrant edge, and to the face behind a smooth edge, on the face's normals
along that edge; a face or an edge hands over to its reentrant vertex, and an edge to another one,
on the normal, or the plane of normals, at the vertex. Whether two such sites meet so at a point,
and not in a sheet, is told by the way from what they share to the point.
"""

from __future__ import annotations

from itertools import combinations

import numpy as np

from decomp.boundary.topology import Convexity
from decomp.sites.site import SiteKind, faces_at
from decomp.skeletons.balls.fields import edge_foot
from decomp.skeletons.balls.queries import RegionQueries
from decomp.skeletons.curves.incidence import Incidence
from decomp.tolerance import TINY
from decomp.vectors import Array, Bools, Ints, cross, dot, nearest_rows, norm

GRADIENT_DELTA = 1e-7
"""Gradients of planes of normals are differences over this part of the size."""
LOOSE, TIGHT = 0.2, 1e-5
"""Radians by which the way to a point may be off the normals: before it is placed, and then."""
BESIDE_SMOOTH = (1e-2, 1e-3, 1e-4, 1e-5)
"""So far beside a smooth edge, in parts of the size, it is asked which face is there."""


class Normals:
    """The normals along which sites of one region take over from each other.

    Args:
        incidence, queries: of the region.
    """

    def __init__(self, incidence: Incidence, queries: RegionQueries) -> None:
        self._it, self._queries = incidence, queries
        self._senses: dict[int, float] = {}
        self._size = incidence.boundary.diagonal
        self._known: dict[tuple[int, int], bool] = {}
        self._smooth: dict[tuple[int, int], tuple[int, ...]] = {}
        for number, edge in enumerate(incidence.boundary.edges):
            if edge.convexity is Convexity.SMOOTH and edge.faces[0] != edge.faces[1]:
                pair = self._pair(*(incidence.face_site[face] for face in edge.faces))
                self._smooth[pair] = (*self._smooth.get(pair, ()), number)

    def takes_over(self, a: int, b: int) -> bool:
        """Whether one of two sites can take over from the other: they share an edge or vertex.

        They can meet in a sheet too, elsewhere.
        """
        pair = self._pair(a, b)
        if pair not in self._known:
            self._known[pair] = self._takes_over(*pair)
        return self._known[pair]

    def smooth(self, a: int, b: int) -> bool:
        """Whether two sites are faces with a smooth edge in common."""
        return self._pair(a, b) in self._smooth

    def on_normal(self, a: int, b: int) -> bool:
        """Whether two sites are as near along one normal at a vertex alone.

        They are a face and a vertex of it, or two edges that end there.
        """
        one, two = self._it.sites[a], self._it.sites[b]
        kinds = {one.kind, two.kind}
        if kinds == {SiteKind.FACE, SiteKind.VERTEX}:
            return self.takes_over(a, b)
        if kinds != {SiteKind.EDGE} or a == b:
            return False
        first, second = (set(self._it.boundary.edges[s.index].vertices or ()) for s in (one, two))
        return bool(first & second)

    def later(self, a: int, b: int) -> int:
        """The one of two sites that takes over from the other: the vertex, or else the edge."""
        order = (SiteKind.FACE, SiteKind.EDGE, SiteKind.VERTEX)
        return max((a, b), key=lambda site: (order.index(self._it.sites[site].kind), site))

    def at_vertex(self, sites: tuple[int, ...], point: Array) -> tuple[int, ...]:
        """Those of some sites around a vertex that hand over along the normal next to a point (3,).

        Of several faces it is the one whose normal leads there, and the edges and vertices of it.
        """
        faces = [s for s in sites if self._it.sites[s].kind is SiteKind.FACE]
        others = [s for s in sites if s not in faces]
        if not faces:
            return sites

        def off(face: int) -> float:
            return max((float(self.slant(face, s, point[None])[0]) for s in own(face)), default=9.0)

        def own(face: int) -> list[int]:
            return [s for s in others if self.takes_over(face, s)]

        best = min(faces, key=off)
        return tuple(sorted({best, *own(best)})) if own(best) else sites

    def slant(self, a: int, b: int, points: Array) -> Array:
        """How far (k,), in radians, the way to points (k, 3) is off the normals of two sites.

        Args:
            a, b: of which one can take over from the other.
            points: (k, 3).
        """
        it = self._it
        one, two = it.sites[a], it.sites[b]
        kinds = {one.kind, two.kind}
        if SiteKind.VERTEX in kinds:
            vertex, other = (one, two) if one.kind is SiteKind.VERTEX else (two, one)
            at = it.boundary.vertices[vertex.index].point
            way = _unit(points - at)
            if other.kind is SiteKind.EDGE:
                return np.abs(way @ it.tangent(other.index, at))
            return norm(way - it.inward(other.index, at[None])[0])
        face = two if one.kind is SiteKind.EDGE else one
        foot = self._shared(a, b, points)[0]
        return norm(_unit(points - foot) - it.inward(face.index, foot))

    def pattern(self, sites: tuple[int, ...], points: Array, within: float = LOOSE) -> Ints:
        """Which pairs of some sites take over from one another at points (k, 3).

        Returns:
            (k,) numbers: bit n is set for the n-th pair of columns.
        """
        found = np.zeros(len(points), dtype=np.int64)
        for bit, (i, j) in enumerate(combinations(range(len(sites)), 2)):
            if self.takes_over(sites[i], sites[j]):
                on = self.slant(sites[i], sites[j], points) <= within
                found |= on.astype(np.int64) << bit
        return found

    def linked(self, sites: tuple[int, ...], point: Array, within: float = LOOSE) -> Bools:
        """Which pairs (m, m) of sites take over from one another at a point (3,)."""
        code = int(self.pattern(sites, point[None], within)[0])
        result = np.zeros((len(sites), len(sites)), dtype=np.bool_)
        for bit, (i, j) in enumerate(combinations(range(len(sites)), 2)):
            result[i, j] = result[j, i] = bool(code >> bit & 1)
        return result

    def off(self, a: int, b: int, points: Array) -> list[tuple[Array, Array]]:
        """How far (k,) points are off the normals at which one site takes over, and gradients.

        One or two such numbers, whose gradients (k, 3) lead to the side of the later site.
        """
        it = self._it
        one, two = it.sites[a], it.sites[b]
        if SiteKind.VERTEX in (one.kind, two.kind):
            vertex, other = (one, two) if one.kind is SiteKind.VERTEX else (two, one)
            at = it.boundary.vertices[vertex.index].point
            if other.kind is SiteKind.EDGE:
                ends = it.boundary.edges[other.index].vertices
                sense = -1.0 if ends is not None and ends[0] == vertex.index else 1.0
                return [_plane(points, at, sense * it.tangent(other.index, at))]
            normal = it.inward(other.index, at[None])[0]
            u = np.eye(3)[int(np.argmin(np.abs(normal)))]
            u = u - (u @ normal) * normal
            u /= norm(u)
            return [_plane(points, at, u), _plane(points, at, cross(normal, u))]

        def value(at: Array) -> Array:
            foot, across = self._shared(a, b, at)
            return np.asarray(dot(at - foot, across))

        h = GRADIENT_DELTA * self._size
        steps = [value(points + h * way) - value(points - h * way) for way in np.eye(3)]
        return [(value(points), np.stack(steps, axis=1) / (2 * h))]

    def onto(self, a: int, b: int, points: Array) -> Array:
        """Points (k, 3) dropped onto the normal at the nearest point of what two sites share."""
        it = self._it
        one, two = it.sites[a], it.sites[b]
        if SiteKind.VERTEX in (one.kind, two.kind):
            placed = np.array(points)
            for value, slope in self.off(a, b, points):
                placed = placed - value[:, None] * slope
            return placed
        foot = self._shared(a, b, points)[0]
        normal = it.inward((two if one.kind is SiteKind.EDGE else one).index, foot)
        return np.asarray(foot + dot(points - foot, normal)[:, None] * normal)

    def _takes_over(self, a: int, b: int) -> bool:
        one, two = sorted((self._it.sites[a], self._it.sites[b]), key=lambda s: s.kind.value)
        if one.kind is two.kind:
            return self.smooth(a, b)
        boundary = self._it.boundary
        if SiteKind.FACE in (one.kind, two.kind):
            face, other = (one, two) if one.kind is SiteKind.FACE else (two, one)
            return face.index in faces_at(boundary, other)
        edge, vertex = (one, two) if one.kind is SiteKind.EDGE else (two, one)
        return vertex.index in (boundary.edges[edge.index].vertices or ())

    def _shared(self, a: int, b: int, points: Array) -> tuple[Array, Array]:
        """Feet (k, 3) on the edge that two sites share, and directions across it along the face.

        These lead to the side of the later site: away from the face, or to the second face.
        """
        it = self._it
        one, two = it.sites[a], it.sites[b]
        if SiteKind.EDGE in (one.kind, two.kind):
            edge, own = (one.index, two) if one.kind is SiteKind.EDGE else (two.index, one)
            foot = self._foot(edge, points)
            faces = it.boundary.edges[edge].faces
            beyond = faces[1] if faces[0] == own.index else faces[0]
            normal, second = it.inward(own.index, foot), it.inward(beyond, foot)
            across = second - dot(second, normal)[:, None] * normal
            return foot, _unit(across)
        edges = self._smooth[self._pair(a, b)]
        foot, away = np.empty((len(points), 3)), np.full(len(points), np.inf)
        across = np.empty((len(points), 3))
        for edge in edges:
            found = self._foot(edge, points)
            gap = norm(points - found)
            rows = np.flatnonzero(gap < away)
            if not len(rows):
                continue
            foot[rows], away[rows] = found[rows], gap[rows]
            curve = it.boundary.edges[edge].curve
            along = _unit(curve.derivative(curve.parameter(found[rows])))
            normal = it.inward(one.index, found[rows])
            across[rows] = self._sense(edge, max(a, b)) * _unit(cross(along, normal))
        return foot, across

    def _sense(self, edge: int, later: int) -> float:
        """Whether the cross product of a smooth edge's tangent and the normal leads to a face."""
        if edge not in self._senses:
            it = self._it
            curve, middle = it.boundary.edges[edge].curve, it.boundary.edges[edge]
            at = curve.point(np.array([(middle.start + middle.end) / 2]))
            normal = it.inward(middle.faces[0], at)
            way = _unit(cross(_unit(curve.derivative(curve.parameter(at))), normal))
            sides = np.array(BESIDE_SMOOTH)[:, None] * self._size
            asked = np.concatenate([at + sides * (normal + s * way) for s in (1.0, -1.0)])
            ahead, behind = np.split(self._queries.nearest(asked).site == later, 2)
            self._senses[edge] = 1.0 if ahead.sum() >= behind.sum() else -1.0
        return self._senses[edge]

    def _foot(self, edge: int, points: Array) -> Array:
        it = self._it.boundary.edges[edge]
        near = it.samples[nearest_rows(it.samples, points)]
        return edge_foot(self._it.boundary, it, points, near)

    @staticmethod
    def _pair(a: int, b: int) -> tuple[int, int]:
        return (a, b) if a < b else (b, a)


def _unit(vectors: Array) -> Array:
    return np.asarray(vectors / np.maximum(norm(vectors), TINY)[..., None])


def _plane(x: Array, at: Array, normal: Array) -> tuple[Array, Array]:
    return (x - at) @ normal, np.repeat(normal[None], len(x), axis=0)
