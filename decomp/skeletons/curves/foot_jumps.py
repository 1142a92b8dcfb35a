"""Where the far foot of balls over a curve of normals jumps from one place of an edge to another.

A bent edge can be as near in two places. Where a trim crosses a seam at which both are touched the
far contact is the edge before and behind, but the centres have a kink there.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from decomp.curves.circle import Circle
from decomp.curves.line import Line
from decomp.sites.site import SiteKind
from decomp.skeletons.balls.fields import site_fields
from decomp.skeletons.curves.incidence import Incidence
from decomp.skeletons.curves.normal_curves import NormalCurve
from decomp.skeletons.curves.trim_samples import TrimSample
from decomp.vectors import Array, Bools, Ints, norm

JUMP = 1e-5
"""Feet farther apart than this part of the size are not one that has moved on a little."""
LOPSIDED = 3.0
"""A foot that moves so many times as far in one half of an interval as in the other may jump in it;
one that comes to rest or sets out with the root of the way moves 2.4 times as far."""


@dataclass(frozen=True, eq=False)
class Interval:
    """Two samples over a curve of normals, with a change of what is touched between them or none.

    Args:
        curve: number of the curve.
        low, high: the samples.
        beside: how far the far foot moves in the interval's other half, None if it is none.
    """

    curve: int
    low: TrimSample
    high: TrimSample
    beside: float | None = None

    def halves(self, middle: TrimSample) -> tuple[Interval, Interval]:
        """The intervals up to a sample and from it on."""
        before, behind = (float(norm(middle.foot - it.foot)) for it in (self.low, self.high))
        return (
            Interval(self.curve, self.low, middle, behind),
            Interval(self.curve, middle, self.high, before),
        )


def jumping(
    incidence: Incidence, curves: Sequence[NormalCurve], intervals: Sequence[Interval]
) -> Bools:
    """Over which intervals (k,) the far foot may jump from one place of a site to another.

    The foot at one end is followed to the ball at the other one. If it does not come out where that
    ball touches there is another place in between at which the same site is as near. If it does it
    may have been led there where its own place has ceased to be near; so where the foot moves
    farther than the ball, or much farther than in the other half, the halves are looked at.
    Where it moves fast, but does not jump, theirs are not suspect.
    """
    found = np.zeros(len(intervals), dtype=np.bool_)
    rows, which = [], []
    for row, it in enumerate(intervals):
        bent = [site for site in it.low.far if _bent(incidence, site)]
        own = tuple(sorted(curves[it.curve].sites))
        if bent and it.low.far == it.high.far != own:
            rows.append(row)
            which.append(bent[0])
    if not rows:
        return found
    some = [intervals[row] for row in rows]
    numbers = np.array([it.curve for it in some])
    ends = [_balls(curves, numbers, [it.low for it in some])]
    ends.append(_balls(curves, numbers, [it.high for it in some]))
    (low, one), (high, other) = ends
    beside = np.array([np.nan if it.beside is None else LOPSIDED * it.beside for it in some])
    slow = np.where(np.isnan(beside), norm(high - low), beside)
    apart, near = norm(other - one), JUMP * incidence.boundary.diagonal
    suspect = apart > np.maximum(slow, near)
    sites: Ints = np.array(which)
    for (_, start), (centre, foot) in (ends, ends[::-1]):
        moved = site_fields(incidence.context, sites, centre, start).foot
        suspect |= (norm(moved - foot) > near) & (apart > near)
    found[rows] = suspect
    return found


def _bent(incidence: Incidence, number: int) -> bool:
    """Whether a site can be as near in two places: an edge that is bent, but no circle."""
    site = incidence.sites[number]
    if site.kind is not SiteKind.EDGE:
        return False
    return not isinstance(incidence.boundary.edges[site.index].curve, (Line, Circle))


def _balls(
    curves: Sequence[NormalCurve], numbers: Ints, samples: Sequence[TrimSample]
) -> tuple[Array, Array]:
    """The centres (k, 3) and far feet (k, 3) of samples over curves of given numbers (k,)."""
    centres, feet = np.empty((len(samples), 3)), np.array([it.foot for it in samples])
    s, radius = (np.array([getattr(it, name) for it in samples]) for name in ("s", "radius"))
    for k in np.unique(numbers).tolist():
        rows, curve = np.flatnonzero(numbers == k), curves[k]
        centres[rows] = curve.feet(s[rows]) + radius[rows, None] * curve.directions(s[rows])
    return centres, feet
