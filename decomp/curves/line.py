"""Straight segment."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import ClassVar

import numpy as np

from decomp.curves.base import Curve
from decomp.vectors import Array, dot


@dataclass(frozen=True, eq=False)
class Line(Curve):
    """origin + t direction, with a unit direction: t is arc length."""

    origin: Array
    direction: Array
    domain: tuple[float, float] = field(default=(-1.0, 1.0), kw_only=True)

    kind: ClassVar[str] = "line"

    def __post_init__(self) -> None:
        object.__setattr__(self, "closed", False)

    def point(self, t: Array) -> Array:
        return np.asarray(self.origin + np.asarray(t)[..., None] * self.direction)

    def derivative(self, t: Array) -> Array:
        return np.array(np.broadcast_to(self.direction, (*np.shape(t), 3)))

    def parameter(self, p: Array) -> Array:
        return self.wrapped(dot(p - self.origin, self.direction))

    def bounding_ball(self) -> tuple[Array, float]:
        low, high = self.domain
        return self.point(np.array((low + high) / 2)), (high - low) / 2
