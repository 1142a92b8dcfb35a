"""Circle."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi
from typing import ClassVar

import numpy as np

from decomp.curves.base import Curve
from decomp.vectors import Array, dot


@dataclass(frozen=True, eq=False)
class Circle(Curve):
    """centre + radius (cos t x + sin t y), 0 <= t <= 2 pi, with orthonormal x and y."""

    centre: Array
    x: Array
    y: Array
    radius: float

    kind: ClassVar[str] = "circle"

    def __post_init__(self) -> None:
        object.__setattr__(self, "domain", (0.0, 2 * pi))
        object.__setattr__(self, "closed", True)

    def point(self, t: Array) -> Array:
        t = np.asarray(t)[..., None]
        return np.asarray(self.centre + self.radius * (np.cos(t) * self.x + np.sin(t) * self.y))

    def derivative(self, t: Array) -> Array:
        t = np.asarray(t)[..., None]
        return np.asarray(self.radius * (np.cos(t) * self.y - np.sin(t) * self.x))

    def parameter(self, p: Array) -> Array:
        away = p - self.centre
        return self.wrapped(np.arctan2(dot(away, self.y), dot(away, self.x)))

    def bounding_ball(self) -> tuple[Array, float]:
        return self.centre, self.radius
