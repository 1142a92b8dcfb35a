"""Points at equal distance from sets of sites, some of which take over from one another.

Where a face and its own reentrant edge are both as near, their feet are one: the point lies on the
normal of the face at its foot on the edge (a trim), and the difference of the distances, which
vanishes to second order, is replaced by the point's distance from that plane of normals.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations, pairwise

import numpy as np

from decomp.sampled.normals import TIGHT, Normals
from decomp.sites.site import SiteKind
from decomp.skeletons.balls.fields import site_fields
from decomp.skeletons.balls.loci import on_locus
from decomp.skeletons.balls.queries import RegionQueries
from decomp.skeletons.curves.incidence import Incidence
from decomp.tolerance import TINY
from decomp.vectors import Array, Bools, Ints, norm

PLACING_STEPS = 30
PLACED_EXACTLY = 2e-14
"""Newton's method ends when all constraints hold to this part of the size."""
PLACED_WELL = 2e-13
"""Points at which they hold to this part of the size are placed."""
GRADIENT_RANK = 1e-7
"""Gradients that differ by less than this are equal."""
SITE_NEARER = 1e-10
"""A site that is nearer, or takes over from another, by this part of the size is nearer."""
CHANGES = 3
"""So often it is asked which sites take over from one another."""
AT_BOUNDARY = 1e-9
"""Points nearer to the boundary than this part of the size are on it."""
OFF_AXIS = 0.1
"""A point nearer to a face's axis than this part of the radius has no foot of its own on it."""
FEET_APART = 0.5
"""Feet farther apart than this part of the radius are two, though a normal at each leads there."""


@dataclass(frozen=True, eq=False)
class Placed:
    """Points brought to where their sites are equally near.

    Args:
        points: (k, 3).
        radius: (k,) their distance from the sites.
        good: (k,) whether that succeeded.
    """

    points: Array
    radius: Array
    good: Bools


class Placer:
    """Places points of one region.

    Args:
        incidence, queries: of the region.
    """

    def __init__(self, incidence: Incidence, queries: RegionQueries) -> None:
        self._it = incidence
        self._queries = queries
        self._size = incidence.boundary.diagonal
        self.normals = Normals(incidence, queries)

    def is_face(self, site: int) -> bool:
        """Whether a site is a face."""
        return self._it.sites[site].kind is SiteKind.FACE

    def between(self, sites: tuple[int, ...], point: Array) -> int:
        """The edge at which two of some sites meet that is nearest to a point (3,), -1 for none."""
        edges = {
            site
            for edge, site in self._it.edge_site.items()
            if sum(self._it.face_site[f] in sites for f in self._it.boundary.edges[edge].faces) > 1
        }
        left = sorted(edges - set(sites))
        if not left:
            return -1
        away = norm(self._it.feet(left, point[None])[0] - point)
        return left[int(np.argmin(away))]

    def contacts(
        self, sites: tuple[int, ...], point: Array | None = None, within: float = TIGHT
    ) -> list[set[int]]:
        """Sites that share a foot, together.

        Args:
            sites: of one point.
            point: (3,) that is as near to all; without it all are together that can be.
            within: radians by which the way to it may be off the normals.
        """
        count = len(sites)
        if point is None:
            linked = np.zeros((count, count), dtype=np.bool_)
            for i, j in combinations(range(count), 2):
                linked[i, j] = linked[j, i] = self.normals.takes_over(sites[i], sites[j])
            return [{sites[i] for i in own} for own in _joined(linked)]
        linked = self.normals.linked(sites, point, within)
        groups = _joined(linked)
        return [
            {sites[i] for i in own} for each in groups for own in self._parted(sites, each, point)
        ]

    def _parted(self, sites: tuple[int, ...], group: list[int], point: Array) -> list[list[int]]:
        """Columns of sites that take over from one another, parted where their feet are apart.

        A round face whose axis holds the point has no foot of its own, and may link others' feet.
        """
        if len(group) < 3:
            return [group]
        own = [sites[i] for i in group]
        feet = self._it.feet(own, point[None])[0]
        free = [on_locus(self._it.context, [s], point[None], OFF_AXIS)[0] for s in own]
        radius = float(norm(feet - point).min())
        result: list[list[int]] = []
        for column, foot, loose in zip(group, feet, free, strict=True):
            if loose:
                continue
            for other in result:
                at = feet[group.index(other[0])]
                if float(norm(foot - at)) <= FEET_APART * radius:
                    other.append(column)
                    break
            else:
                result.append([column])
        left = [column for column, loose in zip(group, free, strict=True) if loose]
        if not result:
            return [group]
        result[0] += left
        return result

    def place(self, sites: tuple[int, ...], points: Array) -> Placed:
        """Move points (k, 3) the shortest way to where all of some sites are equally near."""
        points = np.asarray(points)
        result = Placed(np.array(points), np.zeros(len(points)), np.zeros(len(points), np.bool_))
        before: Ints = np.full(len(points), -1, dtype=np.int64)
        for _ in range(CHANGES):
            # on the way it can turn out that one site takes over from another, or does not
            codes = self.normals.pattern(sites, result.points)
            for code in np.unique(codes[codes != before]):
                rows = np.flatnonzero((codes == code) & (codes != before))
                links = self._links(sites, int(code), result.points[rows[0]])
                found = self._placed(sites, result.points[rows], links)
                result.points[rows], result.radius[rows] = found.points, found.radius
                result.good[rows] = found.good
            if (codes == before).all():
                break
            before = codes
        return result

    def holds(self, point: Array, radius: float, pair: tuple[int, int], sheet: bool) -> bool:
        """Whether a point (3,) of some radius lies on the sheet, or trim surface, of two sites."""
        off = 0.0
        for site in pair:
            feet = self._it.feet([site], point[None])[:, 0]
            distance = float(self._field(site, point[None], feet)[0][0])
            off = max(off, abs(distance - radius))
        if off > PLACED_WELL * self._size:
            return False
        flat = radius <= AT_BOUNDARY * self._size
        if sheet or flat:
            return True
        on = self.normals.takes_over(*pair)
        return on and float(self.normals.slant(*pair, point[None])[0]) <= TIGHT

    def meetings(self, sites: tuple[int, ...], point: Array, reach: float) -> Array:
        """Points (k, 3) near one (3,) at which three of some sites meet and no other is nearer."""
        found = []
        for own in combinations(sites, 3):
            placed = self.place(own, point[None])
            if placed.good[0] and float(norm(placed.points[0] - point)) <= reach:
                away = float(self._queries.nearest(placed.points).distance[0])
                if abs(away - float(placed.radius[0])) <= SITE_NEARER * self._size:
                    found.append(placed.points[0])
        return np.array(found).reshape(-1, 3)

    def place_on_normals(self, sites: tuple[int, int], points: Array) -> Placed:
        """Move points (k, 3) to where one of two sites takes over from the other."""
        return self._placed(sites, np.asarray(points), [(0, 1, True)])

    def _placed(
        self, sites: tuple[int, ...], points: Array, links: list[tuple[int, int, bool]]
    ) -> Placed:
        x = np.array(points)
        feet = self._it.feet(sites, x)
        best, worst = np.array(x), np.full(len(x), np.inf)
        for _ in range(PLACING_STEPS):
            value, slope = self._constraints(sites, links, x, feet)
            off = np.abs(value).max(axis=1)
            off[~np.isfinite(off)] = np.inf
            better = off < worst
            best[better], worst[better] = x[better], off[better]
            if (worst <= PLACED_EXACTLY * self._size).all():
                break
            finite = np.isfinite(value).all(axis=1) & np.isfinite(slope).all(axis=(1, 2))
            step = np.zeros_like(x)
            inverse = np.linalg.pinv(slope[finite], rcond=GRADIENT_RANK)
            step[finite] = -np.einsum("kij,kj->ki", inverse, value[finite])
            length = norm(step)
            most = 0.25 * self._size
            step *= np.minimum(1.0, most / np.maximum(length, TINY))[:, None]
            x = x + step
        radius = self._field(sites[0], best, feet[:, 0])[0]
        return Placed(best, radius, worst <= PLACED_WELL * self._size)

    def names(self, sites: tuple[int, ...]) -> list[str]:
        """What sites are called in messages."""
        return [self._it.sites[site].name for site in sites]

    def _links(
        self, sites: tuple[int, ...], code: int, point: Array
    ) -> list[tuple[int, int, bool]]:
        """Pairs of columns that tie all sites together, and whether one takes over."""
        pairs = list(combinations(range(len(sites)), 2))
        links = [(i, j, True) for bit, (i, j) in enumerate(pairs) if code >> bit & 1]
        linked = np.zeros((len(sites), len(sites)), dtype=np.bool_)
        for i, j, _ in links:
            linked[i, j] = linked[j, i] = True
        groups = [own for each in _joined(linked) for own in self._parted(sites, each, point)]
        return links + [(one[0], two[0], False) for one, two in pairwise(groups)]

    def _constraints(
        self,
        sites: tuple[int, ...],
        links: list[tuple[int, int, bool]],
        x: Array,
        feet: Array,
    ) -> tuple[Array, Array]:
        """Values (k, c) and gradients (k, c, 3); feet (k, m, 3) are brought up to date."""
        fields = []
        for column, site in enumerate(sites):
            distance, gradient, foot = self._field(site, x, feet[:, column])
            feet[:, column] = foot
            fields.append((distance, gradient))
        values, slopes = [], []
        for i, j, trim in links:
            if not trim:
                values.append(fields[i][0] - fields[j][0])
                slopes.append(fields[i][1] - fields[j][1])
                continue
            for value, slope in self.normals.off(sites[i], sites[j], x):
                values.append(value)
                slopes.append(slope)
        return np.stack(values, axis=1), np.stack(slopes, axis=1)

    def _field(self, site: int, x: Array, feet: Array) -> tuple[Array, Array, Array]:
        which = np.full(len(x), site, dtype=np.int64)
        found = site_fields(self._it.context, which, x, feet)
        return found.distance, found.gradient, found.foot


def _joined(linked: Bools) -> list[list[int]]:
    """Columns that links (m, m) join, directly or not."""
    left, found = list(range(len(linked))), []
    while left:
        own = [left.pop(0)]
        for column in own:
            more = [k for k in left if linked[column, k]]
            left = [k for k in left if k not in more]
            own += more
        found.append(sorted(own))
    return found
