"""The Voronoi surface of two sites as an element that vertices are placed on exactly."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.spatial import cKDTree  # type: ignore[import-untyped]

from decomp.errors import GeometryError
from decomp.skeletons.balls.equidistance import Equidistant, placed_between
from decomp.skeletons.balls.fields import Field, site_fields
from decomp.skeletons.balls.loci import on_locus
from decomp.skeletons.balls.supports import SEARCHED
from decomp.skeletons.curves.incidence import Incidence
from decomp.skeletons.sheets.sheet_family import CLEAR, SheetFamily, difference
from decomp.vectors import Array, Bools, Ints, norm

STEEP = 1e-3
"""Gradients of two sites that differ by more give the sheet a normal."""


@dataclass(frozen=True, eq=False)
class SheetSurface:
    """Points at equal distance from two sites, near known ones.

    Args:
        incidence: of the region.
        sites: a and b; normals point from a's side to b's.
        points, feet: known points (k, 3) and their feet (k, 2, 3), from which others are found.
    """

    incidence: Incidence
    sites: tuple[int, int]
    points: Array
    feet: Array

    @property
    def family(self) -> Incidence | None:
        """Sheets of one family can be asked for points of all of them at once.

        Those are the sheets of a region whose sites' feet are found without a known one near by.
        """
        return None if self._curved else self.incidence

    @staticmethod
    def of_family(members: Sequence[SheetSurface]) -> SheetFamily:
        """The family that some sheets of one family make."""
        return SheetFamily(members[0].incidence, [member.sites for member in members])

    def place(self, points: Array) -> Array:
        """Move points (k, 3) straight onto the surface.

        Raises:
            GeometryError: Newton's method fails at one of them.
        """
        if not len(points):
            return np.array(points)
        placed, converged = self.try_place(points)
        if not converged.all():
            names = [self.incidence.sites[s].name for s in self.sites]
            raise GeometryError(
                f"a point near {{at}} cannot be moved onto the sheet between {' and '.join(names)}",
                names,
                at=points[~converged][0],
            )
        return placed

    def try_place(self, points: Array) -> tuple[Array, Bools]:
        """Points moved onto the surface (k, 3), and whether that succeeded (k,).

        Beside a seam at which an edge has two feet a point off the surface can be nearer to the one
        that does not count where it is moved to. There the other one is taken, if that one counts
        where it leads to, from the point itself or from where the first one has led to.
        """
        found = self._between(points, self._feet_near(points))
        if self._curved:
            first = np.array(found.points)
            others, replaced = self._nearest(first, found.feet)
            rows = np.flatnonzero(found.converged & replaced)
            for start in (points, first):
                again = self._between(start[rows], others[rows])
                good = again.converged & ~self._nearest(again.points, again.feet)[1]
                found.points[rows[good]] = again.points[good]
                rows = rows[~good]
        return found.points, found.converged

    def _between(self, points: Array, feet: Array) -> Equidistant:
        """Points moved to where they are as near to both sites, found from feet (k, 2, 3)."""
        it = self.incidence
        which: Ints = np.tile(np.array(self.sites), (len(points), 1))
        return placed_between(it.context, which, points, feet)

    def normal(self, points: Array) -> Array:
        """Unit normals (k, 3): the difference of the distances' gradients.

        Where a point is on a site itself (at a vertex in which a reentrant edge ends) the normal
        is that of the known point nearest to it that is not.
        """
        difference = self._difference(points, self._feet_near(points))
        length = norm(difference)
        lost = length <= CLEAR
        if lost.any():
            known = self._difference(self.points, self.feet)
            good = np.flatnonzero(norm(known) > STEEP)
            if not len(good):
                raise GeometryError("the sheet at {at} has no normal", at=points[lost][0])
            nearest = cKDTree(self.points[good]).query(points[lost])[1]
            difference[lost] = known[good[nearest]]
            length = norm(difference)
        return np.asarray(difference / length[:, None])

    def facing(self, points: Array) -> tuple[Array, Array]:
        """How the feet of points (k, 3) on the surface face each other, and how far they are.

        Returns:
            (k,) the angle in radians, from 0 to pi, at which the two feet are seen from the point;
            nan where the point is on a site or has many feet on one; and (k,) the radius.
        """
        it = self.incidence
        one, two = self._fields(points, self._feet_near(points))
        a, b = one.gradient, two.gradient
        angle = 2 * np.arctan2(norm(a - b), norm(a + b))
        lost = (norm(a) < CLEAR) | (norm(b) < CLEAR)
        lost |= on_locus(it.context, self.sites, points, CLEAR)
        return np.where(lost, np.nan, angle), one.distance

    def _difference(self, points: Array, feet: Array) -> Array:
        pairs: Ints = np.tile(np.array(self.sites), (len(points), 1))
        return difference(self.incidence, pairs, self._fields(points, feet))

    def _fields(self, points: Array, feet: Array) -> tuple[Field, Field]:
        it = self.incidence
        one, two = (
            site_fields(
                it.context,
                np.full(len(points), site, dtype=np.int64),
                points,
                feet[:, column],
            )
            for column, site in enumerate(self.sites)
        )
        return one, two

    def _feet_near(self, points: Array) -> Array:
        """Feet (k, 2, 3) from which those of points are found, if a site's foot depends on them.

        They are those of the nearest known point, or the nearest on the whole edge: where a sheet
        lies on both sides of a seam at which an edge has two feet, a known point has only one.
        """
        if not self._curved:
            return np.asarray(self.feet[np.zeros(len(points), dtype=np.int64)])
        return self._nearest(points, self.feet[self._tree.query(points)[1]])[0]

    def _nearest(self, points: Array, feet: Array) -> tuple[Array, Bools]:
        """Feet (k, 2, 3) with those that are not the nearest on their edge replaced, and where.

        At a vertex that both sites share the other one is as near: it does not count.
        """
        it, near = self.incidence, CLEAR * self.incidence.boundary.diagonal
        other = it.feet(self.sites, points)
        found, replaced = np.array(feet), np.zeros(len(points), dtype=np.bool_)
        for column, site in enumerate(self.sites):
            which: Ints = np.full(len(points), site, dtype=np.int64)
            known = site_fields(it.context, which, points, feet[:, column])
            gap = known.distance - norm(points - other[:, column])
            nearer = gap > near
            found[nearer, column] = other[nearer, column]
            replaced |= nearer
        return found, replaced

    @cached_property
    def _curved(self) -> bool:
        """Whether a site is a curve on which feet are searched from known ones."""
        table = self.incidence.context.table
        return bool(np.isin(table.kinds[list(self.sites)], SEARCHED).any())

    @cached_property
    def _tree(self) -> cKDTree:
        return cKDTree(self.points)
