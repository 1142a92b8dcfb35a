"""Where two seams meet between their ends: they touch in a point, or cross unnoticed.

Seams that border one sheet have two contacts in common. Where they meet, the ball has the contacts
of both. Along either the other's own contact comes down to the ball: to second order if they touch,
so that it is as near in that point only. If it dips below, it is nearer on a short stretch that a
step has led across, and the seams end on both sides of it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from decomp.skeletons.balls.contacts import ContactFinder
from decomp.skeletons.balls.equidistance import equidistant
from decomp.skeletons.balls.fields import site_fields
from decomp.skeletons.balls.region_context import RegionContext
from decomp.skeletons.seams.minima import least_values
from decomp.skeletons.seams.seam_graph_model import SeamRun
from decomp.vectors import Array, Ints, norm

CLOSE = 0.05
"""Other contacts are looked at more closely where they are nearer than this part of the size."""
APART = 0.1
"""Feet on one site are of different contacts if they are farther apart than this part of the
radius."""
STEP = 1e-3
"""Step, as a part of a chord, by which it is seen how a contact comes down to the ball."""
RESOLUTION, BESIDE = 1e-11, 1e-3
"""How exactly a meeting is placed, and how far it must be from the ends, in parts of a chord."""


@dataclass(frozen=True, eq=False)
class Meeting:
    """Where two seams meet.

    Args:
        point: (3,) at equal distance from the contacts of both.
        dip: how much nearer the other's contact comes beside it, a length.
    """

    point: Array
    dip: float


class SeamMeetings:
    """Finds where seams of one region meet.

    Args:
        context: of the region.
    """

    def __init__(self, context: RegionContext) -> None:
        self._context, self._boundary = context, context.boundary
        self._finder = ContactFinder(context)

    def of(self, runs: Sequence[SeamRun]) -> list[Meeting]:
        """The meetings of some seams' parts between their ends, each told along one of the two."""
        by_pair: dict[tuple[int, int], list[int]] = {}
        for number, run in enumerate(runs):
            for pair in combinations(sorted(set(run.sites)), 2):
                by_pair.setdefault(pair, []).append(number)
        pairs = {both for group in by_pair.values() for both in combinations(group, 2)}
        boxes = [_box(run) for run in runs]
        found = []
        for i, j in sorted(pairs):
            (low, high), (other_low, other_high) = boxes[i], boxes[j]
            if (low <= other_high).all() and (other_low <= high).all():
                found += self._along(runs[i], runs[j])
        return found

    def _along(self, run: SeamRun, other: SeamRun) -> list[Meeting]:
        own = self._own_contact(run, other)
        if own is None or len(run.points) < 3:
            return []
        site, foot = own
        values = self._gaps(run.sites[0], site, foot, run.points, run.feet)
        near = np.abs(values)
        lowest = (near[1:-1] <= near[:-2]) & (near[1:-1] <= near[2:])
        # where both are as near all along, the seams run side by side and do not meet
        lowest &= np.minimum(values[:-2], values[2:]) > self._boundary.tolerances.same
        rows = np.flatnonzero(lowest & (near[1:-1] < CLOSE * self._boundary.diagonal)) + 1
        if not len(rows):
            return []

        def gaps(which: Ints, share: Array) -> Array:
            return self._gaps(run.sites[0], site, foot, *self._at(run, rows[which], share))

        share, least = least_values(
            lambda which, share: np.abs(gaps(which, share)),
            np.zeros(len(rows)),
            np.full(len(rows), 2.0),
            RESOLUTION,
        )
        # what is left of the gap would be so in the node, and is not by rounding
        inside = (share > BESIDE) & (share < 2 - BESIDE)
        inside &= least <= self._boundary.tolerances.converged
        found = []
        for k in np.flatnonzero(inside & (least <= self._boundary.tolerances.touching)).tolist():
            which: Ints = np.array([k])
            point = self._at(run, rows[which], share[which])[0][0]
            touched = self._finder.at(point, self._boundary.tolerances.touching)
            if any(site in sharing for sharing in touched.sites):
                row: Ints = np.full(3, k)
                around = gaps(row, share[k] + np.array([-STEP, 0.0, STEP]))
                dip = _dip(*around.tolist())
                if np.isfinite(dip):
                    found.append(Meeting(point, dip))
        return found

    def _own_contact(self, run: SeamRun, other: SeamRun) -> tuple[int, Array] | None:
        """The site and foot (3,) that another seam has beside two contacts of one, None if none.

        It is seen at the point of the one that is nearest to the other.
        """
        gaps = norm(run.points[:, None] - other.points[None])
        row, column = np.unravel_index(int(gaps.argmin()), gaps.shape)
        point, which = run.points[row], np.array(other.sites)
        points = np.repeat(point[None], len(which), axis=0)
        feet = site_fields(self._context, which, points, other.feet[column]).foot
        radius = float(norm(point - run.feet[row, 0]))
        apart = norm(feet[:, None] - run.feet[row][None]) > APART * radius
        same = which[:, None] == np.array(run.sites)[None]
        new = np.flatnonzero((apart | ~same).all(axis=1))
        return (other.sites[new[0]], feet[new[0]]) if len(new) == 1 else None

    def _at(self, run: SeamRun, rows: Ints, share: Array) -> tuple[Array, Array]:
        """Points (k, 3) of a seam and their feet, from the points before rows (0) to behind (2)."""
        first = rows - (share < 1)
        part = np.where(share < 1, share, share - 1)
        points = run.points[first] + part[:, None] * (run.points[first + 1] - run.points[first])
        feet = run.feet[first] + part[:, None, None] * (run.feet[first + 1] - run.feet[first])
        which: Ints = np.tile(np.array(run.sites), (len(points), 1))
        found = equidistant(self._context, which, points, feet)
        return np.where(found.converged[:, None], found.points, np.nan), found.feet

    def _gaps(self, own: int, other: int, foot: Array, points: Array, feet: Array) -> Array:
        """How much farther (k,) points are from another site than from their own feet."""
        which: Ints = np.full(len(points), own, dtype=np.int64)
        radius = site_fields(self._context, which, points, feet[:, 0]).distance
        which = np.full(len(points), other, dtype=np.int64)
        known = np.repeat(foot[None], len(points), axis=0)
        gaps = site_fields(self._context, which, points, known).distance - radius
        return np.where(np.isfinite(gaps), gaps, np.inf)


def _box(run: SeamRun) -> tuple[Array, Array]:
    """A box that holds a seam, one chord beyond its points."""
    slack = norm(np.diff(run.points, axis=0)).max(initial=0.0)
    return run.points.min(axis=0) - slack, run.points.max(axis=0) + slack


def _dip(before: float, here: float, after: float) -> float:
    """How far a parabola through three values at equal steps goes below the middle one.

    Infinite if it has no least value.
    """
    slope, bend = (after - before) / 2, before - 2 * here + after
    return float(slope**2 / (2 * bend)) if bend > 0 else np.inf
