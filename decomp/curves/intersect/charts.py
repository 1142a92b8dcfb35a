"""A carrier as a family of isolines: rulings of cylinders and cones, tube circles of a torus.

u is the angle about the axis, v the place on the isoline. The chart is cut open along v = low
and v = high; for the torus these are one and the same seam.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from math import cos, hypot, pi, sin, sqrt
from typing import ClassVar

import numpy as np

from decomp.carriers import Carrier, Cone, Cylinder, EllipticCylinder, Sphere, Torus
from decomp.curves.intersect.result import Window
from decomp.vectors import Array, dot, frame, norm

SKEW = 1e-12
"""Square of the sine of the angle between axes below which they count as parallel."""


@dataclass(frozen=True, eq=False)
class Chart(ABC):
    """Parametrised carrier; v runs over [low, high]."""

    x: Array
    y: Array
    low: float
    high: float

    round: ClassVar[bool]
    """v is an angle, and low is the same as high."""

    @abstractmethod
    def point(self, u: Array, v: Array) -> Array:
        """Points (..., 3)."""

    @abstractmethod
    def metric(self, u: float, v: float) -> tuple[float, float]:
        """Lengths of the derivatives of `point` by u and by v."""


@dataclass(frozen=True, eq=False)
class Rulings(Chart):
    """start + radius e(u) + v (along axis + out e(u)), e(u) = cos u x + sin u y.

    `along` and `out` are scaled so that v is at most 1 in size. x and y are orthonormal, but of an
    elliptic cylinder, whose radius is 1, conjugate semi-diameters of its section.
    """

    start: Array
    axis: Array
    radius: float
    along: float
    out: float

    round: ClassVar[bool] = False

    def point(self, u: Array, v: Array) -> Array:
        e = np.cos(u)[..., None] * self.x + np.sin(u)[..., None] * self.y
        v = np.asarray(v)[..., None]
        rho, height = self.radius + self.out * v, self.along * v
        return np.asarray(self.start + rho * e + height * self.axis)

    def metric(self, u: float, v: float) -> tuple[float, float]:
        around = float(norm(cos(u) * self.y - sin(u) * self.x))
        return abs(self.radius + self.out * v) * around, hypot(self.out, self.along)


@dataclass(frozen=True, eq=False)
class Tubes(Chart):
    """Tube circles of a torus: v is the angle in the tube."""

    torus: Torus

    round: ClassVar[bool] = True

    def point(self, u: Array, v: Array) -> Array:
        return self.torus.point(np.asarray(u), np.asarray(v), self.x, self.y)

    def metric(self, u: float, v: float) -> tuple[float, float]:
        return self.torus.major + self.torus.minor * cos(v), self.torus.minor


def chart_of(a: Carrier, b: Carrier, window: Window, turn: float) -> Chart:
    """Chart of carrier `a` over all that may meet `b` in the window.

    Args:
        a: cylinder, elliptic cylinder, cone or torus.
        b: the other carrier.
        window: where the intersection is wanted.
        turn: angle that sets where the chart is cut; any value will do, unless the cut
            happens to touch the intersection.
    """
    if isinstance(a, Torus):
        x, y = _turned(a.axis, turn)
        return Tubes(x, y, turn, turn + 2 * pi, a)
    if isinstance(a, Cone):
        x, y = _turned(a.axis, turn)
        far = window.reach(a.apex) * (1 + 0.01 * turn)
        if isinstance(b, Sphere | Torus):
            far = min(far, (float(norm(b.centre - a.apex)) + b.width) * (1 + 0.01 * turn))
        return Rulings(x, y, 0.0, 1.0, a.apex, a.axis, 0.0, far * cos(a.angle), far * sin(a.angle))
    assert isinstance(a, Cylinder | EllipticCylinder)
    low, high = _extent(a, b, window)
    start = a.point + (low + high) / 2 * a.axis
    half = (high - low) / 2 * (1 + 0.01 * turn)
    if isinstance(a, Cylinder):
        x, y = _turned(a.axis, turn)
        return Rulings(x, y, -1.0, 1.0, start, a.axis, a.radius, half, 0.0)
    one, two = a.a * a.x, a.b * a.y
    x, y = cos(turn) * one + sin(turn) * two, cos(turn) * two - sin(turn) * one
    return Rulings(x, y, -1.0, 1.0, start, a.axis, 1.0, half, 0.0)


def _turned(axis: Array, turn: float) -> tuple[Array, Array]:
    x, y = frame(axis)
    return cos(turn) * x + sin(turn) * y, cos(turn) * y - sin(turn) * x


def _extent(a: Cylinder | EllipticCylinder, b: Carrier, window: Window) -> tuple[float, float]:
    """Heights on a's axis between which a meets b in the window, with a margin."""
    middle = float(dot(window.centre - a.point, a.axis))
    low, high = middle - 1.01 * window.radius, middle + 1.01 * window.radius
    if isinstance(b, Sphere | Torus):
        centre, size = b.centre, b.width
        at = float(dot(centre - a.point, a.axis))
        size *= 1.05
        return max(low, at - size), min(high, at + size)
    if isinstance(b, Cylinder | EllipticCylinder):
        # distance from axis b of the point at height h on axis a: at most the sum of both widths
        c = float(dot(a.axis, b.axis))
        across = a.axis - c * b.axis
        away = a.point - b.point
        away = away - dot(away, b.axis) * b.axis
        square = float(dot(across, across))
        if square > SKEW:
            at = -float(dot(away, across)) / square
            rest = (1.05 * (a.width + b.width)) ** 2 - float(norm(away + at * across)) ** 2
            if rest > 0:
                half = sqrt(rest / square)
                return max(low, at - half), min(high, at + half)
    return low, high
