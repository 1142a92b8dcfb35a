"""Rims of the sheets that a curved reentrant edge has with itself.

A ball can touch an edge at two of its points. The centres of such balls form sheets of the edge
with itself, which end where the two feet run together: at the centres of the edge's osculating
spheres, as far as these are empty. In the edge's footprint such a rim is a curve K' . d = 0, see
`osculation`; over a point at which the edge has a plane of symmetry, K' vanishes, so that the rim
is the whole line of centres of curvature over that point.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np
from scipy.optimize import brentq  # type: ignore[import-untyped]

from decomp.complex.model import LineKind
from decomp.curves.circle import Circle
from decomp.curves.line import Line
from decomp.errors import GeometryError
from decomp.skeletons.balls.balls import inscribed_balls
from decomp.skeletons.balls.fields import site_fields
from decomp.skeletons.curves.contours import chains, contour
from decomp.skeletons.curves.incidence import Incidence
from decomp.skeletons.curves.osculation import Osculation
from decomp.skeletons.curves.pieces import CurvePiece
from decomp.skeletons.curves.rim_curve import RimCurve
from decomp.vectors import Array, Bools, Ints, norm

ALONG, ACROSS = 256, 32
"""Cells along and across an edge's footprint in which rims are looked for."""
SHIFT = 0.37
"""The first cell begins at no round place, where a point of symmetry may be."""
EMPTY = 1e-10
"""A ball is empty if the boundary enters it by less than this part of the size."""
HALVINGS = 12
FLAT = 1e-6
"""Values along a border of the footprint below this part of the greatest count as zero."""
BESIDE = 1e-3
"""How far beside such a border cells end, in parts of the footprint's width."""
RESTING = 1e-7
"""A centre that moves less than this part of the region's size rests."""
SHORTEST = 1e-9
CLOSE = 0.5
"""Spots nearer to each other than this part of a cell's height are one too many."""
NEAR = 0.02
"""A foot nearer to the first one than this part of the radius is about to run together with it."""
KNOWN = 65
"""Spots of a rim that are known at least."""
SAME_SIDE = 1e-12
"""Spots on the same side of two cells differ by rounding."""


def rim_pieces(incidence: Incidence) -> list[CurvePiece]:
    """The rims of all edges of a region.

    Raises:
        GeometryError: a rim's end cannot be found; says where.
    """
    found = []
    for number, site in incidence.edge_site.items():
        edge = incidence.boundary.edges[number]
        if not isinstance(edge.curve, (Line, Circle)):
            found.extend(_EdgeRims(incidence, number, site).pieces())
    return found


def _spread(spots: Array) -> list[int]:
    """The first and last of spots (k, 2), and those between that are not close together."""
    kept = [0]
    for k in range(1, len(spots) - 1):
        near = min(float(norm(spots[k] - spots[j])) for j in (kept[-1], len(spots) - 1))
        if near > CLOSE / ACROSS:
            kept.append(k)
    return [*kept, len(spots) - 1]


class _EdgeRims:
    def __init__(self, incidence: Incidence, number: int, site: int) -> None:
        self._incidence, self._site = incidence, site
        self._size = incidence.boundary.diagonal
        self._edge = incidence.boundary.edges[number]
        self._spheres = Osculation(incidence.boundary, self._edge)
        self._queries = incidence.context.queries

    def pieces(self) -> list[CurvePiece]:
        """All rims of the edge."""
        spots, links = self._contour()
        if not len(spots):
            return []
        on = self._empty(spots)
        beyond: dict[int, list[int]] = {}
        for a, b in links.tolist():
            for one, other in ((a, b), (b, a)):
                if on[one] and not on[other]:
                    beyond.setdefault(one, []).append(other)
        lines = [
            (self._line(spots, chain, closed, beyond), closed)
            for chain, closed in chains(links[on[links].all(axis=1)], len(spots))
            if on[chain[0]]
        ]
        pieces = [self._piece(self._unrolled(line), closed) for line, closed in lines]
        return [piece for piece in pieces if piece is not None]

    def _contour(self) -> tuple[Array, Ints]:
        """Spots (k, 2) of osculating spheres, and links (m, 2) between them, all along the edge."""
        along = (np.arange(ALONG) + SHIFT) / ALONG
        values = self._values(along, self._across)
        if self._edge.closed:
            along = np.concatenate([along, along[:1] + 1])
            values = np.concatenate([values, values[:1]])
        found = contour(values, (along, self._across), self._spheres.miss)
        if not self._edge.closed:
            return found.spots, found.links
        # the sides of the last cells are those of the first
        number = np.arange(len(found.spots))
        for k in np.flatnonzero(found.spots[:, 0] == along[-1]):
            gaps = np.abs(found.spots - [along[0], found.spots[k, 1]]).max(axis=1)
            if gaps.min() < SAME_SIDE:
                number[k] = int(np.argmin(gaps))
        return found.spots, number[found.links]

    @cached_property
    def _across(self) -> Array:
        """Parts of the angle at which the footprint is cut into cells.

        On a border where all spheres osculate, as on that of a sphere's own face, the values have
        no sign. The outermost cells end beside it.
        """
        across = np.linspace(0, 1, ACROSS + 1)
        values = np.abs(self._values((np.arange(ALONG) + SHIFT) / ALONG, across))
        for border, beside in ((0, BESIDE), (-1, 1 - BESIDE)):
            if values[:, border].max() < FLAT * values.max():
                across[border] = beside
        return across

    def _values(self, along: Array, across: Array) -> Array:
        grid = np.stack(np.meshgrid(along, across, indexing="ij"), axis=-1)
        with np.errstate(divide="ignore", invalid="ignore"):
            return self._spheres.miss(grid.reshape(-1, 2)).reshape(grid.shape[:-1])

    def _line(
        self, spots: Array, chain: list[int], closed: bool, beyond: dict[int, list[int]]
    ) -> Array:
        """The spots (n, 2) of a rim, with its ends.

        Args:
            spots: all that are known.
            chain: the numbers of those of the rim.
            closed: whether it is.
            beyond: for the last ones those that follow, over which balls are not empty.
        """
        line = [spots[k] for k in chain]
        if closed:
            return np.array([*line, line[0]])
        ends = list(beyond.get(chain[-1], []))
        starts = ends[:-1] if len(chain) == 1 else list(beyond.get(chain[0], []))
        start, end = (
            [self._end(spot, spots[others[-1]])] if others else self._to_border(spot)
            for spot, others in ((line[0], starts), (line[-1], ends))
        )
        return np.array([*start, *line, *end])

    def _to_border(self, spot: Array) -> list[Array]:
        """The spot of the border next to one at the end of cells that end beside it."""
        for beside, border in ((self._across[0], 0.0), (self._across[-1], 1.0)):
            if spot[1] == beside != border:
                return [np.array([spot[0], border])]
        return []

    def _unrolled(self, spots: Array) -> Array:
        """The same spots without jumps by a period."""
        turns = np.round(np.diff(spots[:, 0], prepend=spots[0, 0])).cumsum()
        return spots - turns[:, None] * [1.0, 0.0] if self._edge.closed else spots

    def _empty(self, spots: Array) -> Bools:
        """Whether the balls of centres of curvature are in the region and empty."""
        _, _, radius, centre = self._spheres.balls(spots)
        inside, reach = self._queries.depth(centre)
        return np.asarray(inside & (reach >= radius - EMPTY * self._size))

    def _between(self, one: Array, other: Array, share: float) -> Array:
        """The spots (k, 2) of the rim over a part of the chords between two of its spots each."""
        apart = other - one
        if self._edge.closed:
            apart[:, 0] -= np.round(apart[:, 0])
        across = np.stack([-apart[:, 1], apart[:, 0]], axis=1) / norm(apart)[:, None]
        return self._spheres.onto(one + share * apart, across)

    def _end(self, inside: Array, outside: Array) -> Array:
        """Where between two spots of a rim a further contact is as near."""
        it, low, high = self._incidence, 0.0, 1.0
        inside, outside = inside[None], outside[None]
        for _ in range(HALVINGS):
            middle = (low + high) / 2
            if self._empty(self._between(inside, outside, middle))[0]:
                low = middle
            else:
                high = middle
        feet, ways, _, _ = self._spheres.balls(self._between(inside, outside, high))
        ball = inscribed_balls(it.context, feet, ways)
        if int(ball.site[0]) < 0 or float(norm(ball.foot - feet)[0]) < NEAR * float(ball.radius[0]):
            name = it.sites[self._site].name
            raise GeometryError(
                f"the rim of the edge {name}'s sheet with itself ends near {{at}} where "
                "more than two feet run together; such ends are not supported",
                (name,),
                at=feet[0],
            )

        def gap(share: float) -> float:
            _, _, radius, centre = self._spheres.balls(self._between(inside, outside, share))
            field = site_fields(it.context, ball.site, centre, ball.foot)
            return float(field.distance[0] - radius[0])

        if gap(low) <= 0:
            return np.asarray(self._between(inside, outside, low)[0])
        return np.asarray(self._between(inside, outside, float(brentq(gap, low, high)))[0])

    def _piece(self, spots: Array, closed: bool) -> CurvePiece | None:
        """A rim over spots (k, 2) in order."""
        spots = self._moving(spots[_spread(spots)])
        if len(spots) < 2 or float(norm(spots[-1] - spots[0])) <= SHORTEST:
            return None
        while len(spots) < KNOWN:
            spots = self._denser(spots)
        feet, _, _, centres = self._spheres.balls(spots)
        if closed:
            centres[-1] = centres[0]
        element = RimCurve(self._spheres, spots, centres)
        pair = (self._site, self._site)
        middle = feet[len(spots) // 2][None]
        return CurvePiece(LineKind.RIM, ((self._site,),), element, centres, middle, pairs=(pair,))

    def _moving(self, spots: Array) -> Array:
        """Spots without those at the ends over which the centre rests.

        An edge of a sphere has the sphere's centre for all of its length.
        """
        centres = self._spheres.balls(spots)[3]
        moves = np.flatnonzero(norm(np.diff(centres, axis=0)) > RESTING * self._size)
        return spots[moves[0] : moves[-1] + 2] if len(moves) else spots[:0]

    def _denser(self, spots: Array) -> Array:
        result = np.empty((2 * len(spots) - 1, 2))
        result[::2], result[1::2] = spots, self._between(spots[:-1], spots[1:], 0.5)
        return result
