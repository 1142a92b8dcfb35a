"""Surfaces and curves of sampled skeletons, on which vertices are placed exactly."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from decomp.errors import GeometryError
from decomp.sampled.placing import Placer
from decomp.vectors import Array, Bools, norm


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
        if not len(points):
            return np.array(points)
        placed, good = self.try_place(points)
        if not good.all():
            names = self.placer.names(self.sites)
            raise GeometryError(
                f"a point near {{at}} cannot be moved onto the line of {' and '.join(names)}",
                names,
                at=points[~good][0],
            )
        return placed

    def try_place(self, points: Array) -> tuple[Array, Bools]:
        """Points moved onto the curve (k, 3), and whether that succeeded (k,)."""
        found = self.placer.place(self.sites, points)
        return found.points, found.good


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
        """Move points (k, 3) onto the surface, the shortest way where Newton's method finds it."""
        if not len(points):
            return np.array(points)
        found = self.placer.place_on_normals(self.sites, points)
        if not found.good.all():
            far = ~found.good
            found.points[far] = self.placer.normals.onto(*self.sites, points[far])
        return found.points

    def normal(self, points: Array) -> Array:
        """Unit normals (k, 3)."""
        across = self.placer.normals.off(*self.sites, points)[0][1]
        return np.asarray(self.towards * across / norm(across)[:, None])
