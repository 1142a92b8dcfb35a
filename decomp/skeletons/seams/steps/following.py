"""Following a seam with constant sites, compiled.

Points are found by steps along the tangent and Newton's method back onto the seam. After every step
it is asked what has changed (`changes`, `dips`). A change between two points is narrowed down by
bisection. So a march along a seam is in one of three states:

    SEEKING: steps ahead, ever longer ones, until a change is on one;
    NARROWING: the change is less than `high` and not less than `low` ahead of the last point;
    HALTED: it is known why no point follows.
"""

from __future__ import annotations

from math import inf
from typing import NamedTuple

from decomp.kernels.compiled import inner, scalar, spliced
from decomp.skeletons.balls.probing import HOLDS, INTRUDED, JOINED, another
from decomp.skeletons.seams.steps.changes import ROUGH, change_on, leaves_between
from decomp.skeletons.seams.steps.course import Course, returns
from decomp.skeletons.seams.steps.dips import dip_on
from decomp.skeletons.seams.steps.stepping import advance

FIRST = 1e-3
"""The first step, as a part of the size."""
FIRST_OF_RADIUS = 0.2
"""It is at most this part of the first radius."""
SHORTEST = 1e-9
"""A step shorter than this part of the size is none; beside the boundary, of a thousand radii."""
RADII = 1e3
GROWTH = 1.6
"""How much longer the step is after one on which nothing changes."""
LEAST_PROGRESS = 1e-6
"""A step that fails past this part of the size is tried again, shorter."""
CLOSE = 1e-15
"""Changes are narrowed down to this part of the size."""
VANISHED = 1e-7
"""A radius below this part of the size that falls vanishes."""
APPROACH = 0.5
"""Steps go this part of the way to where the radius would vanish, at most."""
LEAST_LOOK = 1e-4
"""Steps, as a part of the size, below which no foot leaves the boundary and comes back."""
FULL, STUCK, ENDED, CLOSED = range(3, 7)
SEEKING, NARROWING, HALTED = range(3)


class March(NamedTuple):
    """How far a seam has been followed.

    Args:
        state: SEEKING, NARROWING or HALTED.
        last: row of the last point before any change.
        step: length of the next step ahead.
        low: so long a step from the last point is sound.
        high: on so long a one there is the change, or it fails.
        why: the change, or why the march has halted.
        contact: whose foot is lost, if that is why.
        failed: whether there is no point `high` ahead.
    """

    state: int
    last: int
    step: float
    low: float
    high: float
    why: int
    contact: int
    failed: bool


@scalar
def follow(course: Course) -> tuple[int, int, int]:
    """Follow a seam from row 0 of its track.

    Returns:
        The number of rows, and why there are no more: FULL, STUCK (no further point with these
        contacts), ENDED (the radius vanishes), CLOSED (back at `home`), INTRUDED, LOST and which
        contact, or JOINED (a further contact is as near, and stays so). In the last three cases the
        last row is just before the change, and the row behind it holds a point just beyond.
    """
    track = course.track
    step = min(FIRST * track.contacts.size, FIRST_OF_RADIUS * track.radius[0])
    march = _seeking(0, step)
    while march.state != HALTED:
        if march.state == SEEKING:
            march = _sought(course, march)
        elif _narrow(course, march):
            march = _found(course, march)
        else:
            march = _narrowed(course, march)
    return march.last + 1, march.why, march.contact


@inner
def _seeking(last: int, step: float) -> March:
    """To SEEKING: a step ahead of the last point is next."""
    return March(SEEKING, last, step, 0.0, -1.0, HOLDS, -1, False)


@inner
def _narrowing(last: int, high: float, why: int, contact: int) -> March:
    """To NARROWING: there is a change on a step of length `high` from the last point."""
    return March(NARROWING, last, high, 0.0, high, why, contact, False)


@inner
def _halted(last: int, why: int, contact: int) -> March:
    """To HALTED: no point follows the last one."""
    return March(HALTED, last, 0.0, 0.0, -1.0, why, contact, False)


@spliced
def _sought(course: Course, march: March) -> March:
    """From SEEKING: a step ahead, which is sound, or too long, or has a change on it."""
    track, last = course.track, march.last
    size, trial = track.contacts.size, last + 1
    if last + 3 >= len(track.radius):
        return _halted(last, FULL, -1)
    radius, slope = track.radius[last], track.slopes[last]
    if radius <= VANISHED * size and slope < 0.0:
        return _halted(last, ENDED, -1)
    limit = APPROACH * radius / -slope if slope < 0.0 else inf
    length = min(march.step, course.longest, limit)
    if not advance(course.table, track, last, trial, length, True):
        return _shortened(last, length / 2, SHORTEST * min(size, RADII * radius))
    change, contact = change_on(course, last, trial, length, False)
    if change == HOLDS and length > LEAST_LOOK * size and leaves_between(course, last, trial):
        change = ROUGH
    if change == HOLDS and _joined(course, trial):
        change = JOINED
    if change == ROUGH:
        return _shortened(last, length / 2, SHORTEST * size)
    if change != HOLDS:
        return _narrowing(last, length, change, contact)
    dip = dip_on(course.table, course.probe, track, last, trial, length)
    if dip > 0.0:
        return _narrowing(last, dip, INTRUDED, -1)
    if returns(course, trial):
        return _halted(trial, CLOSED, -1)
    return _seeking(trial, length * GROWTH)


@inner
def _shortened(last: int, step: float, shortest: float) -> March:
    """A step was too long: it is tried again with a shorter one, unless that is none."""
    return _halted(last, STUCK, -1) if step < shortest else _seeking(last, step)


@spliced
def _joined(course: Course, row: int) -> bool:
    """Whether a further contact is as near at the point in a row."""
    track = course.track
    contacts = track.contacts
    x, y, z = track.points[row, 0], track.points[row, 1], track.points[row, 2]
    return another(course.probe, contacts, row * contacts.count, x, y, z, track.radius[row])


@inner
def _narrow(course: Course, march: March) -> bool:
    """Whether a change is known to rounding."""
    middle = (march.low + march.high) / 2
    close = march.high - march.low <= CLOSE * course.track.contacts.size
    return close or not march.low < middle < march.high


@spliced
def _narrowed(course: Course, march: March) -> March:
    """In NARROWING: the change is before or behind the middle, as measured from the last point."""
    track, last, low, high = course.track, march.last, march.low, march.high
    middle, trial = (low + high) / 2, last + 1
    why, contact, step = march.why, march.contact, march.step
    if not advance(course.table, track, last, trial, middle, True):
        return March(NARROWING, last, step, low, middle, why, contact, True)
    change, lost = change_on(course, last, trial, middle, True)
    late = why == INTRUDED and high - middle > course.latest
    if change == HOLDS and (why == JOINED or late) and _joined(course, trial):
        change = JOINED
    if change != HOLDS:
        return March(NARROWING, last, step, low, middle, change, lost, False)
    return March(NARROWING, last, step, middle, high, why, contact, march.failed)


@spliced
def _found(course: Course, march: March) -> March:
    """From NARROWING: the change is known, and there are points on both its sides."""
    table, track, low, base = course.table, course.track, march.low, march.last
    last = base
    if low > 0.0 and advance(table, track, base, base + 1, low, True):
        dip = dip_on(table, course.probe, track, base, base + 1, low)
        if dip > 0.0:
            return _narrowing(base, dip, INTRUDED, -1)
        last = base + 1
        # where it began may be on the last bit before a change, too
        if returns(course, last):
            return _halted(last, CLOSED, -1)
    if march.failed:
        # long steps can lead across an axis, where feet jump
        if low > LEAST_PROGRESS * track.contacts.size:
            return _seeking(last, low / 4)
        return _halted(last, STUCK, -1)
    if advance(table, track, base, last + 1, march.high, True):
        return _halted(last, march.why, march.contact)
    return _halted(last, STUCK, -1)
