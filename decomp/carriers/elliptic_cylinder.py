"""Infinite elliptic cylinder: (u / a)^2 + (v / b)^2 = 1 across the axis, a >= b."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

import numpy as np

from decomp.carriers.axial import axis_deviation, nearest_to_origin
from decomp.carriers.base import Carrier, Level, pack
from decomp.carriers.charts import Chart, EllipticCylinderChart
from decomp.carriers.point_ellipse import nearest_on_ellipse
from decomp.carriers.straight_sides import StraightSides
from decomp.similarity import Similarity
from decomp.vectors import Array, cross, dot, norm


@dataclass(frozen=True, eq=False)
class EllipticCylinder(StraightSides):
    """The cylinder about the line through `point` along unit `axis` whose section is an ellipse.

    Its major semi-axis `a` is along the unit vector `x` across the axis, its minor one `b` along
    `axis` x `x`. Inside, feet are not unique on the strip between the lines of the evolute's cusps
    nearest the axis, u = +-(a^2 - b^2) / a, v = 0, which is its medial axis.
    """

    point: Array
    axis: Array
    x: Array
    a: float
    b: float

    kind: ClassVar[str] = "elliptic cylinder"
    code: ClassVar[int] = 5
    degree: ClassVar[int] = 2
    revolved: ClassVar[bool] = False
    traceable: ClassVar[bool] = False

    @cached_property
    def y(self) -> Array:
        """Unit vector (3,) along the minor semi-axis."""
        return cross(self.axis, self.x)

    def signed_distance(self, p: Array) -> Array:
        away = p - self.point
        return _distance(dot(away, self.x), dot(away, self.y), self.a, self.b)

    @classmethod
    def distances_of(cls, rows: Array, p: Array) -> Array:
        x = rows[:, 8:11]
        away = p[None, :, :] - rows[:, None, :3]
        u, v = dot(away, x[:, None]), dot(away, cross(rows[:, 3:6], x)[:, None])
        return _distance(u, v, rows[:, None, 6], rows[:, None, 7])

    @classmethod
    def along_line(cls, rows: Array, origin: Array, direction: Array) -> tuple[Array, Array, Array]:
        away, x, b = origin - rows[:, :3], rows[:, 8:11], rows[:, 7]
        y, flat = cross(rows[:, 3:6], x), b / rows[:, 6]
        u, v = flat * dot(away, x), dot(away, y)
        du, dv = flat * (x @ direction), y @ direction
        return du**2 + dv**2, u * du + v * dv, u**2 + v**2 - b**2

    def foot(self, p: Array) -> Array:
        height = dot(p - self.point, self.axis)[..., None]
        c, s = self._nearest(p)
        return np.asarray(self.point + height * self.axis + self._on_section(c, s))

    def normal(self, q: Array) -> Array:
        c, s = self._nearest(q)
        length = np.hypot(self.b * c, self.a * s)
        along, across = self.b * c / length, self.a * s / length
        return np.asarray(along[..., None] * self.x + across[..., None] * self.y)

    def implicit(self, p: Array) -> Array:
        away = p - self.point
        square = (dot(away, self.x) / self.a) ** 2 + (dot(away, self.y) / self.b) ** 2
        return np.asarray((square - 1) * (self.b / 2))

    def normal_curvature(self, q: Array, direction: Array) -> Array:
        c, s = self._nearest(q)
        bend = self.a * self.b / np.hypot(self.b * c, self.a * s) ** 3
        return np.asarray(bend * dot(cross(self.axis, self.normal(q)), direction) ** 2)

    def transformed(self, by: Similarity) -> EllipticCylinder:
        axis, x = by.directions(self.axis), by.directions(self.x)
        return EllipticCylinder(
            by.points(self.point), axis, x, by.scale * self.a, by.scale * self.b
        )

    def coincides(self, other: Carrier, tolerance: float, reach: float) -> int:
        if not isinstance(other, EllipticCylinder):
            return 0
        gap = axis_deviation(self.point, self.axis, other.point, other.axis, reach)
        gap += abs(self.a - other.a) + abs(self.b - other.b)
        # an ellipse that is turned in its plane moves its points the less the rounder it is
        gap += (self.a - self.b) * float(norm(cross(self.x, other.x)))
        return 1 if gap <= tolerance else 0

    def features(self, reach: float) -> Array:
        near = nearest_to_origin(self.point, self.axis)
        sizes = [self.a / reach, self.b / reach]
        return np.concatenate([near / reach, np.abs(self.axis), sizes])

    @property
    def least_radius(self) -> float:
        return self.b**2 / self.a

    @property
    def width(self) -> float:
        return self.a

    def section_reach(self) -> Array:
        return np.hypot(self.a * self.x, self.b * self.y)

    def level(self, point: Array) -> Level | None:
        centre = self.point + float((point - self.point) @ self.axis) * self.axis
        return Level(centre, self.x, self.y, self.a, self.b)

    def chart(self, tip: bool = False, reach: float = 1.0, pole: Array | None = None) -> Chart:
        return EllipticCylinderChart(self.point, self.axis, self.x, self.a, self.b)

    def packed(self) -> Array:
        return pack(self.point, self.axis, self.a, self.b, self.x)

    def _nearest(self, p: Array) -> tuple[Array, Array]:
        away = p - self.point
        a, b = np.asarray(self.a), np.asarray(self.b)
        return nearest_on_ellipse(dot(away, self.x), dot(away, self.y), a, b)

    def _on_section(self, c: Array, s: Array) -> Array:
        along, across = self.a * np.asarray(c)[..., None], self.b * np.asarray(s)[..., None]
        return np.asarray(along * self.x + across * self.y)


def _distance(u: Array, v: Array, a: Array | float, b: Array | float) -> Array:
    """Signed distance along the foot's normal: an error along the ellipse hardly counts."""
    c, s = nearest_on_ellipse(u, v, np.asarray(a), np.asarray(b))
    out = b * c * (u - a * c) + a * s * (v - b * s)
    return np.asarray(out / np.hypot(b * c, a * s))
