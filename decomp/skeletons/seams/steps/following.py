"""Following a seam with constant sites, compiled.

Points are found by steps along the tangent and Newton's method back onto the seam. After every step
two questions are put to the region's boundary: is anything nearer than the seam's own sites, and is
every foot still on the boundary? A change between two points is narrowed down by bisection.
"""

from __future__ import annotations

from math import inf, sqrt

from decomp.carriers.compiled_carriers import Triple
from decomp.kernels.compiled import inner, scalar
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
from decomp.skeletons.seams.steps.dips import dip_on, only_touches
from decomp.skeletons.seams.steps.stepping import Track, advance
from decomp.vectors import Array, Ints

FIRST = 1e-3
"""The first step, as a part of the size."""
SHORTEST = 1e-9
GROWTH = 1.6
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
                    dip = dip_on(table, probe, which, track, base, last + 1, low, size)
                    if dip > 0.0:
                        kind, failed, low, high = INTRUDED, False, 0.0, dip
                        continue
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
                if away < bound and not (
                    not narrowing and only_touches(probe, track, last, trial, count, length, size)
                ):
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
        if change == HOLDS and not rough and not narrowing:
            dip = dip_on(table, probe, which, track, last, trial, length, size)
            if dip > 0.0:
                kind, failed, narrowing, low, high = INTRUDED, False, True, 0.0, dip
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
