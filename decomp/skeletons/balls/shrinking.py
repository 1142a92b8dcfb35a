"""One maximal ball, compiled, see `balls`.

The ball touches the boundary at q with its centre on the unit normal n. A ball that holds a
boundary point h shrinks to the one through h: radius |h - q|^2 / (2 n.(h - q)). Towards a centre of
curvature the points h creep up to q, and the radius converges linearly.
"""

from __future__ import annotations

from math import sqrt

from decomp.kernels.compiled import inner, scalar
from decomp.sites.measure import NONE
from decomp.skeletons.balls.probing import Probe, candidate_foot, inside, nearest
from decomp.vectors import Array, Ints

ROUNDS = 1000
POLISHINGS = 5
EMPTY = 1e-13
"""A ball counts as empty when it reaches beyond the boundary by less than this part of the size."""
CREPT = 1e-5
"""Touching points closer than this part of the radius have run together."""
TOUCHES, OSCULATES, RESTLESS, SIZELESS = range(4)


@inner
def polish(
    probe: Probe,
    k: int,
    qx: float,
    qy: float,
    qz: float,
    nx: float,
    ny: float,
    nz: float,
    r: float,
    size: float,
    feet: Array,
    i: int,
) -> float:
    """Newton's method on d(q + r n) = r, with d the distance from candidate k.

    Where the second contact is too near to the first for that, r is left alone.
    """
    for _ in range(POLISHINGS):
        x, y, z = qx + r * nx, qy + r * ny, qz + r * nz
        hx, hy, hz = candidate_foot(probe, k, x, y, z)
        vx, vy, vz = x - hx, y - hy, z - hz
        away = sqrt(vx * vx + vy * vy + vz * vz)
        slope = 1.0 - (vx * nx + vy * ny + vz * nz) / away if away > 0.0 else 0.0
        off = sqrt((hx - feet[i, 0]) ** 2 + (hy - feet[i, 1]) ** 2 + (hz - feet[i, 2]) ** 2)
        if slope <= 1e-6 or off > 1e-2 * r:
            break
        step = (away - r) / slope
        if abs(step) > 1e-4 * min(r, size):
            break
        r += step
        feet[i, 0], feet[i, 1], feet[i, 2] = hx, hy, hz
        if abs(step) <= 1e-16 * size:
            break
    return r


@scalar
def shrink(
    probe: Probe,
    points: Array,
    normals: Array,
    size: float,
    start: Array,
    radius: Array,
    feet: Array,
    candidates: Ints,
    state: Ints,
) -> None:
    """Fill in radius and second foot of the maximal balls at points (k, 3), and how it went.

    Args:
        probe: queries.
        points, normals: (k, 3); the normals of unit length and into the region.
        size: of the model.
        start: first radii (k,), large enough.
        radius: filled in.
        feet: filled in; the point itself where nothing else is touched.
        candidates: filled in: what holds the second foot, -1 if there is none.
        state: filled in: TOUCHES a second point, OSCULATES the boundary at its own point,
            RESTLESS or SIZELESS if there is no such ball.
    """
    for i in range(len(points)):
        qx, qy, qz = points[i, 0], points[i, 1], points[i, 2]
        nx, ny, nz = normals[i, 0], normals[i, 1], normals[i, 2]
        r = start[i]
        feet[i, 0], feet[i, 1], feet[i, 2] = qx, qy, qz
        state[i], candidates[i] = RESTLESS, -1
        chord = 0.0
        for _ in range(ROUNDS):
            x, y, z = qx + r * nx, qy + r * ny, qz + r * nz
            hx, hy, hz, reach, met, k = x, y, z, 0.0, False, -1
            if inside(probe, x, y, z):
                hit = nearest(probe, x, y, z)
                if hit.candidate != NONE:
                    hx, hy, hz, reach, met = hit.x, hit.y, hit.z, hit.distance, True
                    k = hit.candidate
            cx, cy, cz = hx - qx, hy - qy, hz - qz
            square = cx * cx + cy * cy + cz * cz
            crept = met and square <= CREPT * CREPT * r * r
            if reach >= r - EMPTY * size:
                state[i] = TOUCHES if chord > CREPT * CREPT * r * r else OSCULATES
                if state[i] == TOUCHES:
                    r = polish(probe, candidates[i], qx, qy, qz, nx, ny, nz, r, size, feet, i)
                else:
                    candidates[i] = -1
                break
            lift = cx * nx + cy * ny + cz * nz
            smaller = square / (2.0 * lift) if lift > 0.0 else r
            if smaller >= r:
                state[i], candidates[i] = OSCULATES if crept else SIZELESS, -1
                break
            if met:
                feet[i, 0], feet[i, 1], feet[i, 2] = hx, hy, hz
                chord, candidates[i] = square, k
                r = smaller
            else:
                # a little too large, so that a boundary point stops the ball in the end
                r = 1.001 * smaller
        radius[i] = r
