"""The surface of the points that are as near to one edge at two of its places.

Where the two places run together the surface ends, in a rim. It is continued by its tangent planes
there, which are at right angles to the edge, so that points beside the rim can be measured.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from decomp.errors import GeometryError
from decomp.skeletons.balls.fields import site_fields
from decomp.skeletons.curves.edge_wells import EdgeWells
from decomp.skeletons.curves.incidence import Incidence
from decomp.skeletons.curves.rim_curve import RimCurve
from decomp.tolerance import CONVERGED, TINY
from decomp.vectors import Array, Bools, Ints, dot, norm

MERGED = 1e-6
"""Feet nearer to each other than this part of the size have run together."""
STEPS = 60
ASIDE = 1.0
"""How much a way from a known point counts beside the distance from its feet."""
BLOCK = 1024
REST = 4e-16
"""Differences of distances, as parts of the size, at which it is stopped, and that are good."""


@dataclass(frozen=True, eq=False)
class SelfSheetSurface:
    """Points at equal distance from two places of an edge, near known ones.

    Args:
        incidence: of the region.
        site: the edge.
        wells: of the edge.
        points: known points (k, 3) inside the sheet.
        feet: parameters (k, 2) of their feet; the normal points from the first to the second.
        rims: of the sheet.
    """

    incidence: Incidence
    site: int
    wells: EdgeWells
    points: Array
    feet: Array
    rims: tuple[RimCurve, ...]

    def place(self, points: Array) -> Array:
        """Move points (k, 3) straight onto the surface.

        Raises:
            GeometryError: a point cannot be moved; says where.
        """
        placed, good = self.try_place(points)
        if not good.all():
            name = self.incidence.sites[self.site].name
            raise GeometryError(
                "a point near {at} cannot be moved onto the sheet that the "
                f"edge {name} has with itself",
                at=points[~good][0],
            )
        return placed

    def try_place(self, points: Array) -> tuple[Array, Bools]:
        """Points moved onto the surface (k, 3), and whether that succeeded (k,)."""
        moved, good, merged = self._balanced(points)
        alone = np.flatnonzero(~good & merged)
        if len(alone) and len(self.rims):
            feet = self._feet(points[alone], self._known(points[alone]))[0][:, 0]
            on, ways = self._on_rims(points[alone], feet)
            moved[alone] = points[alone] - dot(points[alone] - on, ways)[:, None] * ways
            good[alone] = True
            # off the sheet, a point can have one foot though it is not beyond the rim
            again, found, _ = self._balanced(moved[alone])
            moved[alone[found]] = again[found]
        return moved, good

    def _balanced(self, points: Array) -> tuple[Array, Bools, Bools]:
        """Points moved to where both feet are as far, whether they are, and whether feet merged.

        Newton's method on the difference of both distances; close to a reflexive locus feet move
        fast, so that steps can lead too far: they are shortened.
        """
        count = len(points)
        moved, known, rows = np.array(points), self._known(points), np.arange(count)
        best, scale, step = np.full(count, np.inf), np.ones(count), np.zeros_like(moved)
        merged = np.zeros(count, dtype=np.bool_)
        for _ in range(STEPS):
            tried = moved[rows] + scale[rows, None] * step[rows]
            feet, apart = self._feet(tried, known[rows])
            away = tried[:, None] - feet
            distance = np.maximum(norm(away), TINY)
            gap = distance[:, 0] - distance[:, 1]
            better = apart & (np.abs(gap) < best[rows])
            merged[rows[~apart]] = True
            kept = rows[better]
            ways = away[better] / distance[better][..., None]
            gradient = ways[:, 0] - ways[:, 1]
            square = np.maximum(dot(gradient, gradient), TINY)
            moved[kept], best[kept] = tried[better], np.abs(gap[better])
            step[kept] = -(gap[better] / square)[:, None] * gradient
            scale[kept] = 1.0
            scale[rows[~better]] /= 4
            done = (best <= REST * self._size) | (norm(step) * scale <= REST * self._size)
            rows = rows[~done[rows]]
            if not len(rows):
                break
        return moved, np.asarray(best <= CONVERGED * self._size), merged

    def normal(self, points: Array) -> Array:
        """Unit normals (k, 3), from the first foot to the second."""
        known = self._known(points)
        feet, apart = self._feet(points, known)
        across = feet[:, 1] - feet[:, 0]
        rows = np.flatnonzero(~apart)
        if len(rows):
            if not len(self.rims):
                raise GeometryError("the sheet at {at} has no normal", at=points[rows[0]])
            sense = np.sign(self.wells.gap(self.feet[known[rows], 0], self.feet[known[rows], 1]))
            across[rows] = sense[:, None] * self._on_rims(points[rows], feet[rows, 0])[1]
        return np.asarray(across / norm(across)[:, None])

    def _on_rims(self, points: Array, feet: Array) -> tuple[Array, Array]:
        """The nearest points (k, 3) of the rims, and the edge's unit tangents over them.

        Rims that are close to each other are told apart by the feet (k, 3) of the points.
        """
        gaps = [
            (norm(points[:, None] - rim.points) + norm(feet[:, None] - rim.feet)).min(axis=1)
            for rim in self.rims
        ]
        which = np.argmin(gaps, axis=0)
        on, ways = np.empty_like(points), np.empty_like(points)
        for k in np.unique(which):
            rows = which == k
            on[rows], ways[rows] = self.rims[k].nearest(points[rows])
        return on, ways

    def _feet(self, points: Array, known: Ints) -> tuple[Array, Bools]:
        """Both feet (k, 2, 3) of points, from those of known ones, and whether they are two."""
        basins = self._basins[known]
        chosen = np.stack([self.wells.deepest(points, basins[:, side]) for side in (0, 1)], axis=1)
        starts = self.wells.points[chosen]
        which: Ints = np.full(2 * len(points), self.site, dtype=np.int64)
        it = self.incidence
        flat, twice = starts.reshape(-1, 3), np.repeat(points, 2, axis=0)
        feet = site_fields(it.context, which, twice, flat).foot
        # where the edge keeps its distance over a long way Newton's method leaves the place
        lost = np.flatnonzero(norm(feet - flat) > self.wells.apart)
        if len(lost):
            curve = it.boundary.edges[it.sites[self.site].index].curve
            bottom = self.wells.bottom(twice[lost], chosen.reshape(-1)[lost])
            feet[lost] = curve.point(curve.wrapped(bottom))
        feet = feet.reshape(-1, 2, 3)
        apart = (chosen[:, 0] != chosen[:, 1]) & (
            norm(feet[:, 0] - feet[:, 1]) > MERGED * self._size
        )
        return feet, apart

    def _known(self, points: Array) -> Ints:
        """The known point (k,) whose feet are nearest to each of points.

        The nearest known point itself does not serve where two parts of the sheet are close.
        """
        curve = self.incidence.boundary.edges[self.incidence.sites[self.site].index].curve
        feet = curve.point(curve.wrapped(self.feet))
        found = np.empty(len(points), dtype=np.int64)
        for start in range(0, len(points), BLOCK):
            block = points[start : start + BLOCK, None]
            reach = np.maximum(norm(block - feet[:, 0]), norm(block - feet[:, 1]))
            aside = ASIDE * norm(block - self.points)
            found[start : start + BLOCK] = np.argmin(reach + aside, axis=1)
        return found

    @cached_property
    def _basins(self) -> Ints:
        """For each known point the ranges (k, 2, 2) of samples in which its feet are nearest."""
        both = [self.wells.basins(self.points, self.feet[:, side]) for side in (0, 1)]
        return np.stack(both, axis=1)

    @property
    def _size(self) -> float:
        return self.incidence.boundary.diagonal
