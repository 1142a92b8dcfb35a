"""What every site of Voronoi surfaces offers: distances, and offsets where they have an equation.

Notation: s is the signed distance, positive outside; e is +1 or -1; d the offset.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass, fields
from typing import ClassVar

import numpy as np

from decomp.carriers import Carrier
from decomp.errors import InputError
from decomp.vectors import Array
from decomp.voronoi.bending import distance_hessian
from decomp.voronoi.exact import Vector, exact, exact_direction, exact_vector
from decomp.voronoi.polynomial import Raw

DIRECTIONS = ("normal", "axis")
POINTS = ("point", "centre", "apex")


class VoronoiSite(ABC):
    """A site; parameters may be given as ints, fractions, strings like "1/3" or floats."""

    @property
    @abstractmethod
    def name(self) -> str:
        """In the field's words."""

    @property
    @abstractmethod
    def reference(self) -> Vector:
        """A point by which the site is placed."""

    @property
    @abstractmethod
    def size(self) -> float:
        """Its largest radius, 0 if it has none."""

    @property
    def two_sided(self) -> bool:
        """Whether it has an inside, so that odd Voronoi surfaces exist."""
        return True

    @abstractmethod
    def signed_distance(self, p: Array) -> Array:
        """Distances (...) of points (..., 3), negative inside."""

    @abstractmethod
    def foot(self, p: Array) -> Array:
        """Nearest points (..., 3) on the site."""

    def gradient(self, p: Array) -> Array:
        """Gradients (..., 3) of the signed distance; zero at points of a site without inside."""
        s = self.signed_distance(p)[..., None]
        away = p - self.foot(p)
        return np.where(s != 0, away / np.where(s != 0, s, 1.0), 0.0)

    @abstractmethod
    def hessian(self, p: Array) -> Array:
        """Second derivatives (..., 3, 3) of the signed distance, off the reflexive locus."""


@dataclass(frozen=True, eq=False)
class CarrierSite(VoronoiSite):
    """A site whose distance is that of a carrier, possibly of radius zero."""

    kind: ClassVar[str]

    def __post_init__(self) -> None:
        for field in fields(self):
            value = getattr(self, field.name)
            what = f"{field.name} of a {self.kind}"
            if field.name in DIRECTIONS:
                value = exact_direction(value, what)
            elif field.name in POINTS:
                value = exact_vector(value, what)
            else:
                value = exact(value, what)
                if value < 0 and field.name in ("radius", "major", "minor"):
                    raise InputError(f"{what} must not be negative, got {value}")
            object.__setattr__(self, field.name, value)

    @property
    def name(self) -> str:
        return self.kind

    @property
    @abstractmethod
    def carrier(self) -> Carrier:
        """The carrier in floating point."""

    @abstractmethod
    def offset(self, e: int) -> Raw:
        """The polynomial in x, y, z, d of the points where s = e d (the paper's Table 1).

        It vanishes too where s, continued through the reflexive locus, is e d: the other nappe
        of a cone, the inner points of a sphere.
        """

    def signed_distance(self, p: Array) -> Array:
        return self.carrier.signed_distance(p)

    def foot(self, p: Array) -> Array:
        return self.carrier.foot(p)

    def gradient(self, p: Array) -> Array:
        return self.carrier.normal(p)

    def hessian(self, p: Array) -> Array:
        return distance_hessian(self.carrier, np.asarray(p, dtype=np.float64))
