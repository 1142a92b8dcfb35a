"""One nappe of a circular cone: rho cos(angle) = z sin(angle), z >= 0 from the apex."""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, sin
from typing import ClassVar

import numpy as np

from decomp.carriers.axial import (
    axial_line,
    axial_rows,
    axial_split,
    circle_through,
    heights,
    odd_side,
    off_axis,
    round_reach,
)
from decomp.carriers.base import Border, Carrier, Level, pack
from decomp.carriers.charts import Chart, ConeChart, ConeStripChart
from decomp.similarity import Similarity
from decomp.vectors import Array, cross, dot, frame, norm


@dataclass(frozen=True, eq=False)
class Cone(Carrier):
    """The nappe that opens from `apex` along unit `axis` with half-angle `angle` (radians).

    Inside is the convex side. Points beyond the apex have the apex as their foot. The
    reflexive locus is the half-axis inside.
    """

    apex: Array
    axis: Array
    angle: float

    kind: ClassVar[str] = "cone"
    code: ClassVar[int] = 3
    degree: ClassVar[int] = 2
    locus: ClassVar[int | None] = 1

    def signed_distance(self, p: Array) -> Array:
        z, rho, _ = axial_split(p, self.apex, self.axis)
        along = rho * sin(self.angle) + z * cos(self.angle)
        across = rho * cos(self.angle) - z * sin(self.angle)
        return np.where(along > 0, across, np.hypot(rho, z))

    @classmethod
    def distances_of(cls, rows: Array, p: Array) -> Array:
        z, rho = axial_rows(rows, p)
        sine, cosine = rows[:, None, 6], rows[:, None, 7]
        along = rho * sine + z * cosine
        return np.where(along > 0, rho * cosine - z * sine, np.hypot(rho, z))

    @classmethod
    def along_line(cls, rows: Array, origin: Array, direction: Array) -> tuple[Array, Array, Array]:
        along, straight, lift, square = axial_line(rows, origin, direction)
        cosine2 = rows[:, 7] ** 2
        return cosine2 - along**2, straight * cosine2 - lift * along, square * cosine2 - lift**2

    def foot(self, p: Array) -> Array:
        z, rho, outward = axial_split(p, self.apex, self.axis)
        along = np.maximum(rho * sin(self.angle) + z * cos(self.angle), 0.0)[..., None]
        ruling = sin(self.angle) * outward + cos(self.angle) * self.axis
        return np.asarray(self.apex + along * ruling)

    def normal(self, q: Array) -> Array:
        _, _, outward = axial_split(q, self.apex, self.axis)
        return np.asarray(cos(self.angle) * outward - sin(self.angle) * self.axis)

    def implicit(self, p: Array) -> Array:
        """Both nappes vanish: a polynomial cannot tell them apart."""
        away = p - self.apex
        z2 = dot(away, self.axis) ** 2
        return np.asarray((dot(away, away) - z2) * cos(self.angle) ** 2 - z2 * sin(self.angle) ** 2)

    def normal_curvature(self, q: Array, direction: Array) -> Array:
        _, rho, outward = axial_split(q, self.apex, self.axis)
        around = cross(self.axis, outward)
        return np.asarray(dot(around, direction) ** 2 * cos(self.angle) / rho)

    def transformed(self, by: Similarity) -> Cone:
        return Cone(by.points(self.apex), by.directions(self.axis), self.angle)

    def coincides(self, other: Carrier, tolerance: float, reach: float) -> int:
        if not isinstance(other, Cone):
            return 0
        gap = float(norm(self.apex - other.apex))
        tilt = float(norm(self.axis - other.axis)) + abs(self.angle - other.angle)
        return 1 if gap + tilt * reach <= tolerance else 0

    def features(self, reach: float) -> Array:
        return np.concatenate([self.apex / reach, self.axis, [self.angle]])

    @property
    def tip(self) -> Array | None:
        return self.apex

    def box_around(self, parts: Array) -> Array | None:
        if not len(parts):
            return None
        ends = heights(self.apex, self.axis, parts)
        ends[0] = min(ends[0], 0.0)  # a face around the apex has no edge there
        centres = self.apex + ends[:, None] * self.axis
        radii = np.maximum(ends, 0.0) * np.tan(self.angle)
        reach = np.array([round_reach(self.axis, float(radius)) for radius in radii])
        return np.array([(centres - reach).min(axis=0), (centres + reach).max(axis=0)])

    def far_points(self, centre: Array, radius: float) -> list[Array]:
        start = self.apex + 4 * radius * self.axis
        return [self.foot(start + 8 * radius * odd_side(self.axis))]

    def ruling(self, point: Array) -> Array | None:
        away = point - self.apex
        length = float(norm(away))
        return away / length if length > 0.0 else None

    def rise(self, points: Array) -> Array:
        return norm(points - self.apex)

    def border_terms(
        self, border: Border, origin: Array, pole: Array | None
    ) -> tuple[float, float]:
        slant = norm(border.points - self.apex)
        _, _, out = axial_split(border.points, self.apex, self.axis)
        # W = slant^2 sin(angle) / 2 and d(angle) = arc / rho, with rho = slant sin(angle)
        return -float((slant * dot(cross(self.axis, out), border.steps)).sum()) / 2, 0.0

    def second_term(self, border: Border, origin: Array, pole: Array | None, field: Array) -> float:
        _, _, out = axial_split(border.points, self.apex, self.axis)
        v = norm(border.points - self.apex)
        arc = dot(cross(self.axis, out), border.steps)
        sine, cosine = np.sin(self.angle), np.cos(self.angle)
        normal, ruling = cosine * out - sine * self.axis, sine * out + cosine * self.axis
        start = float((self.apex - origin) @ field)
        # du = arc / rho, with rho = v sin(angle)
        inner = start * v / 2 + (ruling @ field) * v**2 / 3
        return -float((normal @ field * inner) @ arc)

    def in_frames(self, points: Array, tangents: Array, pole: Array | None) -> tuple[Array, Array]:
        _, _, out = axial_split(points, self.apex, self.axis)
        ruling = np.cos(self.angle) * self.axis + np.sin(self.angle) * out
        return dot(tangents, cross(self.axis, out)), dot(tangents, ruling)

    @property
    def tip_axis(self) -> Array | None:
        return self.axis

    def around_tip(self, step: float) -> Array:
        x, y = frame(self.axis)
        angles = np.linspace(0.3, 0.3 + 2 * np.pi, 12, endpoint=False)[:, None]
        side = np.cos(angles) * x + np.sin(angles) * y
        return np.asarray(
            self.apex + step * (np.cos(self.angle) * self.axis + np.sin(self.angle) * side)
        )

    def level(self, point: Array) -> Level | None:
        return Level(*circle_through(point, self.apex, self.axis))

    def section_kind(self, normal: Array) -> str:
        return "ellipse" if abs(float(normal @ self.axis)) > sin(self.angle) else "hyperbola"

    def chart(self, tip: bool = False, reach: float = 1.0, pole: Array | None = None) -> Chart:
        if tip:
            return ConeChart(self.apex, self.axis, self.angle)
        return ConeStripChart(self.apex, self.axis, self.angle, reach)

    def reflexive_gap(self, outward: int, points: Array) -> Array:
        if outward < 0:
            return super().reflexive_gap(outward, points)
        return off_axis(points, self.apex, self.axis)

    def inner_radius(self, outward: int, points: Array) -> Array:
        # the normal from the point at slant length l meets the axis at distance l tan(angle)
        return np.asarray(norm(points - self.apex) * np.tan(self.angle))

    def packed(self) -> Array:
        return pack(self.apex, self.axis, sin(self.angle), cos(self.angle))
