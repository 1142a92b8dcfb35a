"""The domain of a vertex: the directions in which balls that touch it have their centres."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from decomp.boundary.topology import Edge, RegionBoundary
from decomp.complex.footprints.domain_base import AT_APEX, Domain
from decomp.errors import GeometryError
from decomp.vectors import Array, Bools, cross, dot, frame, norm

SECTOR_DIRECTIONS = 6
"""Directions by which the corner of a face is represented."""
NORMAL_SLOPE = 1e-6
"""A direction that makes an angle this little below 90 degrees with a surface is normal to it."""
WIDE_COSINE = 0.2
"""Cosine of the angle from the middle direction up to which straight pictures are drawn."""
NO_MIDDLE = 1e-6
"""Length of the sum of normals below which it has no direction."""
BESIDE_VERTEX = 1e-4
"""An apex has no normal: it is taken this part of an edge beside it."""


@dataclass(frozen=True, eq=False)
class VertexDomain(Domain):
    """Directions seen from the vertex: gnomonic, or stereographic where they spread too wide.

    Gnomonic, the directions that border the normals of a polyhedral vertex are straight lines.

    Args:
        point: the vertex.
        middle: unit direction (3,) that becomes the origin.
        straight: whether the picture is gnomonic.
    """

    point: Array
    middle: Array
    straight: bool

    def to_plane(self, feet: Array, toward: Array) -> Array:
        away = toward - self.point
        length = norm(away)
        if (length == 0).any():
            raise GeometryError("a ball without radius at {at} has no direction", at=self.point)
        d = away / length[..., None]
        x, y = frame(-self.middle)
        depth = d @ self.middle
        scale = depth if self.straight else (1 + depth) / 2
        if (scale <= 0).any():
            raise GeometryError("a ball at the vertex {at} lies behind it", at=self.point)
        return np.stack([d @ x / scale, d @ y / scale], axis=-1)

    def lift(self, uv: Array) -> tuple[Array, Array]:
        x, y = frame(-self.middle)
        flat = uv[..., :1] * x + uv[..., 1:] * y
        if self.straight:
            d = flat + self.middle
        else:
            d = flat + (1 - dot(flat, flat)[..., None] / 4) * self.middle
        feet = np.broadcast_to(self.point, d.shape).copy()
        return feet, np.asarray(d / norm(d)[..., None])


def vertex_domain(boundary: RegionBoundary, index: int) -> VertexDomain:
    """The domain of a vertex of a region."""
    vertex = boundary.vertices[index]
    if not vertex.edges:
        face = boundary.faces[vertex.faces[0]]
        carrier = boundary.carriers[face.carrier]
        assert carrier.tip_axis is not None
        # the balls that touch an apex lie in the cone of normals about the axis
        wide = -float(carrier.normal(face.point) @ carrier.tip_axis) > WIDE_COSINE
        return VertexDomain(vertex.point, -carrier.tip_axis, wide)
    normals = []
    for k in vertex.edges:
        for f in boundary.edges[k].faces:
            face = boundary.faces[f]
            normals.append(
                -face.outward * boundary.carriers[face.carrier].normal(_near(boundary, k, index))
            )
    rays = np.array(normals)
    total = rays.sum(axis=0)
    if float(norm(total)) < NO_MIDDLE:
        raise GeometryError("the normals at the vertex {at} have no middle", at=vertex.point)
    middle = total / norm(total)
    return VertexDomain(vertex.point, middle, bool((rays @ middle > WIDE_COSINE).all()))


def reaches_into(boundary: RegionBoundary, index: int, directions: Array) -> Bools:
    """Whether a small ball that touches a vertex from within the region can lie in each direction.

    To first order: the surface around the vertex must lie behind the ball's tangent plane.

    Args:
        boundary: of the region.
        index: of the vertex.
        directions: unit vectors (k, 3).
    """
    surface = tangent_directions(boundary, index)
    return np.asarray((directions @ surface.T <= NORMAL_SLOPE).all(axis=1))


def tangent_directions(boundary: RegionBoundary, index: int) -> Array:
    """Unit vectors (k, 3) from a vertex into its edges and faces."""
    found = [
        _sector(corner)
        for face in boundary.vertices[index].faces
        for corner in _corners(boundary, index, face)
    ]
    if not found:
        point = boundary.vertices[index].point
        raise GeometryError("no face has a corner at the vertex {at}", at=point)
    return np.concatenate(found)


def opening(boundary: RegionBoundary, index: int, face: int, edge: int) -> float:
    """The angle in (0, 2 pi) that a face leaves free at its corner between an edge and the next."""
    for corner in _corners(boundary, index, face):
        if edge in corner.edges:
            return 2 * np.pi - corner.angle
    point = boundary.vertices[index].point
    raise GeometryError(f"edge {edge} has no corner at the vertex {{at}}", at=point)


@dataclass(frozen=True, eq=False)
class _Corner:
    """A face's corner at a vertex: from `first` counterclockwise about `normal` by `angle`."""

    edges: tuple[int, int]
    first: Array
    normal: Array
    angle: float


def _corners(boundary: RegionBoundary, index: int, number: int) -> list[_Corner]:
    """All corners that a face has at a vertex."""
    face = boundary.faces[number]
    found = []
    for loop in face.loops:
        for n, (k, direction) in enumerate(loop):
            edge = boundary.edges[k]
            before, sign = loop[n - 1]
            if edge.vertices is None or edge.vertices[0 if direction > 0 else 1] != index:
                continue
            first = _leaving(edge, direction)
            last = _leaving(boundary.edges[before], -sign)
            carrier = boundary.carriers[face.carrier]
            normal = face.outward * carrier.normal(_near(boundary, k, index))
            side = cross(normal, first)
            angle = float(np.arctan2(dot(last, side), dot(last, first))) % (2 * np.pi)
            found.append(_Corner((k, before), first, normal, angle))
    return found


def _sector(corner: _Corner) -> Array:
    """Unit vectors from a corner's first edge to its last."""
    side = cross(corner.normal, corner.first)
    turn = np.linspace(0.0, corner.angle, SECTOR_DIRECTIONS)[:, None]
    return np.asarray(np.cos(turn) * corner.first + np.sin(turn) * side)


def _leaving(edge: Edge, direction: int) -> Array:
    """Unit tangent with which an edge leaves its start (+1), or its end backwards (-1)."""
    t = np.array(edge.start if direction > 0 else edge.end)
    tangent = direction * edge.curve.derivative(edge.curve.wrapped(t))
    return np.asarray(tangent / norm(tangent))


def _near(boundary: RegionBoundary, edge: int, vertex: int) -> Array:
    """The vertex, or a point of the edge beside it where a cone's apex has no normal."""
    e = boundary.edges[edge]
    point = boundary.vertices[vertex].point
    apexes = [c.tip for c in boundary.carriers if c.tip is not None]
    if not any(norm(a - point) <= AT_APEX * boundary.diagonal for a in apexes):
        return point
    assert e.vertices is not None
    share = BESIDE_VERTEX if e.vertices[0] == vertex else 1 - BESIDE_VERTEX
    t = np.array(e.start + share * (e.end - e.start))
    return e.curve.point(e.curve.wrapped(t))
