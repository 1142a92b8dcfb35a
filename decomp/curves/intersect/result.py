"""What `intersect` returns, and small helpers to build it."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from decomp.curves.base import Curve
from decomp.curves.line import Line
from decomp.vectors import Array, dot, norm

ROUNDING_ERROR = 1e-13
"""Deviations below this part of the size are rounding errors."""

NO_POINTS: Array = np.empty((0, 3))


@dataclass(frozen=True, eq=False)
class PairCurve:
    """One curve of an intersection.

    Attributes:
        curve: the curve.
        tangent: the carriers touch along the whole curve.
    """

    curve: Curve
    tangent: bool = False


@dataclass(frozen=True, eq=False)
class Intersection:
    """All of the intersection of two carriers.

    Attributes:
        curves: they cover the intersection, each part once.
        contacts: isolated common points (m, 3).
        nodes: singular points (m, 3) of the curves: branches cross there, or meet at a cone's
            apex.
    """

    curves: tuple[PairCurve, ...] = ()
    contacts: Array = field(default_factory=lambda: NO_POINTS)
    nodes: Array = field(default_factory=lambda: NO_POINTS)


@dataclass(frozen=True)
class Window:
    """The ball in which the intersection is wanted, and the length that counts as zero."""

    centre: Array
    radius: float
    tolerance: float

    @property
    def exact(self) -> float:
        """Lengths that are rounding errors."""
        return ROUNDING_ERROR * (self.radius + float(np.abs(self.centre).max()))

    def reach(self, p: Array) -> float:
        """Distance from p to the far side of the ball."""
        return float(norm(p - self.centre)) + self.radius


def points(rows: list[Array]) -> Array:
    """Stack points into (m, 3)."""
    return np.array(rows, dtype=np.float64).reshape(len(rows), 3)


def clipped_line(p: Array, d: Array, window: Window) -> Line | None:
    """The part of a line inside the window, with its middle as origin."""
    origin = p + float(dot(window.centre - p, d)) * d
    square = window.radius**2 - float(dot(window.centre - origin, window.centre - origin))
    if square <= 0:
        return None
    half = float(np.sqrt(square))
    return Line(origin, d, domain=(-half, half))


def ray(apex: Array, d: Array, window: Window) -> Line | None:
    """The part of a ray from `apex` up to where it leaves the window."""
    along = float(dot(window.centre - apex, d))
    away = window.centre - apex
    square = window.radius**2 - float(dot(away, away)) + along**2
    if square <= 0:
        return None
    half = float(np.sqrt(square))
    if along + half <= 0:
        return None
    return Line(apex, d, domain=(max(0.0, along - half), along + half))


def inside(curve: Curve, window: Window) -> bool:
    """Whether some of the curve may be in the window, by balls about 64 pieces of it."""
    t = np.linspace(*curve.domain, 65)
    p = curve.point(t)
    chords = norm(np.diff(p, axis=0))
    gap = norm(p - window.centre)
    # an arc between two points that turns by less than a right angle is at most 1.12 chords long
    return bool(np.any(gap[1:] + gap[:-1] <= 2 * window.radius + 1.2 * chords))
