"""Sphere: |p - centre| = radius."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from decomp.carriers.axial import axial_line, axial_split
from decomp.carriers.base import Border, Carrier, pack
from decomp.carriers.charts import Chart, SphereChart
from decomp.errors import GeometryError
from decomp.similarity import Similarity
from decomp.vectors import Array, cross, dot, frame, norm


@dataclass(frozen=True, eq=False)
class Sphere(Carrier):
    """The sphere about `centre`; its reflexive locus is the centre."""

    centre: Array
    radius: float

    kind: ClassVar[str] = "sphere"
    code: ClassVar[int] = 1
    degree: ClassVar[int] = 2
    closed: ClassVar[bool] = True
    needs_pole: ClassVar[bool] = True
    locus: ClassVar[int | None] = 0

    def signed_distance(self, p: Array) -> Array:
        return np.asarray(norm(p - self.centre) - self.radius)

    @classmethod
    def distances_of(cls, rows: Array, p: Array) -> Array:
        return np.asarray(norm(p[None, :, :] - rows[:, None, :3]) - rows[:, None, 6])

    @classmethod
    def along_line(cls, rows: Array, origin: Array, direction: Array) -> tuple[Array, Array, Array]:
        _, straight, _, square = axial_line(rows, origin, direction)
        return np.ones(len(rows)), straight, square - rows[:, 6] ** 2

    def foot(self, p: Array) -> Array:
        return np.asarray(self.centre + self.radius * self.normal(p))

    def normal(self, q: Array) -> Array:
        away = q - self.centre
        length = norm(away)[..., None]
        return np.where(length > 0, away / np.where(length > 0, length, 1.0), [0.0, 0.0, 1.0])

    def implicit(self, p: Array) -> Array:
        away = p - self.centre
        return np.asarray((dot(away, away) - self.radius**2) / (2 * self.radius))

    def normal_curvature(self, q: Array, direction: Array) -> Array:
        return np.full(np.shape(q)[:-1], 1.0 / self.radius)

    def transformed(self, by: Similarity) -> Sphere:
        return Sphere(by.points(self.centre), by.scale * self.radius)

    def coincides(self, other: Carrier, tolerance: float, reach: float) -> int:
        if not isinstance(other, Sphere):
            return 0
        gap = float(norm(self.centre - other.centre)) + abs(self.radius - other.radius)
        return 1 if gap <= tolerance else 0

    def features(self, reach: float) -> Array:
        return np.append(self.centre, self.radius) / reach

    @property
    def least_radius(self) -> float:
        return self.radius

    @property
    def width(self) -> float:
        return self.radius

    @property
    def remoteness(self) -> float:
        return float(norm(self.centre))

    def box(self) -> Array:
        return np.array([self.centre - self.radius, self.centre + self.radius])

    def extreme_points(self) -> Array:
        units = np.concatenate([np.eye(3), -np.eye(3)])
        return np.asarray(self.centre + self.radius * units)

    @property
    def whole(self) -> tuple[float, float]:
        area = 4 * np.pi * self.radius**2
        return area, area * self.radius

    def border_terms(
        self, border: Border, origin: Array, pole: Array | None
    ) -> tuple[float, float]:
        """W = r^2 (1 + sin v), v the latitude, in the integral of -W du, u the longitude."""
        if pole is None:
            return 0.0, 0.0
        z, rho, out = axial_split(border.points, self.centre, pole)
        arc = dot(cross(pole, out), border.steps)
        # r^2 (1 + z/r) arc / rho, with rho^2 = (r - z)(r + z)
        area = -float((self.radius * rho * arc / (self.radius - z)).sum())
        return area, self.radius * area

    def second_term(self, border: Border, origin: Array, pole: Array | None, field: Array) -> float:
        """The inner integral is zero at the pole's antipode, where u has no meaning.

        With n = cos v r + sin v k, a = r.e and b = k.e the integrals over v from -pi/2 are

            cos v n.e       a (v / 2 + s c / 2 + pi / 4) - b c^2 / 2
            cos v (n.e)^2   a^2 (s - s^3 / 3 + 2 / 3) - 2 a b c^3 / 3 + b^2 (s^3 + 1) / 3

        with s = sin v and c = cos v.
        """
        if pole is None:
            return 0.0
        z, rho, out = axial_split(border.points, self.centre, pole)
        du = dot(cross(pole, out), border.steps) / rho
        s, c = z / self.radius, rho / self.radius
        a, b = out @ field, float(pole @ field)
        latitude = np.arctan2(s, c)
        first = a * ((latitude + np.pi / 2 + s * c) / 2) - b * c**2 / 2
        second = a**2 * (s - s**3 / 3 + 2 / 3) - 2 * a * b * c**3 / 3 + b**2 * (s**3 + 1) / 3
        inner = float((self.centre - origin) @ field) * first + self.radius * second
        return -float(self.radius**2 * inner @ du)

    def in_frames(self, points: Array, tangents: Array, pole: Array | None) -> tuple[Array, Array]:
        assert pole is not None
        # seen from the pole the plane has the other sense
        y, x = frame(pole)
        n = (points - self.centre) / self.radius
        height, rise = dot(n, pole), dot(tangents, pole)
        moved = tangents + n * (rise / (1 - height))[..., None]
        return dot(moved, x), dot(moved, y)

    def chart(self, tip: bool = False, reach: float = 1.0, pole: Array | None = None) -> Chart:
        if pole is None:
            raise GeometryError("the sphere about {at} needs a pole to be drawn", at=self.centre)
        return SphereChart(self.centre, self.radius, pole)

    def grid(self, finer: int, pole: Array | None = None) -> tuple[Array, float]:
        if pole is None:
            return super().grid(finer)
        x, y = frame(pole)
        around = self.centre + self.radius * np.array([-pole, x, y, -x, -y])
        return around, 1.5 * self.radius

    def reflexive_gap(self, outward: int, points: Array) -> Array:
        if outward < 0:
            return super().reflexive_gap(outward, points)
        return norm(points - self.centre)

    def inner_radius(self, outward: int, points: Array) -> Array:
        return np.full(len(points), self.radius)

    def packed(self) -> Array:
        return pack(self.centre, np.array([0.0, 0.0, 1.0]), self.radius)
