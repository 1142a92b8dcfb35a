"""What every curve offers: a parameter t over a finite domain, points, derivatives."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass, field
from typing import ClassVar

import numpy as np

from decomp.shown import Shown
from decomp.vectors import Array


@dataclass(frozen=True, eq=False)
class Curve(ABC, Shown):
    """A smooth curve in space.

    Attributes:
        domain: least and greatest parameter, both finite.
        closed: the parameter is periodic with period domain[1] - domain[0].
    """

    domain: tuple[float, float] = field(init=False)
    closed: bool = field(init=False)

    kind: ClassVar[str]

    @abstractmethod
    def point(self, t: Array) -> Array:
        """Points (..., 3) at parameters t (...)."""

    @abstractmethod
    def derivative(self, t: Array) -> Array:
        """Derivatives (..., 3) of `point` by t."""

    @abstractmethod
    def parameter(self, p: Array) -> Array:
        """Parameters (...) inside the domain of points (..., 3) known to lie on the curve."""

    @abstractmethod
    def bounding_ball(self) -> tuple[Array, float]:
        """Centre and radius of a ball that holds the whole curve."""

    @property
    def period(self) -> float:
        """Length of the domain."""
        return self.domain[1] - self.domain[0]

    def wrapped(self, t: Array) -> Array:
        """Bring parameters into the domain: by the period if closed, else by clipping."""
        low, high = self.domain
        if self.closed:
            return np.asarray(low + np.mod(np.asarray(t) - low, high - low))
        return np.clip(t, low, high)


def hull_ball(curve: Curve) -> tuple[Array, float]:
    """Ball about a convex planar arc: its ends and the point where the end tangents meet.

    The arc lies in the triangle of these three points.
    """
    ends = np.array(curve.domain)
    (p, q), (u, v) = curve.point(ends), curve.derivative(ends)
    # p + s u = q + t v, solved by least squares (exact for a planar arc)
    s = np.linalg.lstsq(np.stack([u, -v], axis=1), q - p, rcond=None)[0][0]
    corners = np.stack([p, q, p + s * u])
    centre = (corners.min(axis=0) + corners.max(axis=0)) / 2
    return centre, float(np.linalg.norm(corners - centre, axis=1).max())
