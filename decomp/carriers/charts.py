"""Carriers laid out flat: coordinates (u, v) that run counterclockwise seen from their outside.

Lengths are kept where that can be done (plane, cylinders), else angles (sphere, cone without its
apex), else one of the two directions (cone with its apex, torus).
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from math import cos, pi, sin

import numpy as np

from decomp.carriers.axial import axial_split
from decomp.carriers.ellipse_arc import arc_angle, arc_length, perimeter
from decomp.errors import GeometryError
from decomp.vectors import Array, dot, frame, norm

Period = tuple[float | None, float | None]
"""Of both coordinates, None where there is none."""

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
        return None, None

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

    point: Array
    axis: Array
    radius: float

    @property
    def period(self) -> Period:
        return 2 * pi * self.radius, None

    def to_plane(self, points: Array) -> Array:
        z, _, outward = axial_split(points, self.point, self.axis)
        return np.stack([self.radius * _angle(outward, self.axis), z], axis=-1)

    def to_space(self, uv: Array) -> Array:
        radial = _radial(uv[..., 0] / self.radius, self.axis)
        return np.asarray(self.point + self.radius * radial + uv[..., 1:] * self.axis)


@dataclass(frozen=True, eq=False)
class EllipticCylinderChart(Chart):
    """(length of the section from its major semi-axis, height): the cylinder unrolled.

    Args:
        point: of the axis.
        axis: unit vector.
        x: unit vector along the major semi-axis.
        a: its length.
        b: that of the minor one.
    """

    point: Array
    axis: Array
    x: Array
    a: float
    b: float

    @property
    def period(self) -> Period:
        return perimeter(self.a, self.b), None

    def to_plane(self, points: Array) -> Array:
        away = points - self.point
        y = np.cross(self.axis, self.x)
        # of points on it: anywhere else another point of the section would be meant
        angle = np.arctan2(dot(away, y) / self.b, dot(away, self.x) / self.a)
        return np.stack([arc_length(angle, self.a, self.b), dot(away, self.axis)], axis=-1)

    def to_space(self, uv: Array) -> Array:
        angle, y = arc_angle(uv[..., 0], self.a, self.b), np.cross(self.axis, self.x)
        section = self.a * np.cos(angle)[..., None] * self.x
        section = section + self.b * np.sin(angle)[..., None] * y
        return np.asarray(self.point + section + uv[..., 1:] * self.axis)


@dataclass(frozen=True, eq=False)
class ConeChart(Chart):
    """Seen along the axis, with slant lengths: the apex is the origin."""

    apex: Array
    axis: Array
    angle: float

    def to_plane(self, points: Array) -> Array:
        slant, outward = _slant(self.apex, self.axis, self.angle, points)
        x, y = frame(self.axis)
        return np.stack([slant * dot(outward, x), -slant * dot(outward, y)], axis=-1)

    def to_space(self, uv: Array) -> Array:
        x, y = frame(self.axis)
        side = uv[..., :1] * x - uv[..., 1:] * y
        slant = np.hypot(uv[..., 0], uv[..., 1])[..., None]
        return np.asarray(self.apex + sin(self.angle) * side + cos(self.angle) * slant * self.axis)


@dataclass(frozen=True, eq=False)
class ConeStripChart(Chart):
    """Angle and logarithm of the slant length, which keeps angles: the cone without its apex.

    Args:
        apex: of the cone.
        axis: unit vector into it.
        angle: half of its opening, in radians.
        slant: the slant length at which lengths are kept.
    """

    apex: Array
    axis: Array
    angle: float
    slant: float

    @property
    def _scale(self) -> float:
        return self.slant * sin(self.angle)

    @property
    def period(self) -> Period:
        return 2 * pi * self._scale, None

    def to_plane(self, points: Array) -> Array:
        slant, outward = _slant(self.apex, self.axis, self.angle, points)
        if (slant <= 0).any():
            raise GeometryError("the apex {at} of a cone has no place in its strip", at=self.apex)
        height = np.log(slant / self.slant) / sin(self.angle)
        return np.asarray(self._scale * np.stack([_angle(outward, self.axis), height], axis=-1))

    def to_space(self, uv: Array) -> Array:
        radial = _radial(uv[..., 0] / self._scale, self.axis)
        slant = self.slant * np.exp(uv[..., 1:] / self._scale * sin(self.angle))
        ruling = sin(self.angle) * radial + cos(self.angle) * self.axis
        return np.asarray(self.apex + slant * ruling)


@dataclass(frozen=True, eq=False)
class SphereChart(Chart):
    """Stereographic from a pole, lengths kept at the point opposite.

    Args:
        centre: of the sphere.
        radius: of it.
        pole: unit vector from the centre to the one point that has no place in the plane.
    """

    centre: Array
    radius: float
    pole: Array

    def to_plane(self, points: Array) -> Array:
        away = points - self.centre
        d = away / norm(away)[..., None]
        x, y = frame(-self.pole)
        gap = 1 - d @ self.pole
        if (gap < POLE_GAP).any():
            at = self.centre + self.radius * self.pole
            raise GeometryError("a point at the pole {at} of a sphere has no place", at=at)
        flat = np.stack([d @ x, d @ y], axis=-1)
        return np.asarray(2 * self.radius * flat / gap[..., None])

    def to_space(self, uv: Array) -> Array:
        x, y = frame(-self.pole)
        w = uv / (2 * self.radius)
        square = dot(w, w)[..., None]
        d = (2 * (w[..., :1] * x + w[..., 1:] * y) + (square - 1) * self.pole) / (1 + square)
        return np.asarray(self.centre + self.radius * d)


@dataclass(frozen=True, eq=False)
class TorusChart(Chart):
    """(major * angle about the axis, minor * angle in the tube)."""

    centre: Array
    axis: Array
    major: float
    minor: float

    @property
    def period(self) -> Period:
        return 2 * pi * self.major, 2 * pi * self.minor

    def to_plane(self, points: Array) -> Array:
        z, rho, outward = axial_split(points, self.centre, self.axis)
        around, tube = _angle(outward, self.axis), np.arctan2(z, rho - self.major)
        return np.stack([self.major * around, self.minor * tube], axis=-1)

    def to_space(self, uv: Array) -> Array:
        tube = uv[..., 1:] / self.minor
        radial = _radial(uv[..., 0] / self.major, self.axis)
        rho, height = self.major + self.minor * np.cos(tube), self.minor * np.sin(tube)
        return np.asarray(self.centre + rho * radial + height * self.axis)


def _angle(outward: Array, axis: Array) -> Array:
    """Angle (...) about the axis of unit vectors (..., 3) across it, in [-pi, pi]."""
    x, y = frame(axis)
    return np.arctan2(dot(outward, y), dot(outward, x))


def _radial(angle: Array, axis: Array) -> Array:
    """Unit vectors (..., 3) across the axis at angles (...) about it."""
    x, y = frame(axis)
    return np.asarray(np.cos(angle)[..., None] * x + np.sin(angle)[..., None] * y)


def _slant(apex: Array, axis: Array, angle: float, points: Array) -> tuple[Array, Array]:
    """Distance from the apex along a ruling, and the direction away from the axis."""
    z, rho, outward = axial_split(points, apex, axis)
    return np.maximum(rho * sin(angle) + z * cos(angle), 0.0), outward
