"""The domain of a reentrant edge: place along the edge, and angle between its faces' normals.

What happens at an edge's end decides how the strip ends. Let the first normal be at angle 0 and the
second at `spread`.

OPEN: balls touch the end in all directions between the normals (a reentrant vertex, say).
PINCHED: balls touch it in none: all directions are one point, where the balls have radius zero.
FLARED: balls touch it in one of the two normals alone. That happens where a face goes more than
    half way round the vertex, as a plate does around the corner of a boss. All other directions are
    one point of radius zero, but in that normal there is a whole segment of the skeleton's closure:
    sheets end there in a rim below the vertex. Close to such an end the strip is drawn in
    k = (angle from that normal) / (way from the end), which tells the points of the rim apart.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

import numpy as np

from decomp.boundary.topology import Edge, RegionBoundary
from decomp.carriers import Carrier
from decomp.complex.footprints.domain_base import Domain
from decomp.complex.footprints.domain_vertices import opening, reaches_into
from decomp.complex.plane.planar import Period
from decomp.vectors import Array, cross, dot, norm

FAN = 7
"""Directions tried at an edge's end to see whether balls touch there."""
AT_END = 1e-6
"""Part of `reach` from an end within which a foot counts as the end."""
DIRECTION_HALVINGS = 60


class EndKind(Enum):
    """In which directions balls touch an edge's end."""

    OPEN = "open"
    PINCHED = "pinched"
    FLARED_FIRST = "flared at the first normal"
    FLARED_SECOND = "flared at the second normal"


@dataclass(frozen=True)
class End:
    """An end of the strip.

    Args:
        kind: how it ends.
        slope: at a flared end the distance from the edge of a point halfway between this edge and
            the next one of the face, by its distance along the edge from the vertex.
    """

    kind: EndKind
    slope: float = 1.0


@dataclass(frozen=True, eq=False)
class EdgeDomain(Domain):
    """(way along the edge, reach * (angle, compressed towards the ends as they ask for)).

    Angles are measured about the edge's tangent from the inward normal of the first face towards
    that of the second; v grows with them at every place of the edge.

    Args:
        edge: reentrant.
        first, second: the carriers and the signs of the inward normals of its faces.
        reach: radius at which angles are drawn.
        ends: of the strip, at the edge's start and end.
    """

    edge: Edge
    first: tuple[Carrier, float]
    second: tuple[Carrier, float]
    reach: float
    ends: tuple[End, End]

    @property
    def period(self) -> Period:
        return (self.edge.length if self.edge.closed else None), None

    def to_plane(self, feet: Array, toward: Array) -> Array:
        t = self._within(self.edge.curve.parameter(feet))
        normal, side, spread = self.frames(t)
        away = toward - feet
        x, y = dot(away, normal), dot(away, side)
        none = (x == 0) & (y == 0)
        angle = np.where(none, spread / 2, np.clip(np.arctan2(y, x), 0.0, spread))
        along = (t - self.edge.start) * self._speed
        return np.stack([along, self._height(along, angle, spread, norm(away))], axis=-1)

    def lift(self, uv: Array) -> tuple[Array, Array]:
        along = uv[..., 0]
        along = np.mod(along, self.edge.length) if self.edge.closed else along
        along = np.clip(along, 0.0, self.edge.length)
        t = self.edge.start + along / self._speed
        normal, side, spread = self.frames(t)
        low, high = np.zeros_like(spread), spread
        for _ in range(DIRECTION_HALVINGS):
            middle = (low + high) / 2
            below = self._height(along, middle, spread, None) < uv[..., 1]
            low, high = np.where(below, middle, low), np.where(below, high, middle)
        angle = ((low + high) / 2)[..., None]
        feet = self.edge.curve.point(self.edge.curve.wrapped(t))
        return feet, np.asarray(np.cos(angle) * normal + np.sin(angle) * side)

    def frames(self, t: Array) -> tuple[Array, Array, Array]:
        """First normals (k, 3), the directions (k, 3) a quarter turn on, and the spread (k,)."""
        curve = self.edge.curve
        t = curve.wrapped(t)
        points, tangent = curve.point(t), curve.derivative(t)
        tangent = tangent / norm(tangent)[..., None]
        normal, other = (sign * c.normal(points) for c, sign in (self.first, self.second))
        normal = normal - dot(normal, tangent)[..., None] * tangent
        normal = normal / norm(normal)[..., None]
        side = cross(tangent, normal)
        return normal, side, np.maximum(np.arctan2(dot(other, side), dot(other, normal)), 0.0)

    @property
    def _speed(self) -> float:
        """Mean length per parameter."""
        return self.edge.length / (self.edge.end - self.edge.start)

    def _height(self, along: Array, angle: Array, spread: Array, radius: Array | None) -> Array:
        """v (k,); radii (k,) tell points above a flared end itself apart."""
        length = self.edge.length
        gaps = (along, length - along)
        heights = [
            self._compressed(end, gap, angle, spread, radius)
            for end, gap in zip(self.ends, gaps, strict=True)
        ]
        share = along / length
        height = (1 - share) * heights[0] + share * heights[1] - spread / 2
        span = min(length / 2, 2 * self.reach)
        for end, gap in zip(self.ends, gaps, strict=True):
            if end.kind is EndKind.PINCHED:
                height = height * (1 - (1 - np.clip(gap / span, 0.0, 1.0)) ** 2)
        return np.asarray(self.reach * height)

    def _compressed(
        self, end: End, gap: Array, angle: Array, spread: Array, radius: Array | None
    ) -> Array:
        """Angles (k,) as drawn for the sake of one end, at distances (k,) from it."""
        if end.kind in (EndKind.OPEN, EndKind.PINCHED):
            return angle
        first = end.kind is EndKind.FLARED_FIRST
        off = angle if first else spread - angle
        # one over k: infinite on the normal, 0 for all other directions at the end itself
        width = self.reach * -np.expm1(-gap / self.reach)
        with np.errstate(divide="ignore", invalid="ignore"):
            inverse = width / (2 * self.reach * np.tan(off / 2))
        if radius is not None:
            at_end = gap <= AT_END * self.reach
            inverse = np.where(at_end, radius / (self.reach * end.slope), inverse)
        else:
            inverse = np.where(off == 0, np.inf, inverse)
        drawn = 1 / (1 + inverse)
        return np.asarray(drawn if first else spread - drawn)

    def _within(self, t: Array) -> Array:
        """Parameters brought between start and end, whichever is nearer."""
        start, end, curve = self.edge.start, self.edge.end, self.edge.curve
        if not curve.closed:
            return np.clip(t, start, end)
        t = start + np.mod(t - start, curve.period)
        return np.where(t <= end, t, np.where(t - end < start + curve.period - t, end, start))


@dataclass(frozen=True, eq=False)
class EvenStrip(Domain):
    """The domain of an edge drawn equally high all along, so that its borders are straight.

    Args:
        strip: the same, as high as the spread is wide; its ends are open if it has any.
        height: of this one.
    """

    strip: EdgeDomain
    height: float

    @property
    def period(self) -> Period:
        return self.strip.period

    def to_plane(self, feet: Array, toward: Array) -> Array:
        uv = self.strip.to_plane(feet, toward)
        return np.stack([uv[..., 0], uv[..., 1] / self._stretch(uv[..., 0])], axis=-1)

    def lift(self, uv: Array) -> tuple[Array, Array]:
        high = uv[..., 1] * self._stretch(uv[..., 0])
        return self.strip.lift(np.stack([uv[..., 0], high], axis=-1))

    def _stretch(self, along: Array) -> Array:
        edge = self.strip.edge
        part = along / edge.length
        part = np.mod(part, 1.0) if edge.closed else np.clip(part, 0.0, 1.0)
        spread = self.strip.frames(edge.start + part * (edge.end - edge.start))[2]
        return np.asarray(self.strip.reach * spread / self.height)


def even_strip(boundary: RegionBoundary, index: int, reach: float) -> Domain:
    """The domain of a reentrant edge with straight borders, if balls touch its ends in all ways.

    Args:
        boundary: of the region.
        index: of the edge.
        reach: radius at which angles are drawn.
    """
    strip = edge_domain(boundary, index, reach)
    edge = strip.edge
    if any(end.kind is not EndKind.OPEN for end in strip.ends):
        return strip
    spread = strip.frames(edge.start + (edge.end - edge.start) * (np.arange(64) + 0.5) / 64)[2]
    return EvenStrip(strip, reach * float(spread.mean()))


def edge_domain(boundary: RegionBoundary, index: int, reach: float) -> EdgeDomain:
    """The domain of a reentrant edge of a region.

    Args:
        boundary: of the region.
        index: of the edge.
        reach: radius at which angles are drawn.
    """
    edge = boundary.edges[index]
    faces = list(edge.faces)
    flanks = [
        (boundary.carriers[boundary.faces[f].carrier], -float(boundary.faces[f].outward))
        for f in faces
    ]
    middle = edge.curve.wrapped(np.array([(edge.start + edge.end) / 2]))
    point, tangent = edge.curve.point(middle), edge.curve.derivative(middle)
    a, b = (sign * carrier.normal(point) for carrier, sign in flanks)
    if float(dot(cross(a, b), tangent)[0]) < 0:
        flanks.reverse()
        faces.reverse()
    domain = EdgeDomain(edge, flanks[0], flanks[1], reach, (End(EndKind.OPEN), End(EndKind.OPEN)))
    if edge.vertices is None:
        return domain
    places = zip(edge.vertices, (edge.start, edge.end), strict=True)
    first, last = (_end(boundary, v, index, domain, t, faces) for v, t in places)
    return EdgeDomain(edge, flanks[0], flanks[1], reach, (first, last))


def _end(
    boundary: RegionBoundary,
    vertex: int,
    index: int,
    domain: EdgeDomain,
    t: float,
    faces: list[int],
) -> End:
    """How the strip ends at a vertex: where balls of positive radius touch it."""
    normal, side, spread = domain.frames(np.array([t]))
    angle = spread * np.array([0.0, *np.linspace(0.1, 0.9, FAN), 1.0])[:, None]
    touched = reaches_into(boundary, vertex, np.cos(angle) * normal + np.sin(angle) * side)
    if touched[1:-1].any():
        return End(EndKind.OPEN)
    for kind, hit, face in (
        (EndKind.FLARED_FIRST, touched[0], faces[0]),
        (EndKind.FLARED_SECOND, touched[-1], faces[1]),
    ):
        if hit:
            return End(kind, float(np.tan(opening(boundary, vertex, face, index) / 2)))
    return End(EndKind.PINCHED)
