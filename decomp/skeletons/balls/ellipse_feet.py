"""Feet on ellipses, compiled: on their parameter, not on the carriers that meet in them.

Where a plane almost touches a cylinder the ellipse is long and its tips are sharp; steps along the
tangent there lead off it, and where two carriers touch nothing tells which branch is meant. As a
function of the parameter t the square of the distance |p - c - a cos t - b sin t|^2 has two minima
at most, and Newton's steps that make it smaller lead to that on the known foot's side.
"""

from __future__ import annotations

from math import atan2, cos, inf, sin, sqrt

from decomp.carriers.compiled_carriers import Triple
from decomp.kernels.compiled import inner
from decomp.vectors import Array

STEPS = 100
LONGEST = 0.5
"""Steps in radians."""
LEAST_BEND = 1e-5
"""Second derivatives are taken to be no less than this part of their largest term."""
CLOSE = 1e-5
"""Steps below this are not asked whether they lead nearer: rounding would answer."""
AT_REST, ROUNDING = 1e-16, 1e-12
"""Steps below the first are the last ones; so are those below the second that do not shrink."""


@inner
def ellipse_parameter(data: Array, k: int, qx: float, qy: float, qz: float) -> float:
    """The parameter of a point close to an ellipse; its row has centre and both semi-axes."""
    vx, vy, vz = qx - data[k, 0], qy - data[k, 1], qz - data[k, 2]
    aa = data[k, 3] ** 2 + data[k, 4] ** 2 + data[k, 5] ** 2
    bb = data[k, 6] ** 2 + data[k, 7] ** 2 + data[k, 8] ** 2
    u = (vx * data[k, 3] + vy * data[k, 4] + vz * data[k, 5]) / aa
    v = (vx * data[k, 6] + vy * data[k, 7] + vz * data[k, 8]) / bb
    return atan2(v, u)


@inner
def ellipse_foot(
    data: Array, k: int, x: float, y: float, z: float, qx: float, qy: float, qz: float
) -> Triple:
    """The foot of a point on the ellipse in a row of data, near a known one."""
    aa = data[k, 3] ** 2 + data[k, 4] ** 2 + data[k, 5] ** 2
    bb = data[k, 6] ** 2 + data[k, 7] ** 2 + data[k, 8] ** 2
    vx, vy, vz = x - data[k, 0], y - data[k, 1], z - data[k, 2]
    pa = vx * data[k, 3] + vy * data[k, 4] + vz * data[k, 5]
    pb = vx * data[k, 6] + vy * data[k, 7] + vz * data[k, 8]
    t = ellipse_parameter(data, k, qx, qy, qz)
    c, s = cos(t), sin(t)
    # half the square of the distance, but for a constant
    level = 0.5 * (aa * c * c + bb * s * s) - pa * c - pb * s
    largest = max(aa, bb) + sqrt(pa * pa + pb * pb)
    before = inf
    for _ in range(STEPS):
        slope = (bb - aa) * s * c + pa * s - pb * c
        bend = (bb - aa) * (c * c - s * s) + pa * c + pb * s
        step = -slope / max(abs(bend), LEAST_BEND * largest)
        step = min(max(step, -LONGEST), LONGEST)
        while True:
            c, s = cos(t + step), sin(t + step)
            after = 0.5 * (aa * c * c + bb * s * s) - pa * c - pb * s
            # so written that it ends where the point is none
            if not (after > level and abs(step) > CLOSE):
                break
            step *= 0.5
        t, level = t + step, after
        if abs(step) <= AT_REST or before <= abs(step) <= ROUNDING:
            break
        before = abs(step)
    return (
        data[k, 0] + c * data[k, 3] + s * data[k, 6],
        data[k, 1] + c * data[k, 4] + s * data[k, 7],
        data[k, 2] + c * data[k, 5] + s * data[k, 8],
    )


@inner
def ellipse_tangent(data: Array, k: int, qx: float, qy: float, qz: float) -> Triple:
    """The unit tangent of an ellipse at a point on it."""
    t = ellipse_parameter(data, k, qx, qy, qz)
    c, s = cos(t), sin(t)
    tx = c * data[k, 6] - s * data[k, 3]
    ty = c * data[k, 7] - s * data[k, 4]
    tz = c * data[k, 8] - s * data[k, 5]
    length = sqrt(tx * tx + ty * ty + tz * tz)
    return tx / length, ty / length, tz / length
