"""Plane: (p - point) . normal = 0, inside where the left side is negative."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from decomp.carriers.base import Carrier, pack
from decomp.similarity import Similarity
from decomp.vectors import Array, dot


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

    def packed(self) -> Array:
        return pack(self.point, self.normal_vector)
