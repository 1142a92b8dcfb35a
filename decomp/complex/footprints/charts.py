"""Carriers laid out flat: coordinates (u, v) that run counterclockwise seen from their outside.

Lengths are kept where that can be done (plane, cylinders), else angles (sphere, cone without its
apex), else one of the two directions (cone with its apex, torus).
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from math import cos, pi, sin

import numpy as np

from decomp.carriers import Carrier, Cone, Cylinder, EllipticCylinder, Plane, Sphere, Torus
from decomp.carriers.axial import axial_split
from decomp.carriers.ellipse_arc import arc_angle, arc_length, perimeter
from decomp.complex.plane.planar import PLANE, Period
from decomp.errors import GeometryError
from decomp.vectors import Array, dot, frame

POLE_GAP = 1e-12
"""1 - cos of the angle from a sphere's pole below which a point counts as the pole."""


@dataclass(frozen=True, eq=False)
class Chart(ABC):
    """A one-to-one picture of a carrier, or of all of it but a point, in the plane.

    Attributes:
        period: of u and v, None where there is none.
    """

    @property
    def period(self) -> Period:
        return PLANE

    @abstractmethod
    def to_plane(self, points: Array) -> Array:
        """Coordinates (k, 2) of points (k, 3) on the carrier."""

    @abstractmethod
    def to_space(self, uv: Array) -> Array:
        """Points (k, 3) on the carrier at coordinates (k, 2)."""


@dataclass(frozen=True, eq=False)
class PlaneChart(Chart):
    """Orthonormal coordinates."""

    origin: Array
    x: Array
    y: Array

    def to_plane(self, points: Array) -> Array:
        away = points - self.origin
        return np.stack([away @ self.x, away @ self.y], axis=-1)

    def to_space(self, uv: Array) -> Array:
        return np.asarray(self.origin + uv[..., :1] * self.x + uv[..., 1:] * self.y)


@dataclass(frozen=True, eq=False)
class CylinderChart(Chart):
    """(radius * angle, height): the cylinder unrolled."""

    carrier: Cylinder

    @property
    def period(self) -> Period:
        return 2 * pi * self.carrier.radius, None

    def to_plane(self, points: Array) -> Array:
        c = self.carrier
        z, _, outward = axial_split(points, c.point, c.axis)
        return np.stack([c.radius * _angle(outward, c.axis), z], axis=-1)

    def to_space(self, uv: Array) -> Array:
        c = self.carrier
        radial = _radial(uv[..., 0] / c.radius, c.axis)
        return np.asarray(c.point + c.radius * radial + uv[..., 1:] * c.axis)


@dataclass(frozen=True, eq=False)
class EllipticCylinderChart(Chart):
    """(length of the section from its major semi-axis, height): the cylinder unrolled."""

    carrier: EllipticCylinder

    @property
    def period(self) -> Period:
        return perimeter(self.carrier.a, self.carrier.b), None

    def to_plane(self, points: Array) -> Array:
        c = self.carrier
        along = arc_length(c.angles(points), c.a, c.b)
        return np.stack([along, dot(points - c.point, c.axis)], axis=-1)

    def to_space(self, uv: Array) -> Array:
        c = self.carrier
        return c.at(arc_angle(uv[..., 0], c.a, c.b), uv[..., 1])


@dataclass(frozen=True, eq=False)
class ConeChart(Chart):
    """Seen along the axis, with slant lengths: the apex is the origin."""

    carrier: Cone

    def to_plane(self, points: Array) -> Array:
        c = self.carrier
        slant, outward = _slant(c, points)
        x, y = frame(c.axis)
        return np.stack([slant * dot(outward, x), -slant * dot(outward, y)], axis=-1)

    def to_space(self, uv: Array) -> Array:
        c = self.carrier
        x, y = frame(c.axis)
        side = uv[..., :1] * x - uv[..., 1:] * y
        slant = np.hypot(uv[..., 0], uv[..., 1])[..., None]
        return np.asarray(c.apex + sin(c.angle) * side + cos(c.angle) * slant * c.axis)


@dataclass(frozen=True, eq=False)
class ConeStripChart(Chart):
    """Angle and logarithm of the slant length, which keeps angles: the cone without its apex.

    Args:
        slant: the slant length at which lengths are kept.
    """

    carrier: Cone
    slant: float

    @property
    def _scale(self) -> float:
        return self.slant * sin(self.carrier.angle)

    @property
    def period(self) -> Period:
        return 2 * pi * self._scale, None

    def to_plane(self, points: Array) -> Array:
        c = self.carrier
        slant, outward = _slant(c, points)
        if (slant <= 0).any():
            raise GeometryError("the apex {at} of a cone has no place in its strip", at=c.apex)
        height = np.log(slant / self.slant) / sin(c.angle)
        return np.asarray(self._scale * np.stack([_angle(outward, c.axis), height], axis=-1))

    def to_space(self, uv: Array) -> Array:
        c = self.carrier
        radial = _radial(uv[..., 0] / self._scale, c.axis)
        slant = self.slant * np.exp(uv[..., 1:] / self._scale * sin(c.angle))
        return np.asarray(c.apex + slant * (sin(c.angle) * radial + cos(c.angle) * c.axis))


@dataclass(frozen=True, eq=False)
class SphereChart(Chart):
    """Stereographic from a pole, lengths kept at the point opposite.

    Args:
        pole: unit vector from the centre to the one point that has no place in the plane.
    """

    carrier: Sphere
    pole: Array

    def to_plane(self, points: Array) -> Array:
        d = self.carrier.normal(points)
        x, y = frame(-self.pole)
        gap = 1 - d @ self.pole
        if (gap < POLE_GAP).any():
            at = self.carrier.centre + self.carrier.radius * self.pole
            raise GeometryError("a point at the pole {at} of a sphere has no place", at=at)
        flat = np.stack([d @ x, d @ y], axis=-1)
        return np.asarray(2 * self.carrier.radius * flat / gap[..., None])

    def to_space(self, uv: Array) -> Array:
        c = self.carrier
        x, y = frame(-self.pole)
        w = uv / (2 * c.radius)
        square = dot(w, w)[..., None]
        d = (2 * (w[..., :1] * x + w[..., 1:] * y) + (square - 1) * self.pole) / (1 + square)
        return np.asarray(c.centre + c.radius * d)


@dataclass(frozen=True, eq=False)
class TorusChart(Chart):
    """(major * angle about the axis, minor * angle in the tube)."""

    carrier: Torus

    @property
    def period(self) -> Period:
        return 2 * pi * self.carrier.major, 2 * pi * self.carrier.minor

    def to_plane(self, points: Array) -> Array:
        c = self.carrier
        z, rho, outward = axial_split(points, c.centre, c.axis)
        around, tube = _angle(outward, c.axis), np.arctan2(z, rho - c.major)
        return np.stack([c.major * around, c.minor * tube], axis=-1)

    def to_space(self, uv: Array) -> Array:
        c = self.carrier
        return c.point(uv[..., 0] / c.major, uv[..., 1] / c.minor, *frame(c.axis))


def chart_of(
    carrier: Carrier, apex: bool = False, slant: float = 1.0, pole: Array | None = None
) -> Chart:
    """The chart of a carrier.

    Args:
        carrier: of any kind.
        apex: whether a cone's apex must have a place.
        slant: of a cone without its apex, the slant length at which lengths are kept.
        pole: unit vector (3,), needed for a sphere.

    Raises:
        GeometryError: a sphere is given no pole.
    """
    if isinstance(carrier, Plane):
        return PlaneChart(carrier.point, *frame(carrier.normal_vector))
    if isinstance(carrier, Cylinder):
        return CylinderChart(carrier)
    if isinstance(carrier, EllipticCylinder):
        return EllipticCylinderChart(carrier)
    if isinstance(carrier, Cone):
        return ConeChart(carrier) if apex else ConeStripChart(carrier, slant)
    if isinstance(carrier, Torus):
        return TorusChart(carrier)
    assert isinstance(carrier, Sphere)
    if pole is None:
        raise GeometryError("the sphere about {at} needs a pole to be drawn", at=carrier.centre)
    return SphereChart(carrier, pole)


def _angle(outward: Array, axis: Array) -> Array:
    """Angle (...) about the axis of unit vectors (..., 3) across it, in [-pi, pi]."""
    x, y = frame(axis)
    return np.arctan2(dot(outward, y), dot(outward, x))


def _radial(angle: Array, axis: Array) -> Array:
    """Unit vectors (..., 3) across the axis at angles (...) about it."""
    x, y = frame(axis)
    return np.asarray(np.cos(angle)[..., None] * x + np.sin(angle)[..., None] * y)


def _slant(cone: Cone, points: Array) -> tuple[Array, Array]:
    """Distance from the apex along a ruling, and the direction away from the axis."""
    z, rho, outward = axial_split(points, cone.apex, cone.axis)
    return np.maximum(rho * sin(cone.angle) + z * cos(cone.angle), 0.0), outward
