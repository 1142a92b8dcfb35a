"""What changes on a step along a seam with constant sites, compiled.

Two questions are put to the region's boundary: is anything nearer than the seam's own sites, and is
every foot still on the boundary?
"""

from __future__ import annotations

from math import sqrt

from decomp.carriers.compiled_carriers import Triple
from decomp.kernels.compiled import inner
from decomp.skeletons.balls.probing import (
    HOLDS,
    INTRUDED,
    LOST,
    TOWARDS,
    inside,
    nearest,
)
from decomp.skeletons.balls.supports import past_end, support
from decomp.skeletons.seams.steps.course import Course
from decomp.skeletons.seams.steps.dips import only_touches
from decomp.skeletons.seams.steps.stepping import Track

ROUGH = 7
"""A step is so long that something comes near in its middle."""
BETWEEN = 8
"""Most places in the middle of a step at which it is seen whether something comes near."""
SLACK_OF_RADIUS, SLACK_OF_STEP = 0.05, 0.03
"""By these parts of radius and step the radius there is less, at most, than on the chord."""
LOOKS = 3
"""At so many places of a step it is seen whether feet have left the boundary."""
LEAST_WAY = 1e-4
"""Ways of feet, as a part of the radius, below which it is not."""
PAST = 1e-9
"""A foot so far beyond its edge's end, as a part of the size, has left it."""


@inner
def change_on(
    course: Course, here: int, row: int, length: float, narrowing: bool
) -> tuple[int, int]:
    """What is changed at the point in a row, which is a step of a length ahead of row `here`.

    Unless a change is being narrowed down the places between are looked at too, and what comes
    nearer by the tolerance only is none.

    Returns:
        HOLDS, ROUGH, INTRUDED, or LOST; and which contact is lost, -1 otherwise.
    """
    table, probe, track = course.table, course.probe, course.track
    contacts = track.contacts
    count = contacts.count
    radius, before = track.radius[row], track.radius[here]
    x, y, z = track.points[row, 0], track.points[row, 1], track.points[row, 2]
    fx, fy, fz = track.points[here, 0], track.points[here, 1], track.points[here, 2]
    between = 0 if narrowing else min(BETWEEN, int(2.0 * length / min(radius, before)))
    # one loop over all queries, so that they are compiled once: first points between the
    # rows, then the point itself, then towards each foot
    for q in range(-between, count + 1):
        foot = row * count + q - 1
        if q < 0:
            u = -q / (between + 1.0)
            px, py, pz = x + u * (fx - x), y + u * (fy - y), z + u * (fz - z)
            bound = radius + u * (before - radius)
            bound -= SLACK_OF_RADIUS * bound + SLACK_OF_STEP * length
        elif q == 0:
            px, py, pz = x, y, z
            bound = radius - probe.slack
        else:
            qx, qy, qz = _foot(track, foot)
            px, py, pz = x + TOWARDS * (qx - x), y + TOWARDS * (qy - y), z + TOWARDS * (qz - z)
            bound = (1.0 - TOWARDS) * radius + probe.slack
        away = -1.0
        if q > 0 or inside(probe, px, py, pz):
            away = nearest(probe, px, py, pz).distance
        if q > 0:
            beyond = past_end(table, contacts.which[foot], *_foot(track, foot))
            if away > bound or beyond > PAST * contacts.size:
                return LOST, q - 1
        elif away < bound:
            if q < 0:
                return ROUGH, -1
            if narrowing or not only_touches(probe, track, here, row, length):
                return INTRUDED, -1
    return HOLDS, -1


@inner
def _foot(track: Track, row: int) -> Triple:
    feet = track.contacts.feet
    return feet[row, 0], feet[row, 1], feet[row, 2]


@inner
def leaves_between(course: Course, here: int, row: int) -> bool:
    """Whether a foot leaves the boundary on the way from row `here` to another.

    It can leave its site and come to another one of the same support: across a notch, the edge or
    the face beyond it.
    """
    table, probe, track = course.table, course.probe, course.track
    count, which = track.contacts.count, track.contacts.which
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
