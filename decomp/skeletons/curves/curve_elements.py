"""The curves of the skeleton as elements that vertices are placed on exactly."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import combinations

import numpy as np

from decomp.complex.model import CurveElement
from decomp.errors import GeometryError
from decomp.skeletons.balls.equidistance import Equidistant, equidistant
from decomp.skeletons.balls.supports import SEARCHED
from decomp.skeletons.curves.edge_wells import EdgeWells
from decomp.skeletons.curves.incidence import Incidence
from decomp.skeletons.curves.normal_balls import least_radius, solve_radius, try_radius
from decomp.skeletons.curves.normal_curves import NormalCurve
from decomp.skeletons.curves.reflexive_loci import Locus
from decomp.tolerance import TINY
from decomp.vectors import Array, Bools, Ints, dot, nearest_rows, norm

MERGED = 1e-3
"""Feet on one site nearer than this part of the radius are not told apart."""
LEAST = 0.1
"""Radii along a trim are looked for from this part of the nearest known one at least."""


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
        return place_seams([self], np.zeros(len(points), dtype=np.int64), points)

    def feet_near(self, points: Array) -> Array:
        """The feet (k, m, 3) of known points next to given ones (k, 3).

        Two feet on one site run together with the root of the way to where they meet, and one of
        them is not found from the other's side: they are read off between known points.
        """
        known, feet = self.points[self._apart], self.feet[self._apart]
        rows = self._nearest(known, points)
        if len(known) < 2 or len(set(self.sites)) == len(self.sites):
            return np.asarray(feet[rows])
        found, least = np.array(feet[rows]), np.full(len(points), np.inf)
        for step in (-1, 0):
            first = np.clip(rows + step, 0, len(known) - 2)
            part, off = _on_chord(points, known[first], known[first + 1])
            nearer = off < least
            part = part[:, None, None]
            between = (1 - part) * feet[first] + part * feet[first + 1]
            found[nearer], least[nearer] = between[nearer], off[nearer]
        return found

    def _nearest(self, known: Array, points: Array) -> Ints:
        """The nearest of known points to each of given ones (k, 3).

        The ends of a seam that comes back to its node are one point with other feet: that end is
        taken which has the nearer chord beside it.
        """
        rows = nearest_rows(known, points)
        last = len(known) - 1
        if last < 2 or (known[0] != known[last]).any():
            return rows
        at = np.flatnonzero((rows == 0) | (rows == last))
        _, first = _on_chord(points[at], known[0], known[1])
        _, other = _on_chord(points[at], known[last], known[last - 1])
        rows[at] = np.where(first <= other, 0, last)
        return rows

    def feet_at(self, points: Array) -> Array:
        """The feet (k, m, 3) of points (k, 3) on the seam."""
        it = self.incidence
        which: Ints = np.tile(np.array(self.sites), (len(points), 1))
        return equidistant(it.context, which, points, self.feet_near(points)).feet

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
            raise GeometryError("the seam at {at} has contacts that are one", at=self.points[0])
        return good


def _on_chord(points: Array, start: Array, end: Array) -> tuple[Array, Array]:
    """How far along chords (0 to 1) the nearest places to points (k, 3) are, and how far away."""
    way = end - start
    part = np.clip(dot(points - start, way) / np.maximum(dot(way, way), TINY), 0.0, 1.0)
    return part, norm(points - start - part[:, None] * way)


def place_seams(seams: Sequence[SeamCurve], which: Ints, points: Array) -> Array:
    """Points (k, 3), each moved onto the seam of its number (k,).

    All seams are of one region and have the same number of contacts.

    Raises:
        GeometryError: Newton's method fails at one of the points.
    """
    found = _on_seams(seams, which, points)
    if not found.converged.all():
        bad = points[~found.converged][0]
        raise GeometryError("a point near {at} cannot be moved onto its seam", at=bad)
    return found.points


def _on_seams(seams: Sequence[SeamCurve], which: Ints, points: Array) -> Equidistant:
    """Points moved as far as that succeeds."""
    it = seams[0].incidence
    sites: Ints = np.array([seam.sites for seam in seams])[which]
    feet = np.empty((*sites.shape, 3))
    for number, seam in enumerate(seams):
        rows = np.flatnonzero(which == number)
        feet[rows] = seam.feet_near(points[rows])
    return equidistant(it.context, sites, points, feet)


def gaps_from(curve: CurveElement, points: Array) -> Array:
    """How far (k,) points are from where a curve places them; infinite where it places none.

    A point that cannot be moved onto a curve is not on it.
    """
    if isinstance(curve, SeamCurve):
        found = _on_seams([curve], np.zeros(len(points), dtype=np.int64), points)
        return np.where(found.converged, norm(found.points - points), np.inf)
    if isinstance(curve, TrimCurve):
        moved = curve.try_place(points)
        return np.where(np.isnan(moved).any(axis=1), np.inf, norm(moved - points))
    return norm(curve.place(points) - points)


def place_each(curves: Sequence[CurveElement], which: Ints, points: Array) -> Array:
    """Points (k, 3), each moved onto the curve of its number (k,); seams together.

    Raises:
        GeometryError: a point cannot be moved.
    """
    moved = np.array(points)
    seams: dict[int, dict[int, SeamCurve]] = {}
    for number in np.unique(which).tolist():
        curve = curves[number]
        if isinstance(curve, SeamCurve):
            seams.setdefault(len(curve.sites), {})[number] = curve
        else:
            rows = which == number
            moved[rows] = curve.place(points[rows])
    for members in seams.values():
        numbers = np.array(list(members))
        rows = np.flatnonzero(np.isin(which, numbers))
        local = np.searchsorted(numbers, which[rows])
        moved[rows] = place_seams(list(members.values()), local, points[rows])
    return moved


@dataclass(frozen=True, eq=False)
class TrimCurve:
    """Centres of the balls over a part of a normal curve that touch one far site.

    Args:
        incidence: of the region.
        over: the normal curve.
        start, end: parameters between which the far site is touched. Farther on there may be balls
            that touch the line or carrier that it is a part of.
        far: the far site.
        points, feet: known centres (k, 3) and their far feet (k, 3).
    """

    incidence: Incidence
    over: NormalCurve
    start: float
    end: float
    far: int
    points: Array
    feet: Array

    def place(self, points: Array) -> Array:
        """Move points (k, 3) along the normals' ruled surface onto the trim.

        Raises:
            GeometryError: there is no ball over the place of one of them.
        """
        return self.at(*self._over(points))

    def try_place(self, points: Array) -> Array:
        """The same, nan where there is no ball; points beside the trim move to its ends."""
        s, guess = self._over(points)
        return self._centres(try_radius, self._within(s), guess)

    def at(self, s: Array, guess: Array) -> Array:
        """The centres (k, 3) over parameters (k,), their radii being about `guess`.

        Raises:
            GeometryError: there is no ball over one of them.
        """
        return self._centres(solve_radius, s, guess)

    def _over(self, points: Array) -> tuple[Array, Array]:
        """Parameters (k,) of points and their distances from the feet there."""
        s = self.over.parameter(points)
        # a point far off may even be on the edge; the curve is not there
        known = norm(self.points - self.feet)[nearest_rows(self.points, points)]
        return s, np.maximum(norm(points - self.over.feet(s)), LEAST * known)

    def _within(self, s: Array) -> Array:
        """Parameters (k,) between start and end, the nearer one of both for others."""
        if not self.over.closed:
            return np.clip(s, self.start, self.end)
        period = self.over.end - self.over.start
        middle = (self.start + self.end) / 2
        turned = s - period * np.round((s - middle) / period)
        return np.clip(turned, self.start, self.end)

    def _centres(self, solve: Callable[..., Array], s: Array, guess: Array) -> Array:
        q, n = self.over.feet(s), self.over.directions(s)
        feet = self.feet[nearest_rows(self.points, q + guess[:, None] * n)]
        r = solve(self.incidence, self.over, self.far, s, feet, guess)
        if self._wells is not None:
            r = least_radius(self.incidence, self.over, self.far, self._wells, s, r)
        return np.asarray(q + r[:, None] * n)

    @cached_property
    def _wells(self) -> EdgeWells | None:
        """Of the far site, if it is an edge that can be as near in several places."""
        it = self.incidence
        table = it.context.table
        if table.kinds[self.far] not in SEARCHED:
            return None
        return EdgeWells(it.boundary.edges[it.sites[self.far].index])


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
