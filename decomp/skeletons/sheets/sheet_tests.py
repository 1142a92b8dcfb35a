"""Whether points of a footprint, or of a Voronoi surface, belong to the skeleton."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from decomp.sites.site import SiteKind
from decomp.skeletons.balls.balls import Balls, inscribed_balls
from decomp.skeletons.curves.incidence import Incidence
from decomp.skeletons.sheets.sheet_surface import SheetSurface
from decomp.vectors import Array, Bools, Ints, norm

OFF = 1e-6
"""How far off a foot it is asked whether the foot is on the boundary, as a part of the size."""
NEARER = 0.3
"""How far towards a foot it is asked which site has it."""
ASIDE = 1e-3
"""Off a foot the boundary is as far as the step, but for this part of it."""


class SheetTests:
    """Exact queries about the sheets of one region."""

    def __init__(self, incidence: Incidence) -> None:
        self._incidence, self._index = incidence, incidence.context.index
        self._size = incidence.boundary.diagonal

    def name(self, site: int) -> str:
        """Of a site, for messages."""
        return self._incidence.sites[site].name

    def on(self, site: int, feet: Array, inward: Array) -> Bools:
        """Whether feet (k, 3) are on a site, as seen in directions into the region (k, 3)."""
        step = OFF * self._size
        near = self._index.nearest(feet + step * inward)
        on = (near.region == self._incidence.region) & (np.abs(near.distance - step) < ASIDE * step)
        if self._incidence.sites[site].kind is SiteKind.FACE:
            on &= near.site == site
        return np.asarray(on)

    def balls(self, feet: Array, inward: Array) -> Balls:
        return inscribed_balls(self._incidence.context, feet, inward)

    def touches(self, site: int, other: int, feet: Array, inward: Array) -> Bools:
        """Whether feet (k, 3) are on a site and the maximal balls there touch another."""
        result = np.zeros(len(feet), dtype=np.bool_)
        rows = np.flatnonzero(self.on(site, feet, inward))
        if len(rows):
            result[rows] = self.balls(feet[rows], inward[rows]).site == other
        return result

    def mirror(self, site: int, points: Array, mirrored: Callable[[Array], Array]) -> Bools:
        """Whether an edge is nearest to points (k, 3), in two feet that mirror each other."""
        found = self._index.nearest(points)
        good = (found.region == self._incidence.region) & (found.site == site)
        image = mirrored(found.foot)
        apart = norm(image - found.foot) > OFF * self._size
        toward = self._index.nearest(points + NEARER * (image - points))
        touched = (
            np.abs(toward.distance - (1 - NEARER) * found.distance)
            <= self._incidence.boundary.tolerances.same
        )
        return np.asarray(good & apart & touched)

    def in_skeleton(self, pair: tuple[int, int], near: Array, surface: SheetSurface) -> Bools:
        """Whether points near the surface, moved onto it, have both sites as nearest ones."""
        moved, good = surface.try_place(near)
        found = self._index.nearest(moved)
        which: Ints = np.tile(np.array(pair), (len(moved), 1))
        feet = self._incidence.feet(pair, moved)
        reach = norm(moved - feet[:, 0])
        slack = self._incidence.boundary.tolerances.same
        good = good & (found.region == self._incidence.region)
        good &= found.distance >= reach - slack
        for column in (0, 1):
            toward = self._index.nearest(moved + NEARER * (feet[:, column] - moved))
            good &= np.abs(toward.distance - (1 - NEARER) * reach) <= slack
            good &= toward.site == which[:, column]
        return np.asarray(good)
