"""Following a seam with constant sites, compiled.

Points are found by steps along the tangent and Newton's method back onto the seam. After every step
two questions are put to the region's boundary: is anything nearer than the seam's own sites, and is
every foot still on the boundary? A change between two points is narrowed down by bisection.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, sqrt

import numpy as np

from decomp.carriers.compiled_carriers import Triple
from decomp.kernels.compiled import inner, scalar
from decomp.kernels.records import Record
from decomp.skeletons.balls.balance import balance
from decomp.skeletons.balls.probing import (
    HOLDS,
    INTRUDED,
    JOINED,
    LOST,
    TOWARDS,
    Probe,
    another,
    inside,
    nearest,
)
from decomp.skeletons.balls.supports import SupportTable, past_end, support
from decomp.vectors import Array, Ints

FLAT = 1e-7
"""Unit vectors that leave a plane by less than this lie in it."""
FIRST = 1e-3
"""The first step, as a part of the size."""
SHORTEST = 1e-9
GROWTH = 1.6
TURN = 0.9945
"""Cosine of the largest turn in a step, 6 degrees."""
RESIDUAL = 1e-12
LEAST_PROGRESS = 1e-6
"""A step that fails past this part of the size is tried again, shorter."""
CLOSE = 1e-15
"""Changes are narrowed down to this part of the size."""
VANISHED = 1e-7
BETWEEN = 8
LOOKS = 3
"""At so many places of a step it is seen whether feet have left the boundary."""
LEAST_LOOK, LEAST_WAY = 1e-4, 1e-4
"""Steps, as parts of the size, and ways of feet, as parts of the radius, below which it is not."""
PAST = 1e-9
"""A foot so far beyond its edge's end, as a part of the size, has left it."""
FULL, STUCK, ENDED, CLOSED = range(3, 7)


@dataclass(frozen=True, eq=False)
class Track(Record):
    """Room for the points of a seam with m contacts.

    Args:
        points: (n, 3).
        radius: (n,).
        tangents: (n, 3), in the sense of travel.
        slopes: (n,), how the radius changes along them.
        feet: (n * m, 3).
        work: scratch (m + 3, 7).
    """

    points: Array
    radius: Array
    tangents: Array
    slopes: Array
    feet: Array
    work: Array


def track(contacts: int, length: int) -> Track:
    """Room for `length` points."""
    return Track(
        np.empty((length, 3)),
        np.empty(length),
        np.empty((length, 3)),
        np.empty(length),
        np.empty((length * contacts, 3)),
        np.empty((contacts + 3, 7)),
    )


@scalar
def settle(
    table: SupportTable,
    which: Ints,
    track: Track,
    row: int,
    x: float,
    y: float,
    z: float,
    dx: float,
    dy: float,
    dz: float,
    size: float,
    strict: bool,
) -> bool:
    """Put the point of the seam next to (x, y, z) into a row of a track.

    Feet close by must stand in the row; (dx, dy, dz) is the sense of travel. If `strict`, the
    contacts must define a curve there.
    """
    count = len(which)
    work, first = track.work, row * count
    for c in range(count):
        if not abs(track.feet[first + c, 0]) < inf:
            return False
    x, y, z, radius, gap = balance(table, which, 0, count, track.feet, first, x, y, z, size, work)
    if not gap <= RESIDUAL * size or radius <= 0.0:
        return False
    rows, least, second, best = count - 1, inf, inf, 0
    for j in range(3):
        square = 0.0
        for k in range(rows):
            square += work[k, j] * work[k, j]
        if square < least:
            least, second, best = square, least, j
        elif square < second:
            second = square
    if strict and (second <= FLAT * FLAT or least > FLAT * FLAT):
        return False
    tx, ty, tz = work[rows, best], work[rows + 1, best], work[rows + 2, best]
    if tx * dx + ty * dy + tz * dz < 0.0:
        tx, ty, tz = -tx, -ty, -tz
    slope = 0.0
    for c in range(count):
        slope += work[c, 4] * tx + work[c, 5] * ty + work[c, 6] * tz
    track.points[row, 0], track.points[row, 1], track.points[row, 2] = x, y, z
    track.tangents[row, 0], track.tangents[row, 1], track.tangents[row, 2] = tx, ty, tz
    track.radius[row], track.slopes[row] = radius, slope / count
    return True


@scalar
def advance(
    table: SupportTable,
    which: Ints,
    track: Track,
    here: int,
    row: int,
    step: float,
    size: float,
    strict: bool,
) -> bool:
    """Put the point of the seam a step ahead of row `here` into another row.

    If `strict`, the contacts must define a curve there, which turns little on the way.
    """
    count = len(which)
    for c in range(count):
        for j in range(3):
            track.feet[row * count + c, j] = track.feet[here * count + c, j]
    dx, dy, dz = track.tangents[here, 0], track.tangents[here, 1], track.tangents[here, 2]
    px, py, pz = track.points[here, 0], track.points[here, 1], track.points[here, 2]
    good = settle(
        table,
        which,
        track,
        row,
        px + step * dx,
        py + step * dy,
        pz + step * dz,
        dx,
        dy,
        dz,
        size,
        strict,
    )
    if not good:
        return False
    wx, wy, wz = track.points[row, 0] - px, track.points[row, 1] - py, track.points[row, 2] - pz
    length = sqrt(wx * wx + wy * wy + wz * wz)
    # short steps are swamped by the rounding of the points
    rounding = 1e-13 * size
    if abs(length - abs(step)) > 0.5 * abs(step) + rounding:
        return False
    bend = track.tangents[row, 0] * dx + track.tangents[row, 1] * dy + track.tangents[row, 2] * dz
    ahead = (wx * dx + wy * dy + wz * dz) * (1.0 if step >= 0.0 else -1.0)
    return (bend >= TURN or not strict) and float(ahead) > 0.9 * length - rounding


@inner
def returns(track: Track, row: int, home: Array) -> bool:
    """Whether the step to a row passes `home`: a point and a tangent (6,)."""
    wx = track.points[row, 0] - track.points[row - 1, 0]
    wy = track.points[row, 1] - track.points[row - 1, 1]
    wz = track.points[row, 2] - track.points[row - 1, 2]
    hx = home[0] - track.points[row - 1, 0]
    hy = home[1] - track.points[row - 1, 1]
    hz = home[2] - track.points[row - 1, 2]
    square = wx * wx + wy * wy + wz * wz
    along = (hx * wx + hy * wy + hz * wz) / square
    ox, oy, oz = hx - along * wx, hy - along * wy, hz - along * wz
    same = (
        track.tangents[row, 0] * home[3]
        + track.tangents[row, 1] * home[4]
        + track.tangents[row, 2] * home[5]
    )
    off = ox * ox + oy * oy + oz * oz
    return bool(0.0 < along <= 1.0 and off <= 0.01 * square and same > 0.9)


@inner
def _foot(track: Track, row: int) -> Triple:
    return track.feet[row, 0], track.feet[row, 1], track.feet[row, 2]


@inner
def leaves_between(
    table: SupportTable, probe: Probe, which: Ints, track: Track, here: int, row: int
) -> bool:
    """Whether a foot leaves the boundary on the way from row `here` to another.

    It can leave its site and come to another one of the same support: across a notch, the edge or
    the face beyond it.
    """
    count = len(which)
    for c in range(count):
        a, b = _foot(track, here * count + c), _foot(track, row * count + c)
        way = sqrt((b[0] - a[0]) ** 2 + (b[1] - a[1]) ** 2 + (b[2] - a[2]) ** 2)
        if way <= LEAST_WAY * track.radius[row]:
            continue
        for look in range(1, LOOKS + 1):
            u = look / (LOOKS + 1.0)
            x = track.points[here, 0] + u * (track.points[row, 0] - track.points[here, 0])
            y = track.points[here, 1] + u * (track.points[row, 1] - track.points[here, 1])
            z = track.points[here, 2] + u * (track.points[row, 2] - track.points[here, 2])
            _, _, _, _, qx, qy, qz = support(
                table,
                which[c],
                x,
                y,
                z,
                a[0] + u * (b[0] - a[0]),
                a[1] + u * (b[1] - a[1]),
                a[2] + u * (b[2] - a[2]),
            )
            reach = sqrt((qx - x) ** 2 + (qy - y) ** 2 + (qz - z) ** 2)
            bound = (1.0 - TOWARDS) * reach + probe.slack
            x, y, z = x + TOWARDS * (qx - x), y + TOWARDS * (qy - y), z + TOWARDS * (qz - z)
            if inside(probe, x, y, z) and nearest(probe, x, y, z).distance > bound:
                return True
    return False


@scalar
def follow(
    table: SupportTable,
    probe: Probe,
    which: Ints,
    track: Track,
    size: float,
    longest: float,
    home: Array,
    leave: int,
    closable: bool,
    latest: float,
) -> tuple[int, int, int]:
    """Follow a seam from row 0 of a track.

    Args:
        table: supports.
        probe: queries.
        which: supports (m,) of the seam's contacts.
        track: filled in, as long as nothing changes.
        size: of the region.
        longest: step.
        home: first point and tangent (6,) of the whole seam.
        leave: steps to make before the seam may close.
        closable: whether the seam has the same sites as at `home`.
        latest: an intruder that is as near for longer than this has joined before.

    Returns:
        The number of rows, and why there are no more: FULL, STUCK (no further point with these
        contacts), ENDED (the radius vanishes), CLOSED (back at `home`), INTRUDED, LOST and which
        contact, or JOINED (a further contact is as near, and stays so). In the last three cases the
        last row is just before the change, and the row behind it holds a point just beyond.
    """
    count, last, room = len(which), 0, len(track.radius)
    step, low, high = min(FIRST * size, 0.2 * track.radius[0]), 0.0, -1.0
    change, contact, kind = HOLDS, -1, HOLDS
    narrowing, failed, beyond = False, False, PAST * size
    while True:
        if not narrowing:
            if last + 3 >= room:
                return last + 1, FULL, -1
            radius, slope = track.radius[last], track.slopes[last]
            if radius <= VANISHED * size and slope < 0.0:
                return last + 1, ENDED, -1
            limit = 0.5 * radius / -slope if slope < 0.0 else inf
            step = min(step, longest, limit)
            length = step
        else:
            length = (low + high) / 2
            if high - low <= CLOSE * size or not low < length < high:
                base = last
                if low > 0.0 and advance(table, which, track, base, last + 1, low, size, True):
                    last += 1
                    # where it began may be on the last bit before a change, too
                    if closable and last + leave > 3 and returns(track, last, home):
                        return last + 1, CLOSED, -1
                if failed:
                    # long steps can lead across an axis, where feet jump
                    if not low > LEAST_PROGRESS * size:
                        return last + 1, STUCK, -1
                    narrowing, failed, step = False, False, low / 4
                    continue
                if not advance(table, which, track, base, last + 1, high, size, True):
                    return last + 1, STUCK, -1
                return last + 1, kind, contact
        trial = last + 1
        good = advance(table, which, track, last, trial, length, size, True)
        if not good:
            if narrowing:
                high, failed = length, True
                continue
            step /= 2
            if step < SHORTEST * min(size, 1e3 * track.radius[last]):
                return last + 1, STUCK, -1
            continue
        # one loop over all queries, so that they are compiled once: first points between the
        # rows, then the point itself, then towards each foot
        radius = track.radius[trial]
        x, y, z = track.points[trial, 0], track.points[trial, 1], track.points[trial, 2]
        fx, fy, fz = track.points[last, 0], track.points[last, 1], track.points[last, 2]
        least = min(radius, track.radius[last])
        between = 0 if narrowing else min(BETWEEN, int(2.0 * length / least))
        change, rough = HOLDS, False
        for q in range(-between, count + 1):
            if q < 0:
                u = -q / (between + 1.0)
                px, py, pz = x + u * (fx - x), y + u * (fy - y), z + u * (fz - z)
                bound = radius + u * (track.radius[last] - radius)
                bound -= 0.05 * bound + 0.03 * length
            elif q == 0:
                px, py, pz = x, y, z
                bound = radius - probe.slack
            else:
                row = trial * count + q - 1
                px = x + TOWARDS * (track.feet[row, 0] - x)
                py = y + TOWARDS * (track.feet[row, 1] - y)
                pz = z + TOWARDS * (track.feet[row, 2] - z)
                bound = (1.0 - TOWARDS) * radius + probe.slack
            if q <= 0 and not inside(probe, px, py, pz):
                away = -1.0
            else:
                away = nearest(probe, px, py, pz).distance
            if q < 0:
                if away < bound:
                    rough = True
                    break
            elif q == 0:
                if away < bound:
                    change, contact = INTRUDED, -1
                    break
            elif away > bound or past_end(table, which[q - 1], *_foot(track, row)) > beyond:
                change, contact = LOST, q - 1
                break
        if change == HOLDS and not rough and not narrowing and length > LEAST_LOOK * size:
            rough = leaves_between(table, probe, which, track, last, trial)
        late = kind == INTRUDED and high - length > latest
        if change == HOLDS and not rough and (not narrowing or kind == JOINED or late):
            first = trial * count
            if another(probe, x, y, z, radius, track.feet, first, count):
                change, contact = JOINED, -1
        if rough:
            step /= 2
            if step < SHORTEST * size:
                return last + 1, STUCK, -1
            continue
        if change != HOLDS:
            kind = change
            if not narrowing:
                narrowing, low, high = True, 0.0, length
            else:
                high, failed = length, False
            continue
        if narrowing:
            # the row stays `last`: what is sound is measured from there
            low = length
            continue
        last += 1
        if closable and last + leave > 3 and returns(track, last, home):
            return last + 1, CLOSED, -1
        step *= GROWTH
