"""One nappe of a circular cone: rho cos(angle) = z sin(angle), z >= 0 from the apex."""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, sin
from typing import ClassVar

import numpy as np

from decomp.carriers.axial import axial_split
from decomp.carriers.base import Carrier, pack
from decomp.similarity import Similarity
from decomp.vectors import Array, cross, dot, norm


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

    def signed_distance(self, p: Array) -> Array:
        z, rho, _ = axial_split(p, self.apex, self.axis)
        along = rho * sin(self.angle) + z * cos(self.angle)
        across = rho * cos(self.angle) - z * sin(self.angle)
        return np.where(along > 0, across, np.hypot(rho, z))

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

    def packed(self) -> Array:
        return pack(self.apex, self.axis, sin(self.angle), cos(self.angle))
