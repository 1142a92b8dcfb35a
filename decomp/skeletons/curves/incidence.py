"""Which sites share a contact: the sites at a boundary point whose normals hold a direction.

A maximal ball about p touches the boundary at a foot q; seen from q its centre lies in the unit
direction d. A face is touched at q if d is its inward normal there, a reentrant edge if d is at
right angles to it and between the normals of its two faces, a reentrant vertex if q is the vertex.
On an edge or at a vertex several sites can hold the same direction: there one takes over from
another without a jump of the foot (a trim).
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property

import numpy as np

from decomp.boundary.topology import Convexity, Edge
from decomp.sites.site import SiteKind
from decomp.skeletons.balls.fields import edge_foot, site_fields
from decomp.skeletons.balls.region_context import RegionContext
from decomp.skeletons.balls.supports import SEARCHED
from decomp.skeletons.curves.edge_wells import EdgeWells
from decomp.skeletons.curves.legs import legs
from decomp.tolerance import CONVERGED, TINY
from decomp.vectors import Array, Bools, Ints, cross, dot, nearest_rows, norm

NEAR = 1e-8
"""Feet nearer to an edge or vertex than this part of the region's diagonal are on it."""
ANGLE = 1e-6
"""Directions that differ by less than this count as equal."""


class Incidence:
    """Edges, vertices and faces of one region by the sites that they are.

    Args:
        context: of the region.
    """

    def __init__(self, context: RegionContext) -> None:
        self.context = context
        self.boundary, self.sites, self.region = context.boundary, context.sites, context.region
        self._size = context.size
        self.face_site: dict[int, int] = {}
        self.edge_site: dict[int, int] = {}
        self.vertex_site: dict[int, int] = {}
        tables = {
            SiteKind.FACE: self.face_site,
            SiteKind.EDGE: self.edge_site,
            SiteKind.VERTEX: self.vertex_site,
        }
        for number, site in enumerate(context.sites):
            if site.region == context.region:
                tables[site.kind][site.index] = number

    @cached_property
    def edges_of_face(self) -> dict[int, list[int]]:
        """The edges of each face."""
        found: dict[int, list[int]] = {k: [] for k in range(len(self.boundary.faces))}
        for number, edge in enumerate(self.boundary.edges):
            for face in set(edge.faces):
                found[face].append(number)
        return found

    @cached_property
    def reentrant_carriers(self) -> dict[int, list[int]]:
        """The other carriers of each face's reentrant edges."""
        found: dict[int, set[int]] = {k: set() for k in range(len(self.boundary.faces))}
        for edge in self.boundary.edges:
            if edge.convexity is Convexity.REENTRANT:
                for face in edge.faces:
                    found[face] |= {*edge.carriers} - {self.boundary.faces[face].carrier}
        return {face: sorted(carriers) for face, carriers in found.items()}

    def inward(self, face: int, points: Array) -> Array:
        """Inward unit normals (k, 3) of a face at points (k, 3) on it."""
        it = self.boundary.faces[face]
        normal = self.boundary.carriers[it.carrier].normal(points)
        return np.asarray(-it.outward * normal)

    def tangent(self, edge: int, point: Array) -> Array:
        """Unit tangent (3,) of an edge at a point on it, in the sense of its parameter."""
        curve = self.boundary.edges[edge].curve
        along = curve.derivative(curve.parameter(point))
        return np.asarray(along / norm(along))

    def feet(self, sites: Sequence[int], points: Array) -> Array:
        """Feet (k, m, 3) of points (k, 3) on m sites each; on edges, near their nearest chords.

        Of several legs of a curved edge that are about as near the nearest one counts. Where a
        chord leads past an edge's end the foot is near the nearest of its other samples that are
        nearer than their neighbours. An edge that stands twice among the sites has two feet, unless
        they have run together.
        """
        found = np.empty((len(points), len(sites), 3))
        for column, site in enumerate(sites):
            before = [k for k in range(column) if sites[k] == site]
            if before:
                found[:, [*before, column]] = self._several(site, points, len(before) + 1)
                continue
            it = self.sites[site]
            guess = points
            if it.kind is SiteKind.EDGE:
                samples = self.boundary.edges[it.index].samples
                guess = _on_chords(samples, points)
            found[:, column] = self._feet(site, points, guess)
            if it.kind is SiteKind.EDGE and not self.boundary.edges[it.index].closed:
                past = np.flatnonzero(_past_ends(samples, found[:, column], NEAR * self._size))
                inner, known = _inner_guess(samples, points[past])
                found[past[known], column] = self._feet(site, points[past[known]], inner[known])
            if self.context.table.kinds[site] in SEARCHED:
                self._to_nearest_leg(site, points, found[:, column])
        return found

    def _to_nearest_leg(self, site: int, points: Array, feet: Array) -> None:
        """Replace those of feet (k, 3) on a curved edge that others of its places are nearer than.

        Where an edge keeps its distance over a long way Newton's method leaves the place; a foot
        that is farther away than a sample is none.
        """
        edge = self.boundary.edges[self.sites[site].index]
        slack = CONVERGED * self._size
        rows, legs_of = legs(edge.samples, edge.closed, points)
        tried = self._feet(site, points[rows], edge.samples[legs_of])
        if not edge.closed:
            kept = ~_past_ends(edge.samples, tried, NEAR * self._size)
            rows, tried = rows[kept], tried[kept]
        _keep_nearest(points, feet, rows, tried, slack)
        nearest = norm(edge.samples[nearest_rows(edge.samples, points)] - points)
        lost = np.flatnonzero(~(norm(feet - points) <= nearest + slack))
        if len(lost):
            rows, tried = EdgeWells(edge).near(points[lost])
            _keep_nearest(points, feet, lost[rows], tried, slack)

    def _feet(self, site: int, points: Array, guess: Array) -> Array:
        which = np.full(len(points), site, dtype=np.int64)
        return site_fields(self.context, which, points, guess).foot

    def _several(self, site: int, points: Array, count: int) -> Array:
        """The nearest feet (k, count, 3) of points (k, 3) on an edge, from all its samples."""
        samples = self.boundary.edges[self.sites[site].index].samples
        found = np.empty((len(points), count, 3))
        which = np.full(len(samples), site, dtype=np.int64)
        for row, point in enumerate(points):
            at = np.repeat(point[None], len(samples), axis=0)
            field = site_fields(self.context, which, at, samples)
            order = np.argsort(field.distance, kind="stable")
            feet: list[Array] = []
            for foot in field.foot[order]:
                if all(float(norm(foot - other)) > NEAR * self._size for other in feet):
                    feet.append(foot)
            found[row] = (feet * count)[:count] if len(feet) < count else feet[:count]
        return found

    def touched(self, site: int, foot: Array, direction: Array) -> tuple[int, ...]:
        """All sites (in order) that are touched at a foot of `site` from a direction, both (3,)."""
        found = {site}
        vertices, edges = self._around(site, foot)
        for number in vertices:
            if number in self.vertex_site:
                found.add(self.vertex_site[number])
        faces = {f for e in edges for f in self.boundary.edges[e].faces}
        faces |= {f for v in vertices for f in self.boundary.vertices[v].faces}
        for face in faces:
            if float(norm(self.inward(face, foot[None])[0] - direction)) <= ANGLE:
                found.add(self.face_site[face])
        for number in edges:
            if number in self.edge_site and self.in_wedge(number, foot, direction):
                found.add(self.edge_site[number])
        return tuple(sorted(found))

    def in_wedge(self, edge: int, foot: Array, direction: Array) -> bool:
        """Whether a direction lies between the normals of a reentrant edge's faces."""
        tangent = self.tangent(edge, foot)
        if abs(float(tangent @ direction)) > ANGLE:
            return False
        a, b = (self.inward(f, foot[None])[0] for f in self.boundary.edges[edge].faces)
        turn = float(cross(a, b) @ tangent)
        sign = 1.0 if turn > 0 else -1.0
        return (
            sign * float(cross(a, direction) @ tangent) >= -ANGLE
            and sign * float(cross(direction, b) @ tangent) >= -ANGLE
            and float(direction @ (a + b)) > 0
        )

    def _around(self, site: int, foot: Array) -> tuple[list[int], list[int]]:
        """The vertices at a foot, and the reentrant or smooth edges through it."""
        it = self.sites[site]
        match it.kind:
            case SiteKind.FACE:
                near = self.edges_of_face[it.index]
            case SiteKind.EDGE:
                near = [it.index]
            case SiteKind.VERTEX:
                near = list(self.boundary.vertices[it.index].edges)
        near = self._about(near, foot)
        bends = [e for e in near if self.boundary.edges[e].convexity is not Convexity.CONVEX]
        edges = {e for e in bends if self._on(self.boundary.edges[e], foot)}
        corners = {v for e in near for v in self.boundary.edges[e].vertices or ()}
        if it.kind is SiteKind.VERTEX:
            corners.add(it.index)
        vertices = [v for v in sorted(corners) if self._at(v, foot)]
        for vertex in vertices:
            edges |= {
                e
                for e in self.boundary.vertices[vertex].edges
                if self.boundary.edges[e].convexity is not Convexity.CONVEX
            }
        return vertices, sorted(edges)

    def _about(self, edges: list[int], point: Array) -> list[int]:
        """Those of some edges whose boxes hold a point."""
        some = np.array(edges, dtype=np.int64)
        boxes = self._boxes[some]
        held = (point >= boxes[:, 0]) & (point <= boxes[:, 1])
        return [int(k) for k in some[held.all(axis=1)]]

    @cached_property
    def _boxes(self) -> Array:
        """Boxes (n, 2, 3) that hold the edges."""
        found = np.empty((len(self.boundary.edges), 2, 3))
        for box, edge in zip(found, self.boundary.edges, strict=True):
            # a chord's length is room enough for the arc above it
            room = norm(np.diff(edge.samples, axis=0)).max(initial=0.0) + NEAR * self._size
            box[0], box[1] = edge.samples.min(axis=0) - room, edge.samples.max(axis=0) + room
        return found

    def _at(self, vertex: int, point: Array) -> bool:
        gap = float(norm(self.boundary.vertices[vertex].point - point))
        return gap <= NEAR * self._size

    def _on(self, edge: Edge, point: Array) -> bool:
        """Whether a point on one of an edge's faces is on the edge."""
        slack = NEAR * self._size
        carriers = [self.boundary.carriers[k] for k in edge.carriers]
        if max(abs(float(c.signed_distance(point))) for c in carriers) > slack:
            # on a smooth edge the carriers stay close beside it, so only a far one tells
            return False
        near = edge.samples[int(np.argmin(norm(edge.samples - point)))]
        foot = edge_foot(self.boundary, edge, point[None], near[None])[0]
        return float(norm(foot - point)) <= slack and edge.beyond(foot) <= slack


def angle_between(a: Array, b: Array, axis: Array) -> Array:
    """Angle (...) from a to b about unit `axis`, in (-pi, pi]."""
    return np.arctan2(dot(cross(a, b), axis), dot(a, b))


def _keep_nearest(points: Array, feet: Array, rows: Ints, tried: Array, slack: float) -> None:
    """Replace feet (k, 3) of points by those tried for points (m,) that are nearer by a slack."""
    away = norm(tried - points[rows])
    for k in np.argsort(-away, kind="stable"):
        row = rows[k]
        if not away[k] >= float(norm(feet[row] - points[row])) - slack:
            feet[row] = tried[k]


def _past_ends(samples: Array, feet: Array, slack: float) -> Bools:
    """Which feet (k, 3) on an edge's curve are beyond the ends of its samples (n, 3)."""
    result = np.zeros(len(feet), dtype=np.bool_)
    nearest = nearest_rows(samples, feet)
    for end, before in ((0, 1), (len(samples) - 1, len(samples) - 2)):
        way = samples[end] - samples[before]
        result |= (nearest == end) & ((feet - samples[end]) @ way > slack * float(norm(way)))
    return result


def _on_chords(samples: Array, points: Array) -> Array:
    """The points (k, 3) next to points (k, 3) on the two chords at their nearest samples (n, 3).

    From a sample itself no foot is found where it is an end at which carriers touch.
    """
    at = nearest_rows(samples, points)
    result, least = samples[at], np.full(len(points), np.inf)
    for first in (np.maximum(at - 1, 0), np.minimum(at, len(samples) - 2)):
        start, way = samples[first], samples[first + 1] - samples[first]
        along = dot(points - start, way) / np.maximum(dot(way, way), TINY)
        near = start + np.clip(along, 0.0, 1.0)[:, None] * way
        gap = norm(points - near)
        result, least = np.where((gap < least)[:, None], near, result), np.minimum(gap, least)
    return result


def _inner_guess(samples: Array, points: Array) -> tuple[Array, Bools]:
    """The nearest of the samples (n, 3) that are nearer to points (k, 3) than both neighbours.

    Returns:
        these (k, 3), and whether there is one (k,).
    """
    if len(samples) < 3:
        return points, np.zeros(len(points), dtype=np.bool_)
    gaps = norm(points[:, None] - samples[None])
    inner = (gaps[:, 1:-1] <= gaps[:, :-2]) & (gaps[:, 1:-1] <= gaps[:, 2:])
    best = np.where(inner, gaps[:, 1:-1], np.inf).argmin(axis=1)
    return samples[1:-1][best], np.asarray(inner.any(axis=1))
