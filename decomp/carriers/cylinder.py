"""Infinite circular cylinder: distance rho from the axis equals the radius."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from decomp.carriers.axial import (
    axial_line,
    axial_rows,
    axial_split,
    axis_deviation,
    circle_through,
    nearest_to_origin,
    off_axis,
    round_reach,
)
from decomp.carriers.base import Carrier, Level, pack
from decomp.carriers.charts import Chart, CylinderChart
from decomp.carriers.straight_sides import StraightSides
from decomp.similarity import Similarity
from decomp.vectors import Array, cross, dot


@dataclass(frozen=True, eq=False)
class Cylinder(StraightSides):
    """The cylinder about the line through `point` along unit `axis`; that line is its
    reflexive locus."""

    point: Array
    axis: Array
    radius: float

    kind: ClassVar[str] = "cylinder"
    code: ClassVar[int] = 2
    degree: ClassVar[int] = 2
    locus: ClassVar[int | None] = 1

    def signed_distance(self, p: Array) -> Array:
        _, rho, _ = axial_split(p, self.point, self.axis)
        return np.asarray(rho - self.radius)

    @classmethod
    def distances_of(cls, rows: Array, p: Array) -> Array:
        return np.asarray(axial_rows(rows, p)[1] - rows[:, None, 6])

    @classmethod
    def along_line(cls, rows: Array, origin: Array, direction: Array) -> tuple[Array, Array, Array]:
        along, straight, lift, square = axial_line(rows, origin, direction)
        return 1 - along**2, straight - lift * along, square - lift**2 - rows[:, 6] ** 2

    def foot(self, p: Array) -> Array:
        z, _, outward = axial_split(p, self.point, self.axis)
        return np.asarray(self.point + z[..., None] * self.axis + self.radius * outward)

    def normal(self, q: Array) -> Array:
        return axial_split(q, self.point, self.axis)[2]

    def implicit(self, p: Array) -> Array:
        away = p - self.point
        square = dot(away, away) - dot(away, self.axis) ** 2
        return np.asarray((square - self.radius**2) / (2 * self.radius))

    def normal_curvature(self, q: Array, direction: Array) -> Array:
        around = cross(self.axis, self.normal(q))
        return np.asarray(dot(around, direction) ** 2 / self.radius)

    def transformed(self, by: Similarity) -> Cylinder:
        return Cylinder(by.points(self.point), by.directions(self.axis), by.scale * self.radius)

    def coincides(self, other: Carrier, tolerance: float, reach: float) -> int:
        if not isinstance(other, Cylinder):
            return 0
        gap = axis_deviation(self.point, self.axis, other.point, other.axis, reach)
        return 1 if gap + abs(self.radius - other.radius) <= tolerance else 0

    def features(self, reach: float) -> Array:
        near = nearest_to_origin(self.point, self.axis)
        return np.concatenate([near / reach, np.abs(self.axis), [self.radius / reach]])

    @property
    def least_radius(self) -> float:
        return self.radius

    @property
    def width(self) -> float:
        return self.radius

    def section_reach(self) -> Array:
        return round_reach(self.axis, self.radius)

    def level(self, point: Array) -> Level | None:
        return Level(*circle_through(point, self.point, self.axis))

    def chart(self, tip: bool = False, reach: float = 1.0, pole: Array | None = None) -> Chart:
        return CylinderChart(self.point, self.axis, self.radius)

    def reflexive_gap(self, outward: int, points: Array) -> Array:
        if outward < 0:
            return super().reflexive_gap(outward, points)
        return off_axis(points, self.point, self.axis)

    def inner_radius(self, outward: int, points: Array) -> Array:
        return np.full(len(points), self.radius)

    def packed(self) -> Array:
        return pack(self.point, self.axis, self.radius)
