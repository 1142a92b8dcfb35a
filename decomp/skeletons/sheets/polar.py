"""A periodic domain drawn around the point in which a sheet meets a reflexive locus.

The maximal ball there touches the carrier all around, so in the carrier's own footprint the one
point would be a whole line.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from decomp.complex.footprints.domains import Domain
from decomp.complex.plane.planar import PLANE, Period
from decomp.vectors import Array, Bools, norm

LEVEL = 1e-6
"""Coordinates that differ by less than this part of their range are one."""


@dataclass(frozen=True, eq=False)
class Polar(Domain):
    """The line of a periodic domain at one value of its other coordinate, drawn as the origin.

    Args:
        whole: the domain.
        around: which of its coordinates is periodic.
        start: the other one's value at the origin.
        side: +1 if it grows away from the origin, else -1.
    """

    whole: Domain
    around: int
    start: float
    side: float

    @property
    def period(self) -> Period:
        return PLANE

    @property
    def _turn(self) -> float:
        """Radians for one unit of the periodic coordinate."""
        length = self.whole.period[self.around]
        assert length is not None
        return 2 * np.pi / length

    def to_plane(self, feet: Array, toward: Array) -> Array:
        uv = self.whole.to_plane(feet, toward)
        angle = self._turn * uv[:, self.around]
        away = np.maximum(self.side * (uv[:, 1 - self.around] - self.start), 0.0)
        return np.stack([away * np.cos(angle), away * np.sin(angle)], axis=1)

    def lift(self, uv: Array) -> tuple[Array, Array]:
        inner = np.empty(uv.shape)
        inner[:, self.around] = np.arctan2(uv[:, 1], uv[:, 0]) / self._turn
        inner[:, 1 - self.around] = self.start + self.side * norm(uv)
        return self.whole.lift(inner)


def around_locus(domain: Domain, uv: Array, on_locus: Bools) -> Domain:
    """The domain drawn around those of points (k, 2) that are on the carrier's locus.

    The domain itself where it is not periodic in one coordinate alone, or where these points are
    not at one value of the other one, with all others on one side.
    """
    periodic = [k for k, period in enumerate(domain.period) if period is not None]
    if len(periodic) != 1 or not on_locus.any() or on_locus.all():
        return domain
    along = uv[:, 1 - periodic[0]]
    start = float(along[on_locus].mean())
    others = along[~on_locus] - start
    slack = LEVEL * float(np.ptp(along))
    if np.ptp(along[on_locus]) > slack:
        return domain
    if (others > slack).all():
        return Polar(domain, periodic[0], start, 1.0)
    if (others < -slack).all():
        return Polar(domain, periodic[0], start, -1.0)
    return domain
