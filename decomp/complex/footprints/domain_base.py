"""What the picture of a site's footprint in the plane offers."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass

from decomp.complex.plane.planar import PLANE, Period
from decomp.vectors import Array

AT_APEX = 1e-8
"""Vertices nearer to a cone's apex than this part of the diagonal are at it."""


@dataclass(frozen=True, eq=False)
class Domain(ABC):
    """A picture of a site's feet and inward directions in the plane.

    Counterclockwise in the plane is counterclockwise seen from the side of the feet, that is from
    outside the region.
    """

    @property
    def period(self) -> Period:
        """Periods of the two coordinates, None where there is none."""
        return PLANE

    @abstractmethod
    def to_plane(self, feet: Array, toward: Array) -> Array:
        """Coordinates (k, 2) of feet (k, 3) on the site with points (k, 3) inside above them."""

    @abstractmethod
    def lift(self, uv: Array) -> tuple[Array, Array]:
        """Feet (k, 3) at coordinates (k, 2), and unit vectors (k, 3) on which centres lie."""
