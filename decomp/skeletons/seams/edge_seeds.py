"""Points on seams, found from the footprints of reentrant edges and vertices.

A ball that touches a reentrant edge is known by the place t along the edge and the direction of its
centre, between the inward normals of the edge's two faces; one that touches a reentrant vertex by
the direction alone. Where its far foot jumps between two such balls, a seam passes. From the faces'
footprints, see `seeds`, seams are not seen whose feet are all on edges, such as those at which an
edge has three feet, nor from the edges' those whose feet are all vertices, as in a cross of rods.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree  # type: ignore[import-untyped]

from decomp.boundary.topology import Convexity, Edge, RegionBoundary, Vertex
from decomp.curves.circle import Circle
from decomp.curves.line import Line
from decomp.skeletons.balls.balls import Balls, balls_at
from decomp.skeletons.balls.queries import RegionQueries
from decomp.skeletons.balls.shrinking import OSCULATES, TOUCHES
from decomp.vectors import Array, Bools, Ints, cross, dot, norm

ALONG, ACROSS = 60, 15
"""Balls along and across an edge's footprint for every `PER` samples of the boundary."""
PLAIN = 0.4
"""So many times as many both ways where the edge is straight or an arc of a circle."""
VERTEX_BALLS = 150
NEIGHBOURS = 5
"""Balls in a vertex' fan for every `PER` samples, and with how many others each is compared."""
PER = 2000
BISECTIONS = 24
STEADY = 4.0
"""A far foot that moves by no more than this multiple of the ball's own way has not jumped."""
JUMP = 50.0


@dataclass(frozen=True, eq=False)
class EdgeFan:
    """The balls that touch an edge, by their coordinates.

    Args:
        boundary: of the region.
        edge: reentrant.
    """

    boundary: RegionBoundary
    edge: Edge

    def place(self, spots: Array) -> tuple[Array, Array]:
        """Feet and directions (k, 3) at spots (k, 2): parts of the edge, and of the angle."""
        edge, curve = self.edge, self.edge.curve
        t = curve.wrapped(edge.start + spots[:, 0] * (edge.end - edge.start))
        feet, along = curve.point(t), curve.derivative(t)
        along = along / norm(along)[:, None]
        one, other = (self._inward(number, feet) for number in edge.faces)
        side = cross(along, one)
        angle = spots[:, 1] * np.arctan2(dot(other, side), dot(other, one))
        return feet, np.cos(angle)[:, None] * one + np.sin(angle)[:, None] * side

    def grid(self, samples: int, rng: np.random.Generator) -> tuple[Array, Ints, Ints]:
        """Spots (k, 2) all over the footprint, and which (m,), (m,) of them are neighbours."""
        finer = np.sqrt(samples / PER)
        if isinstance(self.edge.curve, (Line, Circle)):
            finer *= PLAIN
        shape = (max(4, int(ALONG * finer)), max(3, int(ACROSS * finer)))
        cells = np.stack(np.meshgrid(*map(np.arange, shape), indexing="ij"), axis=-1)
        spots = ((cells + 0.2 + 0.6 * rng.random(cells.shape)) / shape).reshape(-1, 2)
        number = np.arange(len(spots)).reshape(shape)
        pairs = [(number[:-1], number[1:]), (number[:, :-1], number[:, 1:])]
        one = np.concatenate([a.ravel() for a, _ in pairs])
        return spots, one, np.concatenate([b.ravel() for _, b in pairs])

    def _inward(self, number: int, points: Array) -> Array:
        return _inward(self.boundary, number, points)


@dataclass(frozen=True, eq=False)
class VertexFan:
    """The balls that touch a vertex, by the weights of its faces' normals in their direction.

    Args:
        boundary: of the region.
        vertex: reentrant.
    """

    boundary: RegionBoundary
    vertex: Vertex

    def place(self, spots: Array) -> tuple[Array, Array]:
        """Feet, all the vertex, and directions (k, 3) at spots (k, m): weights of m normals."""
        point = self.vertex.point
        ways = spots @ np.array([_inward(self.boundary, f, point) for f in self.vertex.faces])
        length = norm(ways)[:, None]
        return np.repeat(point[None], len(spots), axis=0), ways / np.where(length == 0, 1, length)

    def grid(self, samples: int, rng: np.random.Generator) -> tuple[Array, Ints, Ints]:
        """Spots (k, m) all over the fan, and which (n,), (n,) of them are neighbours."""
        count = max(VERTEX_BALLS // 5, VERTEX_BALLS * samples // PER)
        spots = rng.dirichlet(np.ones(len(self.vertex.faces)), count)
        _, ways = self.place(spots)
        _, near = cKDTree(ways).query(ways, NEIGHBOURS)
        return spots, np.repeat(np.arange(count), NEIGHBOURS - 1), near[:, 1:].ravel()


def _inward(boundary: RegionBoundary, number: int, points: Array) -> Array:
    """A face's unit normals into the region at points (k, 3) or (3,)."""
    face = boundary.faces[number]
    return np.asarray(-face.outward * boundary.carriers[face.carrier].normal(points))


def edge_jumps(
    boundary: RegionBoundary, queries: RegionQueries, samples: int, rng: np.random.Generator
) -> tuple[Array, Array]:
    """Points (k, 3) close to seams and three of their feet (k, 3, 3), as seen from reentrant edges
    and vertices.

    Args:
        boundary: of the region.
        queries: in it.
        samples: the more, the finer the footprints are searched.
        rng: random numbers that place the balls.
    """
    fans: list[EdgeFan | VertexFan] = []
    for edge in boundary.edges:
        if edge.convexity is Convexity.REENTRANT:
            fans.append(EdgeFan(boundary, edge))
    for vertex in boundary.vertices:
        if vertex.convexity is Convexity.REENTRANT and len(vertex.faces) > 2:
            fans.append(VertexFan(boundary, vertex))
    points, feet = [np.empty((0, 3))], [np.empty((0, 3, 3))]
    for fan in fans:
        found = _jumps(fan, queries, samples, rng)
        points.append(found[0])
        feet.append(found[1])
    return np.concatenate(points), np.concatenate(feet)


def _jumps(
    fan: EdgeFan | VertexFan, queries: RegionQueries, samples: int, rng: np.random.Generator
) -> tuple[Array, Array]:
    """The same for one edge or vertex: neighbours are brought together where the far foot jumps."""

    def balls(spots: Array) -> tuple[Balls, Array]:
        feet, ways = fan.place(spots)
        found, state = balls_at(queries, feet, ways, queries.size)
        found.site[(state != TOUCHES) & (state != OSCULATES)] = -2
        return found, feet

    spots, one, other = fan.grid(samples, rng)
    every, at = balls(spots)
    first, second = spots[one], spots[other]
    low, high = (_rows(every, at, rows) for rows in (one, other))
    keep = _differ(low, high)
    for _ in range(BISECTIONS):
        first, second = first[keep], second[keep]
        low, high = (_rows(*side, keep) for side in (low, high))
        if not len(first):
            return np.empty((0, 3)), np.empty((0, 3, 3))
        middle = (first + second) / 2
        new, near = balls(middle)
        upper = norm(new.foot - low[0].foot) <= norm(new.foot - high[0].foot)
        first = np.where(upper[:, None], middle, first)
        second = np.where(upper[:, None], second, middle)
        low, high = _chosen(upper, (new, near), low), _chosen(upper, high, (new, near))
        keep = _differ(low, high)
    low, high = _rows(*low, keep), _rows(*high, keep)
    gap = norm(low[0].foot - high[0].foot)
    good = gap > JUMP * _way(low, high)
    feet = np.stack([low[1], low[0].foot, high[0].foot], axis=1)[good]
    return low[0].centre[good], feet


_Side = tuple[Balls, Array]
"""Balls and their near feet (k, 3)."""


def _way(low: _Side, high: _Side) -> Array:
    return np.asarray(norm(low[1] - high[1]) + norm(low[0].centre - high[0].centre))


def _differ(low: _Side, high: _Side) -> Bools:
    """Whether the far foot moves farther than the balls' own ways explain."""
    known = (low[0].site > -2) & (high[0].site > -2)
    return np.asarray(known & (norm(low[0].foot - high[0].foot) > STEADY * _way(low, high)))


def _rows(balls: Balls, near: Array, which: Ints | Bools) -> _Side:
    chosen = Balls(balls.centre[which], balls.radius[which], balls.site[which], balls.foot[which])
    return chosen, near[which]


def _chosen(first: Bools, a: _Side, b: _Side) -> _Side:
    one, other = a[0], b[0]
    balls = Balls(
        np.where(first[:, None], one.centre, other.centre),
        np.where(first, one.radius, other.radius),
        np.where(first, one.site, other.site),
        np.where(first[:, None], one.foot, other.foot),
    )
    return balls, np.where(first[:, None], a[1], b[1])
