"""Trim curves: the centres of the maximal balls over a curve of boundary normals.

Along a normal curve the ball's far contact changes at certain parameters: with a jump of the far
foot where the trim crosses a seam, without one where the far foot passes to a neighbouring site.
Between two changes lies one piece of trim.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from decomp.boundary.topology import Convexity
from decomp.errors import GeometryError
from decomp.sites.site import SiteKind
from decomp.skeletons.balls import loci
from decomp.skeletons.balls.balls import inscribed_balls
from decomp.skeletons.balls.fields import site_fields
from decomp.skeletons.balls.loci import locus_gap
from decomp.skeletons.curves.foot_jumps import JUMP, Interval, jumping
from decomp.skeletons.curves.incidence import NEAR, Incidence
from decomp.skeletons.curves.locus_touches import touches
from decomp.skeletons.curves.normal_balls import try_radius
from decomp.skeletons.curves.normal_curves import NormalCurve
from decomp.skeletons.curves.trim_changes import change
from decomp.skeletons.curves.trim_samples import (
    Contact,
    TrimSample,
    one_of,
    ties,
    without_passing_ties,
    without_ties,
)
from decomp.vectors import Array, Bools, Ints, norm

SAMPLES = 96
NEAREST_END = 1e-5
"""First sample beside the end of a normal curve, as a part of its length."""
BESIDE_END = 11
"""So many samples are close to each end."""
NO_LENGTH = 1e-8
"""Pieces shorter than this part of their normal curve are points."""
SHORT, TOUCHES = 1e-2, 1e-10
"""A stretch of the curve shorter than the first part of it whose contact is as near as another, to
the second part of the size, is a point in which the two are equally near."""
HALVINGS = 60
CREPT, RUN_TOGETHER = 1e-7, 1e-3
"""Contacts nearer to each other than this part of the size have run together if they are as near
measured by the ball too: close to a convex vertex balls are small."""
LOCUS = 1e-8
"""Centres nearer to a reflexive locus than this part of the size lie on it."""
ONE_PLACE = 1e-15
"""Parameters that differ by less than this part of them differ by rounding."""


@dataclass(frozen=True, eq=False)
class TrimPiece:
    """A part of a trim curve with one far contact.

    Args:
        over: the normal curve.
        start, end: its parameters.
        far: the far contact's sites; the piece lies on a reflexive locus if they are those of
            the near one (the ball's centre is a centre of curvature).
        far_feet: the far feet (2, 3) beside start and end, to search them from.
    """

    over: NormalCurve
    start: float
    end: float
    far: Contact
    far_feet: Array


class TrimScanner:
    """Finds the pieces of all trims of one region."""

    def __init__(self, incidence: Incidence) -> None:
        self._incidence = incidence
        self._size = incidence.boundary.diagonal

    def pieces(self, curves: Sequence[NormalCurve]) -> list[list[TrimPiece]]:
        """The pieces over each of some normal curves, in their order."""
        samples = self._at(curves, [_first(curve) for curve in curves])
        for curve, found in zip(curves, samples, strict=True):
            if curve.closed:
                found.append(replace(found[0], s=curve.end))
            else:
                _continue_to_ends(found)
        cuts = self._changes(curves, samples)
        result = []
        for c, known, every in zip(curves, samples, cuts, strict=True):
            own, longest = tuple(sorted(c.sites)), SHORT * (c.end - c.start)
            clear = without_passing_ties(known, every, own, c.closed, longest)
            cut = self._without_touches(c, known, clear)
            bounds = [self._change(c, low, high) for low, high in cut]
            whole = self._between(c, known, cut, bounds)
            result.append([part for piece in whole for part in self._turning(piece, known)])
        return result

    def _without_touches(
        self,
        curve: NormalCurve,
        samples: list[TrimSample],
        cuts: list[tuple[TrimSample, TrimSample]],
    ) -> list[tuple[TrimSample, TrimSample]]:
        """Changes of the far contact, without those to one that is as near in one point only.

        There its distance is least; what rounding and tolerances make of that point is a short
        stretch between two changes, there and back. Where a closed curve starts in such a stretch
        its first and last samples are given the contact beside it.
        """
        cuts = list(cuts)
        k = 0 if curve.closed else 1
        while k < len(cuts) and len(cuts) > 1:
            (before, one), (other, after) = cuts[k - 1], cuts[k]
            if before.far == after.far and self._only_touches(curve, before, one, other):
                if k == 0:
                    samples[0] = replace(samples[0], far=after.far, foot=after.foot)
                    samples[-1] = replace(samples[-1], far=before.far, foot=before.foot)
                del cuts[k], cuts[k - 1]
                k = max(k - 1, 0 if curve.closed else 1)
            else:
                k += 1
        return cuts

    def _only_touches(
        self, curve: NormalCurve, before: TrimSample, one: TrimSample, other: TrimSample
    ) -> bool:
        """Whether the contact of a stretch from `one` to `other` is nowhere nearer than another."""
        period = curve.end - curve.start
        length = (other.s - one.s) % period if curve.closed else other.s - one.s
        own = tuple(sorted(curve.sites))
        if length > SHORT * period or own in (before.far, one.far):
            return False
        s = one.s + length * np.linspace(0.0, 1.0, 5)
        q, n = curve.feet(s), curve.directions(s)
        incidence = self._incidence
        balls = inscribed_balls(incidence.context, q, n)
        feet = np.repeat(before.foot[None], len(s), axis=0)
        radius = try_radius(incidence, curve, before.far[0], s, feet, balls.radius)
        return bool(np.abs(radius - balls.radius).max() <= TOUCHES * self._size)

    def _turning(self, piece: TrimPiece, samples: list[TrimSample]) -> list[TrimPiece]:
        """The parts of a piece between the places where it turns back at a reflexive locus."""
        curve, incidence = piece.over, self._incidence
        if piece.far == tuple(sorted(curve.sites)):
            return [piece]
        known = np.array([x.s for x in samples])
        if curve.closed:
            period = curve.end - curve.start
            known = np.unique(np.concatenate([known - period, known, known + period]))
        known = known[(known > piece.start) & (known < piece.end)]

        def gap(s: Array) -> Array:
            q, n = curve.feet(s), curve.directions(s)
            balls = inscribed_balls(incidence.context, q, n)
            return locus_gap(incidence.context, curve.touching, balls.centre)

        stops = touches(self._size, known, gap)
        if len(stops) == 1 and curve.closed and piece.end - piece.start == period:
            # one cusp leaves a loop, which is cut once more where it starts
            piece = replace(piece, start=stops[0], end=stops[0] + period)
            stops = [stops[0] + period / 2]
        bounds = [piece.start, *stops, piece.end]
        return [replace(piece, start=a, end=b) for a, b in pairwise(bounds)]

    def _between(
        self,
        curve: NormalCurve,
        samples: list[TrimSample],
        cuts: list[tuple[TrimSample, TrimSample]],
        bounds: list[float],
    ) -> list[TrimPiece]:
        first, last = samples[0], samples[-1]
        if not cuts:
            feet = np.array([first.foot, last.foot])
            return [TrimPiece(curve, curve.start, curve.end, first.far, feet)]
        pieces = []
        starts = [first, *(high for _, high in cuts)]
        ends = [*(low for low, _ in cuts), last]
        edges = [curve.start, *bounds, curve.end]
        for k, (a, b) in enumerate(zip(starts, ends, strict=True)):
            feet = np.array([a.foot, b.foot])
            pieces.append(TrimPiece(curve, edges[k], edges[k + 1], a.far, feet))
        period = curve.end - curve.start
        if curve.closed:
            # the parameter's own start is no end of a piece, however close to a change it is
            head, tail = pieces[0], pieces.pop()
            feet = np.array([tail.far_feet[0], head.far_feet[1]])
            pieces[0] = TrimPiece(curve, tail.start - period, head.end, head.far, feet)
        # several changes in one point leave pieces without length
        return [piece for piece in pieces if piece.end - piece.start > NO_LENGTH * period]

    def _at(
        self, curves: Sequence[NormalCurve], parameters: Sequence[Array]
    ) -> list[list[TrimSample]]:
        """The samples over each of some normal curves at parameters of its own."""
        if not curves:
            return []
        both = list(zip(curves, parameters, strict=True))
        feet = np.concatenate([curve.feet(s) for curve, s in both])
        inward = np.concatenate([curve.directions(s) for curve, s in both])
        near = np.repeat([sorted(c.sites) for c in curves], [len(s) for s in parameters], axis=0)
        incidence = self._incidence
        balls = inscribed_balls(incidence.context, feet, inward)
        # the foot that stopped the ball is that of its last centre but one
        known = np.flatnonzero(balls.site >= 0)
        field = site_fields(
            incidence.context, balls.site[known], balls.centre[known], balls.foot[known]
        )
        hits = np.array(balls.foot)
        hits[known] = field.foot
        alone = self._alone(balls.site, hits)
        crept = np.minimum(CREPT * self._size, RUN_TOGETHER * balls.radius)
        own = (balls.site < 0) | (norm(hits - feet) <= crept)
        stops = np.cumsum([0, *(len(s) for s in parameters)]).tolist()
        for curve, (a, b) in zip(curves, pairwise(stops), strict=True):
            own[a:b] |= on_locus(incidence, curve.touching, balls.centre[a:b])
            own[a:b] |= self._past_locus(curve.sites, feet[a:b], balls.radius[a:b])
        away = balls.centre - hits
        length = norm(away)
        found: list[TrimSample] = []
        for k, s in enumerate(np.concatenate(parameters).tolist()):
            site = int(balls.site[k])
            if own[k]:
                far: Contact = (int(near[k, 0]), int(near[k, 1]))
            elif alone[k]:
                far = (site,)
            else:
                far = incidence.touched(site, hits[k], away[k] / length[k])
            found.append(TrimSample(s, far, site, hits[k], float(balls.radius[k])))
        return [found[a:b] for a, b in pairwise(stops)]

    def _past_locus(self, which: Sequence[int], feet: Array, radius: Array) -> Bools:
        """Whether balls reach a locus, even where they come to rest a little late."""
        return loci.past_locus(self._incidence.context, which, feet, radius, LOCUS)

    def _alone(self, site: Ints, feet: Array) -> Bools:
        """Whether feet (k, 3) on sites (k,) are on faces and clearly on none of their bends."""
        incidence = self._incidence
        boundary, slack = incidence.boundary, 2 * NEAR * self._size
        result = np.zeros(len(site), dtype=np.bool_)
        for number in np.unique(site[site >= 0]).tolist():
            it = incidence.sites[number]
            if it.kind is not SiteKind.FACE:
                continue
            rows = np.flatnonzero(site == number)
            edges = [boundary.edges[e] for e in incidence.edges_of_face[it.index]]
            bends = [edge for edge in edges if edge.convexity is not Convexity.CONVEX]
            clear = np.ones(len(rows), dtype=np.bool_)
            for pair in {edge.carriers for edge in bends}:
                gaps = [np.abs(boundary.carriers[c].signed_distance(feet[rows])) for c in pair]
                clear &= np.maximum(*gaps) > slack
            for vertex in {v for edge in edges for v in edge.vertices or ()}:
                clear &= norm(boundary.vertices[vertex].point - feet[rows]) > slack
            result[rows] = clear
        return result

    def _changes(
        self, curves: Sequence[NormalCurve], samples: Sequence[Sequence[TrimSample]]
    ) -> list[list[tuple[TrimSample, TrimSample]]]:
        """For each curve the narrowest intervals in which the far contact or its place changes."""
        found: list[list[tuple[TrimSample, TrimSample]]] = [[] for _ in curves]
        rows = [without_ties(row) for row in samples]
        wide = [Interval(k, a, b) for k, row in enumerate(rows) for a, b in pairwise(row)]
        for depth in range(HALVINGS + 1):
            changing = self._changing(curves, wide)
            wide = []
            halved = []
            for it in changing:
                a, b = it.low, it.high
                if depth == HALVINGS or b.s - a.s <= ONE_PLACE * (abs(a.s) + abs(b.s)):
                    found[it.curve].append((a, b))
                else:
                    halved.append(it)
            for it, middle in zip(halved, self._middles(curves, halved), strict=True):
                a, b = it.low, it.high
                if not ties(a, middle, b):
                    wide += it.halves(middle)
                    continue
                one = one_of(a, middle, b)
                if one is None:
                    found[it.curve].append((a, b))
                elif a.far == b.far:
                    wide += it.halves(one)
                else:
                    wide.append(it.halves(one)[one.far == a.far])
        for pairs in found:
            pairs.sort(key=lambda pair: pair[0].s)
        return found

    def _changing(
        self, curves: Sequence[NormalCurve], intervals: Sequence[Interval]
    ) -> list[Interval]:
        """Those intervals in which the far contact, or its place, may change."""
        jumps = jumping(self._incidence, curves, intervals).tolist()
        return [
            it
            for it, jump in zip(intervals, jumps, strict=True)
            if jump or it.low.far != it.high.far
        ]

    def _middles(
        self, curves: Sequence[NormalCurve], intervals: Sequence[Interval]
    ) -> list[TrimSample]:
        """The samples in the middle of intervals, in their order."""
        middle: dict[int, list[float]] = {}
        place_of = []
        for it in intervals:
            listed = middle.setdefault(it.curve, [])
            place_of.append((it.curve, len(listed)))
            listed.append((it.low.s + it.high.s) / 2)
        rows = self._at([curves[k] for k in middle], [np.array(s) for s in middle.values()])
        at = dict(zip(middle, rows, strict=True))
        return [at[k][i] for k, i in place_of]

    def _change(self, curve: NormalCurve, low: TrimSample, high: TrimSample) -> float:
        """The exact parameter at which the far contact changes from `low` to `high`."""
        own = tuple(sorted(curve.sites))
        jumps = float(norm(low.foot - high.foot)) > JUMP * self._size
        if jumps and own not in (low.far, high.far):
            return self._crossing(curve, low, high)
        return (low.s + high.s) / 2

    def _crossing(self, curve: NormalCurve, low: TrimSample, high: TrimSample) -> float:
        """Where both far contacts are equally near."""
        one, two = low.far[0], high.far[0]
        feet = np.array([low.foot]), np.array([high.foot])

        def gap(s: float) -> float:
            at = np.array([s])
            r = try_radius(self._incidence, curve, one, at, feet[0], np.array([low.radius]))
            p = curve.feet(at) + r[:, None] * curve.directions(at)
            return float(self._distance(two, p, feet[1])[0] - r[0])

        found = change(gap, low.s, high.s, curve.end - curve.start, self._size)
        if not np.isfinite(found):
            foot = curve.feet(np.array([low.s]))[0]
            raise GeometryError("the maximal ball at the boundary point {at} is not found", at=foot)
        return found

    def _distance(self, site: int, points: Array, feet: Array) -> Array:
        which = np.full(len(points), site, dtype=np.int64)
        it = self._incidence
        return site_fields(it.context, which, points, feet).distance


def on_locus(incidence: Incidence, sites: Sequence[int], points: Array) -> Bools:
    """Whether points (k, 3) are on the reflexive locus of one of some sites."""
    return loci.on_locus(incidence.context, sites, points, LOCUS)


def _continue_to_ends(samples: list[TrimSample]) -> None:
    """Give samples beside a curve's ends the contact of those farther in if they have its site.

    Where a curve ends in a place at which more is touched, this is as near beside the end but for
    the square of the way to it.
    """
    for order in (range(BESIDE_END - 1, -1, -1), range(-BESIDE_END, 0)):
        for k in order:
            inner = samples[k + 1] if order.step < 0 else samples[k - 1]
            if samples[k].site == inner.site and inner.site in inner.far:
                samples[k] = replace(samples[k], far=inner.far)


def _first(curve: NormalCurve) -> Array:
    """The parameters of the first samples over a normal curve."""
    inner = np.linspace(0, 1, SAMPLES + 1)[1:-1]
    near = np.geomspace(NEAREST_END, inner[0], BESIDE_END + 1)[:-1]
    parts = (
        np.concatenate([[0.0], inner])
        if curve.closed
        else np.concatenate([near, inner, 1 - near[::-1]])
    )
    return np.asarray(curve.start + (curve.end - curve.start) * parts)
