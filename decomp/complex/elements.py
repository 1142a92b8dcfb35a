"""Carriers and edges as the surfaces and curves of a complex."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from decomp.carriers import Carrier
from decomp.curves.base import Curve
from decomp.vectors import Array


@dataclass(frozen=True, eq=False)
class CarrierSurface:
    """A carrier as a surface of a complex.

    Args:
        carrier: the surface.
        sign: +1 if normals are the carrier's outward normals, -1 if they are the opposite ones.
    """

    carrier: Carrier
    sign: int

    def place(self, points: Array) -> Array:
        return self.carrier.project(points)

    def normal(self, points: Array) -> Array:
        return np.asarray(self.sign * self.carrier.normal(points))


@dataclass(frozen=True, eq=False)
class EdgeCurve:
    """The curve of an edge as a curve of a complex.

    Args:
        curve: untrimmed.
    """

    curve: Curve

    def place(self, points: Array) -> Array:
        return self.curve.point(self.curve.parameter(points))
