"""One maximal ball, compiled, see `balls`.

The ball touches the boundary at q with its centre on the unit normal n. A ball that holds a
boundary point h shrinks to the one through h: radius |h - q|^2 / (2 n.(h - q)). Towards a centre of
curvature the points h creep up to q, and the radius converges linearly.
"""

from __future__ import annotations

from decomp.sites.measure import NONE
from decomp.tracing.compiled import scalar
from decomp.tracing.probing import Probe, inside, nearest_hit
from decomp.vectors import Array, Ints

ROUNDS = 1000
EMPTY = 1e-13
"""A ball counts as empty when it reaches beyond the boundary by less than this part of the size."""
CREPT = 1e-5
"""Touching points closer than this part of the radius have run together."""
TOUCHES, OSCULATES, RESTLESS, SIZELESS = range(4)


@scalar
def shrink(
    probe: Probe,
    points: Array,
    normals: Array,
    size: float,
    start: Array,
    radius: Array,
    feet: Array,
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
        state: filled in: TOUCHES a second point, OSCULATES the boundary at its own point,
            RESTLESS or SIZELESS if there is no such ball.
    """
    for i in range(len(points)):
        qx, qy, qz = points[i, 0], points[i, 1], points[i, 2]
        nx, ny, nz = normals[i, 0], normals[i, 1], normals[i, 2]
        r = start[i]
        feet[i, 0], feet[i, 1], feet[i, 2] = qx, qy, qz
        state[i] = RESTLESS
        chord = 0.0
        for _ in range(ROUNDS):
            x, y, z = qx + r * nx, qy + r * ny, qz + r * nz
            hx, hy, hz, reach, met = x, y, z, 0.0, False
            if inside(probe, x, y, z):
                hit = nearest_hit(probe, x, y, z)
                if hit.candidate != NONE:
                    hx, hy, hz, reach, met = hit.x, hit.y, hit.z, hit.distance, True
            cx, cy, cz = hx - qx, hy - qy, hz - qz
            square = cx * cx + cy * cy + cz * cz
            crept = met and square <= CREPT * CREPT * r * r
            if reach >= r - EMPTY * size:
                state[i] = TOUCHES if chord > CREPT * CREPT * r * r else OSCULATES
                break
            lift = cx * nx + cy * ny + cz * nz
            smaller = square / (2.0 * lift) if lift > 0.0 else r
            if smaller >= r:
                state[i] = OSCULATES if crept else SIZELESS
                break
            if met:
                feet[i, 0], feet[i, 1], feet[i, 2] = hx, hy, hz
                chord = square
            r = smaller
        radius[i] = r
