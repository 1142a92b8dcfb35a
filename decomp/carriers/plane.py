"""Plane: (p - point) . normal = 0, inside where the left side is negative."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from decomp.carriers.axial import axial_line, odd_side
from decomp.carriers.base import EVERYWHERE, Border, Carrier, pack
from decomp.carriers.charts import Chart, PlaneChart
from decomp.similarity import Similarity
from decomp.vectors import Array, cross, dot, frame, perpendicular


@dataclass(frozen=True, eq=False)
class Plane(Carrier):
    """The plane through `point` with outward unit `normal`."""

    point: Array
    normal_vector: Array

    kind: ClassVar[str] = "plane"
    code: ClassVar[int] = 0
    degree: ClassVar[int] = 1

    def signed_distance(self, p: Array) -> Array:
        return dot(p - self.point, self.normal_vector)

    @classmethod
    def distances_of(cls, rows: Array, p: Array) -> Array:
        return dot(p[None, :, :] - rows[:, None, :3], rows[:, None, 3:6])

    @classmethod
    def along_line(cls, rows: Array, origin: Array, direction: Array) -> tuple[Array, Array, Array]:
        along, _, lift, _ = axial_line(rows, origin, direction)
        return np.zeros(len(rows)), along / 2, lift

    def foot(self, p: Array) -> Array:
        return np.asarray(p - self.signed_distance(p)[..., None] * self.normal_vector)

    def normal(self, q: Array) -> Array:
        return np.broadcast_to(self.normal_vector, np.shape(q))

    def implicit(self, p: Array) -> Array:
        return self.signed_distance(p)

    def normal_curvature(self, q: Array, direction: Array) -> Array:
        return np.zeros(np.shape(q)[:-1])

    def transformed(self, by: Similarity) -> Plane:
        return Plane(by.points(self.point), by.directions(self.normal_vector))

    def coincides(self, other: Carrier, tolerance: float, reach: float) -> int:
        if not isinstance(other, Plane):
            return 0
        sign = 1 if float(dot(self.normal_vector, other.normal_vector)) > 0 else -1
        tilt = float(np.linalg.norm(self.normal_vector - sign * other.normal_vector))
        gap = abs(float(self.signed_distance(other.point)))
        return sign if tilt * reach <= tolerance and gap <= tolerance else 0

    def features(self, reach: float) -> Array:
        offset = float(dot(self.point, self.normal_vector))
        return np.asarray(np.abs(np.append(self.normal_vector, offset / reach)))

    def box(self) -> Array:
        (low, high), (outer_low, outer_high) = self.half_space_boxes()
        return np.array([np.maximum(low, outer_low), np.minimum(high, outer_high)])

    def half_space_boxes(self) -> tuple[Array, Array]:
        inside, outside = np.array(EVERYWHERE), np.array(EVERYWHERE)
        k = int(np.argmax(np.abs(self.normal_vector)))
        sign = self.normal_vector[k]
        if abs(abs(sign) - 1.0) < 1e-15:
            low, high = (outside, inside) if sign > 0 else (inside, outside)
            high[1, k] = low[0, k] = self.point[k]
        return inside, outside

    def box_around(self, parts: Array) -> Array | None:
        if not len(parts):
            return None
        return np.array([parts[:, :3].min(axis=0), parts[:, 3:].max(axis=0)])

    def far_points(self, centre: Array, radius: float) -> list[Array]:
        return [self.foot(centre) + 4 * radius * odd_side(self.normal_vector)]

    def ruling(self, point: Array) -> Array | None:
        return perpendicular(self.normal_vector)

    def rise(self, points: Array) -> Array:
        return np.asarray(points @ perpendicular(self.normal_vector))

    def border_terms(
        self, border: Border, origin: Array, pole: Array | None
    ) -> tuple[float, float]:
        swept = cross(border.points - origin, border.steps).sum(axis=0) / 2
        return float(swept @ self.normal_vector), 0.0

    def second_term(self, border: Border, origin: Array, pole: Array | None, field: Array) -> float:
        x, y = frame(self.normal_vector)
        away = border.points - self.point
        u, v, du = away @ x, away @ y, border.steps @ x
        inner = (float((self.point - origin) @ field) + u * float(x @ field)) * v
        inner += float(y @ field) * v**2 / 2
        return -float(self.normal_vector @ field) * float(inner @ du)

    def in_frames(self, points: Array, tangents: Array, pole: Array | None) -> tuple[Array, Array]:
        x, y = frame(self.normal_vector)
        return dot(tangents, x), dot(tangents, y)

    def chart(self, tip: bool = False, reach: float = 1.0, pole: Array | None = None) -> Chart:
        return PlaneChart(self.point, *frame(self.normal_vector))

    def packed(self) -> Array:
        return pack(self.point, self.normal_vector)
