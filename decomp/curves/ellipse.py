"""Ellipse."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi
from typing import ClassVar

import numpy as np

from decomp.curves.base import Curve
from decomp.vectors import Array, dot


@dataclass(frozen=True, eq=False)
class Ellipse(Curve):
    """centre + a cos t x + b sin t y, 0 <= t <= 2 pi, with orthonormal x and y."""

    centre: Array
    x: Array
    y: Array
    a: float
    b: float

    kind: ClassVar[str] = "ellipse"

    def __post_init__(self) -> None:
        object.__setattr__(self, "domain", (0.0, 2 * pi))
        object.__setattr__(self, "closed", True)

    def point(self, t: Array) -> Array:
        t = np.asarray(t)[..., None]
        return np.asarray(
            self.centre + np.cos(t) * (self.a * self.x) + np.sin(t) * (self.b * self.y)
        )

    def derivative(self, t: Array) -> Array:
        t = np.asarray(t)[..., None]
        return np.asarray(np.cos(t) * (self.b * self.y) - np.sin(t) * (self.a * self.x))

    def parameter(self, p: Array) -> Array:
        away = p - self.centre
        return self.wrapped(np.arctan2(dot(away, self.y) / self.b, dot(away, self.x) / self.a))

    def bounding_ball(self) -> tuple[Array, float]:
        return self.centre, max(self.a, self.b)
