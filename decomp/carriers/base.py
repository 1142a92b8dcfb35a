"""What every carrier (untrimmed boundary surface) offers.

Notation: p is any point, q a point on the carrier, n the outward unit normal (gradient of the
signed distance). Points come as arrays of shape (..., 3), results have the leading shape.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from decomp.similarity import Similarity
from decomp.vectors import Array


@dataclass(frozen=True, eq=False)
class Carrier(ABC):
    """An untrimmed surface with an inside, where the signed distance is negative."""

    kind: ClassVar[str]
    code: ClassVar[int]
    degree: ClassVar[int]

    @abstractmethod
    def signed_distance(self, p: Array) -> Array:
        """Euclidean distance to the carrier, negative inside."""

    @abstractmethod
    def foot(self, p: Array) -> Array:
        """The nearest point of the carrier (any one of them on its reflexive locus)."""

    @abstractmethod
    def normal(self, q: Array) -> Array:
        """Outward unit normal at points on (or near) the carrier."""

    @abstractmethod
    def implicit(self, p: Array) -> Array:
        """A polynomial of degree `degree` in p that vanishes on the carrier.

        It is scaled so that its gradient at the carrier has length about 1.
        """

    @abstractmethod
    def normal_curvature(self, q: Array, direction: Array) -> Array:
        """Curvature of the carrier at q along unit tangent `direction`.

        It is the second derivative of the signed distance: positive where the surface bends
        away from its outward normal, 1/r on a sphere.
        """

    @abstractmethod
    def transformed(self, by: Similarity) -> Carrier:
        """The image under a similarity, with the image of the inside as its inside."""

    @abstractmethod
    def coincides(self, other: Carrier, tolerance: float, reach: float) -> int:
        """Tell whether two carriers are one surface.

        Args:
            other: another carrier of any kind.
            tolerance: lengths below this count as zero.
            reach: how far from the carriers' reference points they matter; angles are
                compared by the deviation that they cause at this distance.

        Returns:
            +1 same surface and same inside, -1 same surface and opposite inside, 0 different.
        """

    @abstractmethod
    def features(self, reach: float) -> Array:
        """Return numbers (k,) by which to look up coinciding carriers: equal for equal surfaces.

        Lengths are given in units of `reach`.
        """

    @abstractmethod
    def packed(self) -> Array:
        """Return the parameters as 8 numbers for compiled kernels.

        point or centre or apex (3), axis or normal (3), two numbers by kind: sphere and
        cylinder (radius, 0), cone (sine, cosine of the half-angle), torus (major, minor).
        """

    def project(self, p: Array, steps: int = 2) -> Array:
        """Return the foot, corrected until it is on the carrier to rounding."""
        q = self.foot(p)
        for _ in range(steps):
            q = q - self.signed_distance(q)[..., None] * self.normal(q)
        return q


def pack(point: Array, axis: Array, a: float = 0.0, b: float = 0.0) -> Array:
    """Lay out the parameters of a carrier for `Carrier.packed`."""
    return np.concatenate([point, axis, [a, b]])
