"""Where two contacts of a seam run together in the middle of one site, an edge's two feet say.

There the equations of the seam lose rank, so Newton's method does not find the place itself. But
the square x of the gap between the two feet vanishes linearly along the seam, and point and feet's
middle are smooth functions of it: they are read off at places where the gap is wide enough, and
continued to x = 0 by a polynomial.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from decomp.skeletons.balls.contacts import Contacts
from decomp.skeletons.balls.equidistance import balanced
from decomp.skeletons.seams.steps.continuing import continued, value_at
from decomp.skeletons.seams.steps.points import SeamPoints
from decomp.skeletons.seams.steps.states import State
from decomp.vectors import Array, norm

WIDE, NARROW = 0.15, 0.04
"""Gaps, relative to the radius, from the widest to the narrowest at which points are read off."""
FEWEST = 0.01
"""Gaps narrower than this part of the radius say nothing."""
FITTED = 8
ROUNDS = 12
STEPS = (1e-4, 1e-5, 1e-6)
"""Steps back, in parts of the radius, that tell how fast a gap closes: the shorter ones where feet
run together faster than the longer ones can tell."""
FARTHEST = 0.2
"""The end is no farther from the last point known than this part of the radius."""


def fin(
    points: SeamPoints, rows: Sequence[State], pair: tuple[int, int]
) -> tuple[int, list[State]] | None:
    """The last points of a seam, up to the one where the feet of a pair of contacts meet.

    Args:
        points: of the seam's region.
        rows: known points of it, in order, with gaps that may have vanished in the last ones.
        pair: the contacts.

    Returns:
        How many of `rows` stay, those with a clear gap, and points behind them; None if the feet do
        not meet there.
    """
    clear = [k for k, s in enumerate(rows) if _gap(s, pair) > FEWEST * s.radius]
    if not clear:
        return None
    start = rows[clear[-1]]
    # going back from the last clear gap feet may miss; from a wide one they can be followed
    wider = [k for k in clear if _gap(rows[k], pair) >= WIDE / 2 * rows[k].radius]
    for k in (clear[-1], *wider[-1:]):
        found = _read_off(points, rows[k], pair)
        if found is not None:
            behind = [s for s in found[:-1] if float((s.point - start.point) @ start.tangent) > 0]
            return clear[-1] + 1, [*behind, found[-1]]
    return None


def with_one_foot(touching: Contacts, end: State) -> Contacts:
    """Contacts at the end of a seam, with one foot where two of the seam's have run together.

    About it their site is as far in fourth order, so that its feet can be found all around.
    """
    for k, site in enumerate(end.sites):
        foot = end.feet[k]
        if not any((end.feet[j] == foot).all() for j in range(k) if end.sites[j] == site):
            continue
        gaps = norm(touching.feet - foot)
        near = [
            j
            for j, sites in enumerate(touching.sites)
            if site in sites and gaps[j] <= FEWEST * touching.radius
        ]
        far = [j for j in range(len(touching.feet)) if j not in near]
        if len(near) > 1:
            feet = np.concatenate([touching.feet[far], foot[None]])
            one = tuple(dict.fromkeys(s for j in near for s in touching.sites[j]))
            sites = (*(touching.sites[j] for j in far), one)
            touching = Contacts(touching.radius, feet, sites, (end.point - feet) / touching.radius)
    return touching


def _read_off(points: SeamPoints, wide: State, pair: tuple[int, int]) -> list[State] | None:
    """Points over which a gap closes, the end last, from one at which it is wide or near one."""
    for _ in range(ROUNDS):
        if WIDE / 2 <= _gap(wide, pair) / wide.radius <= WIDE:
            break
        moved = _at_gap(points, wide, pair, 0.75 * WIDE * wide.radius)
        if moved is None:
            return None
        wide = moved
    else:
        return None
    length = _length(points, wide, pair)
    if length is None:
        return None
    # the squared gap falls to `low` of its value over the part 1 - low of the way
    low = (NARROW * wide.radius / _gap(wide, pair)) ** 2
    parts = (1 - np.cos(np.pi * (np.arange(FITTED) + 0.5) / FITTED)) / 2 * (1 - low)
    good = [s for s in _walk(points, wide, parts * length) if _gap(s, pair) > FEWEST * s.radius]
    if len(good) < FITTED:
        return None
    end = _balanced(points, _end(good, pair), pair)
    near = float(norm(end.point - wide.point)) <= FARTHEST * wide.radius
    return [*good, end] if near else None


def _gap(state: State, pair: tuple[int, int]) -> float:
    return float(norm(state.feet[pair[0]] - state.feet[pair[1]]))


def _ahead(points: SeamPoints, state: State, length: float) -> State | None:
    """The point of a seam next to the one a length ahead on the tangent."""
    spot = state.point + length * state.tangent
    return points.state(state.sites, spot, state.feet, state.tangent)


def _walk(points: SeamPoints, state: State, lengths: Array) -> list[State]:
    """Points of a seam at lengths (k,) ahead, ascending, each found from the one before.

    Feet that run together fast cannot be found from far.
    """
    found: list[State] = []
    here, at = state, 0.0
    for length in lengths.tolist():
        ahead = _ahead(points, here, length - at)
        if ahead is not None:
            found.append(ahead)
            here, at = ahead, length
    return found


def _length(points: SeamPoints, state: State, pair: tuple[int, int]) -> float | None:
    """How far ahead the squared gap would vanish if it went on as it has changed."""
    for part in STEPS:
        step = part * state.radius
        before = _ahead(points, state, -step)
        if before is not None:
            change = (_gap(state, pair) ** 2 - _gap(before, pair) ** 2) / step
            return -(_gap(state, pair) ** 2) / change if change < 0 else None
    return None


def _at_gap(points: SeamPoints, state: State, pair: tuple[int, int], gap: float) -> State | None:
    """A point of a seam nearer to one with a given gap: a step of Newton's method, or a part."""
    length = _length(points, state, pair)
    if length is None:
        return None
    step = length * (1 - (gap / _gap(state, pair)) ** 2)
    for _ in range(ROUNDS):
        moved = _ahead(points, state, step)
        if moved is not None and _gap(moved, pair) > FEWEST * moved.radius:
            return moved
        step /= 2
    return None


def _end(states: Sequence[State], pair: tuple[int, int]) -> State:
    """Points of a seam continued to where a gap vanishes; both feet are their middle there."""
    one, other = pair
    x = np.array([_gap(s, pair) ** 2 for s in states])
    end = continued(states, x, 0.0)
    end.feet[[one, other]] = value_at([(s.feet[one] + s.feet[other]) / 2 for s in states], x, 0.0)
    return replace(end, radius=float(norm(end.point - end.feet[one])), tangent=states[-1].tangent)


def _balanced(points: SeamPoints, state: State, pair: tuple[int, int]) -> State:
    """A point moved to where all contacts, the pair's being one, are equally far to rounding."""
    rows = [k for k in range(len(state.sites)) if k != pair[1]]
    which = np.array([[state.sites[k] for k in rows]])
    point, own = state.point[None], state.feet[rows][None]
    found = balanced(points.table, points.size, which, point, own)
    feet = np.array(state.feet)
    feet[rows] = found.feet[0]
    feet[pair[1]] = feet[pair[0]]
    return replace(state, point=found.points[0], feet=feet, radius=float(found.radius[0]))
