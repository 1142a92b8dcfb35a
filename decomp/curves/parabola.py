"""Arc of a parabola."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import ClassVar

import numpy as np

from decomp.curves.base import Curve, hull_ball
from decomp.vectors import Array, dot


@dataclass(frozen=True, eq=False)
class Parabola(Curve):
    """vertex + t^2/(4 focal) x + t y, with orthonormal x (the axis) and y."""

    vertex: Array
    x: Array
    y: Array
    focal: float
    domain: tuple[float, float] = field(default=(-1.0, 1.0), kw_only=True)

    kind: ClassVar[str] = "parabola"

    def __post_init__(self) -> None:
        object.__setattr__(self, "closed", False)

    def point(self, t: Array) -> Array:
        t = np.asarray(t)[..., None]
        return np.asarray(self.vertex + t**2 / (4 * self.focal) * self.x + t * self.y)

    def derivative(self, t: Array) -> Array:
        t = np.asarray(t)[..., None]
        return np.asarray(t / (2 * self.focal) * self.x + self.y)

    def parameter(self, p: Array) -> Array:
        return self.wrapped(dot(p - self.vertex, self.y))

    def bounding_ball(self) -> tuple[Array, float]:
        return hull_ball(self)
