"""The curves of the skeleton as elements that vertices are placed on exactly."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import combinations

import numpy as np

from decomp.errors import GeometryError
from decomp.medial.incidence import Incidence
from decomp.medial.normal_curves import NormalCurve
from decomp.medial.reflexive import Locus
from decomp.medial.trims import solve_radius
from decomp.tracing.equidistance import equidistant
from decomp.vectors import Array, Bools, Ints, nearest_rows, norm, place

MERGED = 1e-3
"""Feet on one site nearer than this part of the radius are not told apart."""


@dataclass(frozen=True, eq=False)
class SeamCurve:
    """Points at equal distance from three or more sites.

    Args:
        incidence: of the region.
        sites: one site of each contact.
        points, feet: known points (k, 3) and their feet (k, m, 3), from which others are found.
    """

    incidence: Incidence
    sites: tuple[int, ...]
    points: Array
    feet: Array

    def place(self, points: Array) -> Array:
        """Move points (k, 3) onto the seam.

        Raises:
            GeometryError: Newton's method fails at one of them.
        """
        which: Ints = np.tile(np.array(self.sites), (len(points), 1))
        feet = self.feet[self._apart][nearest_rows(self.points[self._apart], points)]
        found = equidistant(self.incidence.boundary, self.incidence.sites, which, points, feet)
        if not found.converged.all():
            bad = points[~found.converged][0]
            raise GeometryError(f"a point near {place(bad)} cannot be moved onto its seam")
        return found.points

    @cached_property
    def _apart(self) -> Bools:
        """At which known points (k,) the contacts that share a site are two.

        Where they have run together, at an end of the seam, their common foot leads nowhere.
        """
        good = np.ones(len(self.points), dtype=np.bool_)
        for i, j in combinations(range(len(self.sites)), 2):
            if self.sites[i] == self.sites[j]:
                gap = norm(self.feet[:, i] - self.feet[:, j])
                good &= gap > MERGED * norm(self.points - self.feet[:, i])
        if not good.any():
            raise GeometryError(f"the seam at {place(self.points[0])} has contacts that are one")
        return good


@dataclass(frozen=True, eq=False)
class TrimCurve:
    """Centres of the balls over a normal curve that touch one far site.

    Args:
        incidence: of the region.
        over: the normal curve.
        far: the far site.
        points, feet: known centres (k, 3) and their far feet (k, 3).
    """

    incidence: Incidence
    over: NormalCurve
    far: int
    points: Array
    feet: Array

    def place(self, points: Array) -> Array:
        """Move points (k, 3) along the normals' ruled surface onto the trim."""
        s = self.over.parameter(points)
        return self.at(s, norm(points - self.over.feet(s)))

    def at(self, s: Array, guess: Array) -> Array:
        """The centres (k, 3) over parameters (k,), their radii being about `guess`."""
        q, n = self.over.feet(s), self.over.directions(s)
        feet = self.feet[nearest_rows(self.points, q + guess[:, None] * n)]
        r = solve_radius(self.incidence, self.over, self.far, s, feet, guess)
        return np.asarray(q + r[:, None] * n)


@dataclass(frozen=True, eq=False)
class RayCurve:
    """A straight line through `point` along unit `direction`."""

    point: Array
    direction: Array

    def place(self, points: Array) -> Array:
        """Move points (k, 3) to their feet on the line."""
        along = (points - self.point) @ self.direction
        return np.asarray(self.point + along[:, None] * self.direction)


@dataclass(frozen=True, eq=False)
class LocusCurve:
    """A reflexive locus."""

    locus: Locus

    def place(self, points: Array) -> Array:
        """Move points (k, 3) to their feet on the locus."""
        return self.locus.point(self.locus.parameter(points))
