"""Arc of one branch of a hyperbola."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import ClassVar

import numpy as np

from decomp.curves.base import Curve, hull_ball
from decomp.vectors import Array, dot


@dataclass(frozen=True, eq=False)
class Hyperbola(Curve):
    """centre + a cosh t x + b sinh t y, with orthonormal x and y: the branch towards x."""

    centre: Array
    x: Array
    y: Array
    a: float
    b: float
    domain: tuple[float, float] = field(default=(-1.0, 1.0), kw_only=True)

    kind: ClassVar[str] = "hyperbola"

    def __post_init__(self) -> None:
        object.__setattr__(self, "closed", False)

    def point(self, t: Array) -> Array:
        t = np.asarray(t)[..., None]
        return np.asarray(
            self.centre + np.cosh(t) * (self.a * self.x) + np.sinh(t) * (self.b * self.y)
        )

    def derivative(self, t: Array) -> Array:
        t = np.asarray(t)[..., None]
        return np.asarray(np.sinh(t) * (self.a * self.x) + np.cosh(t) * (self.b * self.y))

    def parameter(self, p: Array) -> Array:
        return self.wrapped(np.arcsinh(dot(p - self.centre, self.y) / self.b))

    def bounding_ball(self) -> tuple[Array, float]:
        return hull_ball(self)
