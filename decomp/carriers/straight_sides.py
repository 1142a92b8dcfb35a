"""What cylinders have in common, whatever their section: integrals, frames, rulings, far ends.

With s the length along the section, z the height along the axis, n the normal and around = axis x n
the area element is ds dz. Green's theorem makes the integral of f(s) over a face that of -z f(s) ds
along its border, which has the face on its left.
"""

from __future__ import annotations

from abc import abstractmethod

import numpy as np

from decomp.carriers.axial import box_between, nearest_to_origin, odd_side, straight_box
from decomp.carriers.base import Border, Carrier
from decomp.vectors import Array, cross, dot, norm


class StraightSides(Carrier):
    """A cylinder over a closed curve, along `axis` through `point`."""

    point: Array
    axis: Array

    @abstractmethod
    def section_reach(self) -> Array:
        """How far (3,) the section reaches from the axis along the coordinates."""

    @property
    def remoteness(self) -> float:
        return float(norm(nearest_to_origin(self.point, self.axis)))

    def box(self) -> Array:
        return straight_box(self.point, self.axis, self.section_reach())

    def section_kind(self, normal: Array) -> str:
        return "ellipse"

    def border_terms(
        self, border: Border, origin: Array, pole: Array | None
    ) -> tuple[float, float]:
        away, normal = border.points - self.point, self.normal(border.points)
        z = away @ self.axis - float((origin - self.point) @ self.axis)
        lift = z * dot(cross(self.axis, normal), border.steps)
        return -float(lift.sum()), -float(lift @ dot(away, normal))

    def second_term(self, border: Border, origin: Array, pole: Array | None, field: Array) -> float:
        z, normal = (border.points - self.point) @ self.axis, self.normal(border.points)
        slope = float(self.axis @ field)
        start = (border.points - origin) @ field - z * slope
        inner = start * z + slope * z**2 / 2
        arc = dot(cross(self.axis, normal), border.steps)
        return -float((normal @ field * inner) @ arc)

    def in_frames(self, points: Array, tangents: Array, pole: Array | None) -> tuple[Array, Array]:
        around = cross(self.axis, self.normal(points))
        return dot(tangents, around), dot(tangents, self.axis)

    def ruling(self, point: Array) -> Array | None:
        return self.axis

    def rise(self, points: Array) -> Array:
        return np.asarray(points @ self.axis)

    def far_points(self, centre: Array, radius: float) -> list[Array]:
        side = odd_side(self.axis)
        ends = [centre + s * 4 * radius * self.axis for s in (1.0, -1.0)]
        return [self.foot(end + 1e-3 * radius * side) for end in ends]

    def box_around(self, parts: Array) -> Array | None:
        if not len(parts):
            return None
        return box_between(self.point, self.axis, parts, self.section_reach())
