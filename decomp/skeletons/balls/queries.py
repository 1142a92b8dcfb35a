"""Nearest-site queries for points of one region, with little to do per call.

They answer what `SiteIndex.nearest` answers. Where a carrier has several faces, the face that holds
a foot is the one with the nearest edge (see `sites.crowded`); most are found among few candidates,
the others among many, and only what is still in doubt is left to the index.
"""

from __future__ import annotations

from functools import cached_property
from weakref import WeakKeyDictionary

import numpy as np

from decomp.sites import Nearest, SiteIndex
from decomp.sites.nearest import nearest_in_region
from decomp.sites.occupancy import labels_of, private
from decomp.skeletons.balls.probing import Probe, probe_of
from decomp.vectors import Array, Bools, Ints

FEW, MANY = 8, 64


class RegionQueries:
    """Queries in one region; `size` is its diagonal.

    Args:
        index: of the model.
        region: its number.
    """

    def __init__(self, index: SiteIndex, region: int) -> None:
        part = index.part(region)
        self._part, self._region = part, region
        self._faces = len(part.boundary.faces)
        self._occupancy = private(index.occupancy)
        self.size = part.boundary.diagonal

    @cached_property
    def probe(self) -> Probe:
        """What compiled queries need."""
        part = self._part
        return probe_of(
            self._occupancy,
            part.sites.table,
            part.candidates,
            part.boxes,
            self._region,
            self.size,
        )

    def nearest(self, points: Array) -> Nearest:
        """The nearest site of points (n, 3).

        Where a point is not in this region, `region` and `site` are -1 and `distance` is 0.
        """
        found, which = self._unnamed(points)
        here = np.flatnonzero((found.region == self._region) & (which >= 0))
        found.region[found.region != self._region] = -1
        found.site[here] = self.named(which[here], found.foot[here])
        return found

    def depth(self, points: Array) -> tuple[Bools, Array]:
        """Whether points (n, 3) are in the region, and their distance (n,) from its boundary.

        The distance of points that are not is 0. Nothing is asked about sites, which costs more.
        """
        found, _ = self._unnamed(points)
        inside = found.region == self._region
        return inside, np.where(inside, found.distance, 0.0)

    def _unnamed(self, points: Array) -> tuple[Nearest, Ints]:
        """Nearest points, with candidates (n,) in place of sites."""
        points = np.ascontiguousarray(points, dtype=np.float64)
        n, part = len(points), self._part
        found = Nearest(
            np.full(n, -1, dtype=np.int32),
            np.zeros(n),
            points.copy(),
            np.full(n, -1, dtype=np.int32),
        )
        labels_of(self._occupancy, points, found.region)
        which = np.full(n, -1, dtype=np.int64)
        nearest_in_region(
            self._occupancy,
            part.sites.table,
            part.candidates,
            part.boxes,
            self._region,
            points,
            found.region,
            which,
            found.distance,
            found.foot,
            np.empty(n, dtype=np.int64),
        )
        return found, which

    def named(self, candidates: Ints, feet: Array) -> Ints:
        """The sites (n,) that hold feet (n, 3) on candidates of the region's table (n,)."""
        part = self._part
        site = part.sites.site_of[candidates]
        faces = np.flatnonzero(candidates < self._faces)
        crowded = faces[part.sites.crowded[candidates[faces]] > 0]
        if len(crowded):
            carriers = part.sites.table.face_carriers[candidates[crowded]]
            site[crowded] = part.finder.by_edges(carriers, feet[crowded], (FEW, MANY))
        return part.first + site

    def kinds(self, candidates: Ints) -> Ints:
        """Sites (n,) of candidates (n,), one for all faces of a carrier; -1 stays -1."""
        return np.where(candidates >= 0, self._part.sites.site_of[candidates], -1)


_KNOWN: WeakKeyDictionary[SiteIndex, dict[int, RegionQueries]] = WeakKeyDictionary()


def region_queries(index: SiteIndex, region: int) -> RegionQueries:
    """The queries of a region; made once."""
    known = _KNOWN.setdefault(index, {})
    if region not in known:
        known[region] = RegionQueries(index, region)
    return known[region]
