"""Sphere: |p - centre| = radius."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from decomp.carriers.base import Carrier, pack
from decomp.similarity import Similarity
from decomp.vectors import Array, dot, norm


@dataclass(frozen=True, eq=False)
class Sphere(Carrier):
    """The sphere about `centre`; its reflexive locus is the centre."""

    centre: Array
    radius: float

    kind: ClassVar[str] = "sphere"
    code: ClassVar[int] = 1
    degree: ClassVar[int] = 2

    def signed_distance(self, p: Array) -> Array:
        return np.asarray(norm(p - self.centre) - self.radius)

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

    def packed(self) -> Array:
        return pack(self.centre, np.array([0.0, 0.0, 1.0]), self.radius)
