"""One maximal ball, compiled, see `balls`.

The ball touches the boundary at q with its centre on the unit normal n. A ball that holds a
boundary point h shrinks to the one through h: radius |h - q|^2 / (2 n.(h - q)). Towards a centre of
curvature the points h creep up to q, and the radius converges linearly.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import sqrt

from decomp.carriers.compiled_carriers import Triple
from decomp.kernels.compiled import inner, scalar, spliced
from decomp.kernels.records import Record
from decomp.sites.measure import NONE
from decomp.skeletons.balls.probing import Probe, candidate_foot, inside, nearest
from decomp.vectors import Array, Ints

ROUNDS = 1000
"""A ball that shrinks for so many rounds does not come to rest."""
POLISHINGS = 5
"""Most steps of Newton's method."""
LEAST_SLOPE = 1e-6
"""Where the equation changes less with the radius the second contact is as good as the first."""
SAME_FOOT = 1e-2
"""The second contact moves by less than this part of the radius."""
POLISH = 1e-4
"""The radius changes by less than this part of it."""
AT_REST = 1e-16
"""Steps below this part of the size are the last ones."""
OUTSIDE = 1.001
"""Balls whose centre is not in the region stay a little too large: a boundary point stops them."""
EMPTY = 1e-13
"""A ball counts as empty when it reaches beyond the boundary by less than this part of the size."""
CREPT = 1e-5
"""Touching points closer than this part of the radius have run together."""
TOUCHES, OSCULATES, RESTLESS, SIZELESS = range(4)


@dataclass(frozen=True, eq=False)
class Shrunk(Record):
    """Room for k maximal balls and how they were found.

    Args:
        radius: (k,).
        feet: (k, 3); the point itself where nothing else is touched.
        candidates: (k,), what holds the second foot, -1 if there is none.
        state: (k,), TOUCHES a second point, OSCULATES the boundary at its own point, RESTLESS or
            SIZELESS if there is no such ball.
    """

    radius: Array
    feet: Array
    candidates: Ints
    state: Ints


@inner
def polish(probe: Probe, k: int, q: Array, n: Array, r: float, size: float, second: Array) -> float:
    """Newton's method on d(q + r n) = r, with d the distance from candidate k.

    Where the second contact (3,) is too near to the first for that, r is left alone.
    """
    for _ in range(POLISHINGS):
        x, y, z = q[0] + r * n[0], q[1] + r * n[1], q[2] + r * n[2]
        hx, hy, hz = candidate_foot(probe, k, x, y, z)
        vx, vy, vz = x - hx, y - hy, z - hz
        away = sqrt(vx * vx + vy * vy + vz * vz)
        slope = 1.0 - (vx * n[0] + vy * n[1] + vz * n[2]) / away if away > 0.0 else 0.0
        off = sqrt((hx - second[0]) ** 2 + (hy - second[1]) ** 2 + (hz - second[2]) ** 2)
        if slope <= LEAST_SLOPE or off > SAME_FOOT * r:
            break
        step = (away - r) / slope
        if abs(step) > POLISH * min(r, size):
            break
        r += step
        second[0], second[1], second[2] = hx, hy, hz
        if abs(step) <= AT_REST * size:
            break
    return r


@spliced
def touched(probe: Probe, x: float, y: float, z: float) -> tuple[bool, int, float, Triple]:
    """What a ball at a point of the region touches; nothing if the point is not in it.

    Returns:
        Whether there is something, the candidate that holds it, how far and where it is.
    """
    if inside(probe, x, y, z):
        hit = nearest(probe, x, y, z)
        if hit.candidate != NONE:
            return True, hit.candidate, hit.distance, (hit.x, hit.y, hit.z)
    return False, NONE, 0.0, (x, y, z)


@spliced
def shrink_one(probe: Probe, q: Array, n: Array, size: float, balls: Shrunk, i: int) -> None:
    """The maximal ball at a point q (3,) with normal n (3,), into row i; see `shrink`."""
    feet, state, candidates = balls.feet, balls.state, balls.candidates
    r, chord = size, 0.0
    feet[i, 0], feet[i, 1], feet[i, 2] = q[0], q[1], q[2]
    state[i], candidates[i] = RESTLESS, NONE
    for _ in range(ROUNDS):
        x, y, z = q[0] + r * n[0], q[1] + r * n[1], q[2] + r * n[2]
        met, k, reach, (hx, hy, hz) = touched(probe, x, y, z)
        cx, cy, cz = hx - q[0], hy - q[1], hz - q[2]
        square = cx * cx + cy * cy + cz * cz
        crept = CREPT * CREPT * r * r
        if reach >= r - EMPTY * size:
            if chord > crept:
                state[i] = TOUCHES
                r = polish(probe, candidates[i], q, n, r, size, feet[i])
            else:
                state[i], candidates[i] = OSCULATES, NONE
            break
        lift = cx * n[0] + cy * n[1] + cz * n[2]
        smaller = square / (2.0 * lift) if lift > 0.0 else r
        if smaller >= r:
            state[i], candidates[i] = OSCULATES if met and square <= crept else SIZELESS, NONE
            break
        if met:
            feet[i, 0], feet[i, 1], feet[i, 2] = hx, hy, hz
            chord, candidates[i] = square, k
            r = smaller
        else:
            r = OUTSIDE * smaller
    balls.radius[i] = r


@scalar
def shrink(probe: Probe, points: Array, normals: Array, size: float, balls: Shrunk) -> None:
    """Fill in the maximal balls at points (k, 3).

    Args:
        probe: queries.
        points, normals: (k, 3); the normals of unit length and into the region.
        size: of the model; balls begin with it.
        balls: filled in.
    """
    for i in range(len(points)):
        shrink_one(probe, points[i], normals[i], size, balls, i)
