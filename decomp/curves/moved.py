"""A curve in other coordinates, computed in its own ones."""

from __future__ import annotations

from copy import copy
from dataclasses import dataclass

import numpy as np

from decomp.curves.base import Curve
from decomp.curves.circle import Circle
from decomp.curves.ellipse import Ellipse
from decomp.curves.hyperbola import Hyperbola
from decomp.curves.line import Line
from decomp.curves.parabola import Parabola
from decomp.vectors import Array

PLACES: dict[type[Curve], str] = {
    Line: "origin",
    Circle: "centre",
    Ellipse: "centre",
    Hyperbola: "centre",
    Parabola: "vertex",
}
"""The field of a closed form that says where it is."""


@dataclass(frozen=True, eq=False)
class MovedCurve(Curve):
    """`curve` moved by `offset` (3,), with the same parameter."""

    curve: Curve
    offset: Array

    def __post_init__(self) -> None:
        for name in ("domain", "closed", "kind"):
            object.__setattr__(self, name, getattr(self.curve, name))

    def point(self, t: Array) -> Array:
        return np.asarray(self.curve.point(t) + self.offset)

    def derivative(self, t: Array) -> Array:
        return self.curve.derivative(t)

    def parameter(self, p: Array) -> Array:
        return self.curve.parameter(p - self.offset)

    def bounding_ball(self) -> tuple[Array, float]:
        centre, radius = self.curve.bounding_ball()
        return centre + self.offset, radius


def moved_curve(curve: Curve, offset: Array) -> Curve:
    """A curve moved by `offset` (3,): a closed form as one, others as `MovedCurve`."""
    field = PLACES.get(type(curve))
    if field is None:
        return MovedCurve(curve, offset)
    result = copy(curve)
    object.__setattr__(result, field, getattr(curve, field) + offset)
    return result
