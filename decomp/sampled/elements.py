"""Surfaces and curves of sampled skeletons, on which vertices are placed exactly."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from decomp.errors import GeometryError
from decomp.sampled.placing import Placer
from decomp.vectors import Array, norm


@dataclass(frozen=True, eq=False)
class PlacedCurve:
    """Points at equal distance from three or more sites.

    Args:
        placer: of the region.
        sites: all that are as near.
    """

    placer: Placer
    sites: tuple[int, ...]

    def place(self, points: Array) -> Array:
        """Move points (k, 3) onto the curve.

        Raises:
            GeometryError: Newton's method fails at one of them.
        """
        return _placed(self.placer, self.sites, points, "line")


@dataclass(frozen=True, eq=False)
class NormalsSurface:
    """The normals of a face along its reentrant edge: a trim surface.

    Args:
        placer: of the region.
        sites: an edge or vertex, and what it takes over from.
        towards: +1 if normals point to the side of the second site, -1 to that of the first.
    """

    placer: Placer
    sites: tuple[int, int]
    towards: float

    def place(self, points: Array) -> Array:
        """Move points (k, 3) onto the surface.

        Raises:
            GeometryError: Newton's method fails at one of them.
        """
        return _placed(self.placer, self.sites, points, "trim surface")

    def normal(self, points: Array) -> Array:
        """Unit normals (k, 3)."""
        across = self.placer.across(self.sites, points)
        return np.asarray(self.towards * across / norm(across)[:, None])


def _placed(placer: Placer, sites: tuple[int, ...], points: Array, what: str) -> Array:
    if not len(points):
        return np.array(points)
    found = placer.place(sites, points)
    if not found.good.all():
        names = placer.names(sites)
        raise GeometryError(
            f"a point near {{at}} cannot be moved onto the {what} of {' and '.join(names)}",
            names,
            at=points[~found.good][0],
        )
    return found.points
