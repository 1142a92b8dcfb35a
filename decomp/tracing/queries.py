"""Nearest-site queries for points of one region, with little to do per call.

They answer what `SiteIndex.nearest` answers. Where a carrier has several faces, the face that holds
a foot is the one with the nearest edge (see `sites.crowded`); most are found among few candidates,
the others among many, and only what is still in doubt is left to the index.
"""

from __future__ import annotations

from weakref import WeakKeyDictionary

import numpy as np

from decomp.sites import Nearest, SiteIndex
from decomp.sites.crowded import SEVERAL
from decomp.sites.crowded import _EdgeBalls as EdgeBalls
from decomp.sites.nearest import nearest_in_region
from decomp.sites.occupancy import labels_of, private
from decomp.tracing.probing import Probe, probe_of
from decomp.vectors import Array, Bools, Ints

FEW, MANY = 8, 64


class RegionQueries:
    """Queries in one region; `size` is its diagonal.

    Args:
        index: of the model.
        region: its number.
    """

    def __init__(self, index: SiteIndex, region: int) -> None:
        part = index._part(region)
        self._part, self._region = part, region
        self._faces = len(part.boundary.faces)
        self._occupancy = private(index.occupancy)
        self.size = part.boundary.diagonal

    @property
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
        found, which, slots = self._unnamed(points)
        here = np.flatnonzero((found.region == self._region) & (which >= 0))
        found.region[found.region != self._region] = -1
        found.site[here] = self.named(which[here], found.foot[here], slots[here])
        return found

    def depth(self, points: Array) -> tuple[Bools, Array]:
        """Whether points (n, 3) are in the region, and their distance (n,) from its boundary.

        The distance of points that are not is 0. Nothing is asked about sites, which costs more.
        """
        found, _, _ = self._unnamed(points)
        inside = found.region == self._region
        return inside, np.where(inside, found.distance, 0.0)

    def _unnamed(self, points: Array) -> tuple[Nearest, Ints, Ints]:
        """Nearest points, with candidates (n,) and slots (n,) in place of sites."""
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
        slots = np.empty(n, dtype=np.int64)
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
            slots,
        )
        return found, which, slots

    def named(self, candidates: Ints, feet: Array, slots: Ints | None = None) -> Ints:
        """The sites (n,) that hold feet (n, 3) on candidates of the region's table (n,)."""
        part = self._part
        site = part.sites.site_of[candidates]
        faces = np.flatnonzero(candidates < self._faces)
        crowded = faces[part.sites.crowded[candidates[faces]] > 0]
        if len(crowded):
            site[crowded] = self._owners(
                part.sites.table.face_carriers[candidates[crowded]],
                feet[crowded],
                None if slots is None else slots[crowded],
            )
        return part.first + site

    def kinds(self, candidates: Ints) -> Ints:
        """Sites (n,) of candidates (n,), one for all faces of a carrier; -1 stays -1."""
        return np.where(candidates >= 0, self._part.sites.site_of[candidates], -1)

    def _owners(self, carriers: Ints, feet: Array, slots: Ints | None) -> Ints:
        finder = self._part.finder
        owner = np.full(len(feet), SEVERAL, dtype=np.int64)
        for count in (FEW, MANY):
            left = owner == SEVERAL
            for carrier in np.unique(carriers[left]):
                rows = np.flatnonzero(left & (carriers == carrier))
                edges = finder._edges_on(int(carrier))
                owner[rows] = _owners(edges, feet[rows], count)
        left = np.flatnonzero(owner == SEVERAL)
        if len(left):
            for carrier in np.unique(carriers[left]):
                rows = left[carriers[left] == carrier]
                owner[rows] = finder._lookup(self._region, int(carrier), feet[rows])
        return owner


def _owners(edges: EdgeBalls, points: Array, count: int) -> Ints:
    """The face whose edge is nearest to each point (n, 3), SEVERAL where that is not certain."""
    centres, radii, faces = edges.centres, edges.radii, edges.faces
    count = min(count, len(faces))
    gaps, near = centres.query(points, k=np.arange(1, count + 1))
    reach = gaps + radii[near]
    row, first = np.arange(len(points)), reach.argmin(axis=1)
    bound, owner = reach[row, first], faces[near[row, first]]
    rivals: Bools = (faces[near] != owner[:, None]) & (gaps - radii[near] <= bound[:, None])
    certain = ~rivals.any(axis=1)
    if count < len(faces):
        certain &= gaps[:, -1] - radii.max() > bound
    return np.where(certain, owner, SEVERAL)


_KNOWN: WeakKeyDictionary[SiteIndex, dict[int, RegionQueries]] = WeakKeyDictionary()


def region_queries(index: SiteIndex, region: int) -> RegionQueries:
    """The queries of a region; made once."""
    known = _KNOWN.setdefault(index, {})
    if region not in known:
        known[region] = RegionQueries(index, region)
    return known[region]
