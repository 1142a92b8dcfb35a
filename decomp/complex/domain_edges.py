"""The domain of a reentrant edge: place along the edge, and angle between its faces' normals."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from decomp.boundary.topology import Edge, RegionBoundary
from decomp.carriers import Carrier
from decomp.complex.domain_base import Domain
from decomp.complex.domain_vertices import reaches_into
from decomp.complex.planar import Period
from decomp.vectors import Array, cross, dot, norm

FAN = 7
"""Directions tried at an edge's end to see whether balls touch there."""


@dataclass(frozen=True, eq=False)
class EdgeDomain(Domain):
    """(way along the edge, reach * width * (angle - middle)).

    Angles are measured about the edge's tangent from the inward normal of the first face towards
    that of the second; their middle is at v = 0. Where no ball touches the edge's end the width
    shrinks to zero, as all directions are one point there.

    Args:
        edge: reentrant.
        first, second: the carriers and the signs of the inward normals of its faces.
        reach: radius at which angles are drawn.
        pinched: whether the strip ends in a point at its start and its end.
    """

    edge: Edge
    first: tuple[Carrier, float]
    second: tuple[Carrier, float]
    reach: float
    pinched: tuple[bool, bool]

    @property
    def period(self) -> Period:
        return (self.edge.length if self.edge.closed else None), None

    def to_plane(self, feet: Array, toward: Array) -> Array:
        t = self._within(self.edge.curve.parameter(feet))
        normal, side, spread = self._frames(t)
        away = toward - feet
        x, y = dot(away, normal), dot(away, side)
        none = (x == 0) & (y == 0)
        angle = np.where(none, spread / 2, np.clip(np.arctan2(y, x), 0.0, spread))
        along = (t - self.edge.start) * self._speed
        return np.stack([along, self.reach * self._width(along) * (angle - spread / 2)], axis=-1)

    def lift(self, uv: Array) -> tuple[Array, Array]:
        along = uv[..., 0]
        along = np.mod(along, self.edge.length) if self.edge.closed else along
        t = np.clip(self.edge.start + along / self._speed, self.edge.start, self.edge.end)
        normal, side, spread = self._frames(t)
        width = self.reach * self._width(along)
        off = np.where(width > 0, uv[..., 1] / np.where(width > 0, width, 1.0), 0.0)
        angle = np.clip(spread / 2 + off, 0.0, spread)[..., None]
        feet = self.edge.curve.point(self.edge.curve.wrapped(t))
        return feet, np.asarray(np.cos(angle) * normal + np.sin(angle) * side)

    @property
    def _speed(self) -> float:
        """Mean length per parameter."""
        return self.edge.length / (self.edge.end - self.edge.start)

    def _width(self, along: Array) -> Array:
        """1 away from pinched ends, 0 at them."""
        span = min(self.edge.length / 2, 2 * self.reach)
        result = np.ones(np.shape(along))
        for pinched, gap in zip(self.pinched, (along, self.edge.length - along), strict=True):
            if pinched:
                result = result * (1 - (1 - np.clip(gap / span, 0.0, 1.0)) ** 2)
        return result

    def _within(self, t: Array) -> Array:
        """Parameters brought between start and end, whichever is nearer."""
        start, end, curve = self.edge.start, self.edge.end, self.edge.curve
        if not curve.closed:
            return np.clip(t, start, end)
        t = start + np.mod(t - start, curve.period)
        return np.where(t <= end, t, np.where(t - end < start + curve.period - t, end, start))

    def _frames(self, t: Array) -> tuple[Array, Array, Array]:
        """First normal (k, 3), the direction (k, 3) a quarter turn on, and the spread (k,)."""
        curve = self.edge.curve
        t = curve.wrapped(t)
        points, tangent = curve.point(t), curve.derivative(t)
        tangent = tangent / norm(tangent)[..., None]
        normal, other = (sign * c.normal(points) for c, sign in (self.first, self.second))
        normal = normal - dot(normal, tangent)[..., None] * tangent
        normal = normal / norm(normal)[..., None]
        side = cross(tangent, normal)
        return normal, side, np.maximum(np.arctan2(dot(other, side), dot(other, normal)), 0.0)


def edge_domain(boundary: RegionBoundary, index: int, reach: float) -> EdgeDomain:
    """The domain of a reentrant edge of a region.

    Args:
        boundary: of the region.
        index: of the edge.
        reach: radius at which angles are drawn.
    """
    edge = boundary.edges[index]
    flanks = [
        (boundary.carriers[boundary.faces[f].carrier], -float(boundary.faces[f].outward))
        for f in edge.faces
    ]
    middle = edge.curve.wrapped(np.array([(edge.start + edge.end) / 2]))
    point, tangent = edge.curve.point(middle), edge.curve.derivative(middle)
    a, b = (sign * carrier.normal(point) for carrier, sign in flanks)
    if float(dot(cross(a, b), tangent)[0]) < 0:
        flanks.reverse()
    domain = EdgeDomain(edge, flanks[0], flanks[1], reach, (False, False))
    if edge.vertices is None:
        return domain
    ends = zip(edge.vertices, (edge.start, edge.end), strict=True)
    pinched = [not _touched(boundary, v, domain, t) for v, t in ends]
    return EdgeDomain(edge, flanks[0], flanks[1], reach, (pinched[0], pinched[1]))


def _touched(boundary: RegionBoundary, vertex: int, domain: EdgeDomain, t: float) -> bool:
    """Whether a ball of positive radius touches the end of an edge from between its normals."""
    normal, side, spread = domain._frames(np.array([t]))
    angle = spread * np.linspace(0.1, 0.9, FAN)[:, None]
    fan = np.cos(angle) * normal + np.sin(angle) * side
    return bool(reaches_into(boundary, vertex, fan).any())
