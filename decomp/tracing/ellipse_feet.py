"""The foot of a point on an ellipse, compiled.

Two cylinders of one radius whose axes meet have two ellipses in common, which cross where the
cylinders are tangent. There the carriers do not tell one from the other; the parameter does.
"""

from __future__ import annotations

from math import sqrt

from decomp.kernels.carriers import Triple
from decomp.tracing.compiled import inner
from decomp.tracing.foot_steps import FOOT_STEPS, LEAST_BEND, LONGEST_STEP
from decomp.vectors import Array


@inner
def ellipse_parameter(data: Array, qx: float, qy: float, qz: float) -> tuple[float, float]:
    """Cosine and sine of the parameter of a point close to an ellipse.

    Args:
        data: (9,) or more: the centre and both half axes.
        qx, qy, qz: the point.
    """
    vx, vy, vz = qx - data[0], qy - data[1], qz - data[2]
    aa = data[3] * data[3] + data[4] * data[4] + data[5] * data[5]
    bb = data[6] * data[6] + data[7] * data[7] + data[8] * data[8]
    c = (vx * data[3] + vy * data[4] + vz * data[5]) / aa
    s = (vx * data[6] + vy * data[7] + vz * data[8]) / bb
    length = sqrt(c * c + s * s)
    if length == 0.0:
        return 1.0, 0.0
    return c / length, s / length


@inner
def ellipse_foot(
    data: Array, x: float, y: float, z: float, qx: float, qy: float, qz: float
) -> Triple:
    """The foot of (x, y, z) near a known one: Newton's method on (p - q(t)).q'(t) = 0.

    A step by an angle is made with half its tangent, which keeps cosine and sine on the circle.
    """
    c, s = ellipse_parameter(data, qx, qy, qz)
    before = 1e300
    for _ in range(FOOT_STEPS):
        # from the centre to the point of the ellipse, which is minus the second derivative, and the
        # first derivative
        ox, oy, oz = (
            c * data[3] + s * data[6],
            c * data[4] + s * data[7],
            c * data[5] + s * data[8],
        )
        tx, ty, tz = (
            c * data[6] - s * data[3],
            c * data[7] - s * data[4],
            c * data[8] - s * data[5],
        )
        vx, vy, vz = x - data[0] - ox, y - data[1] - oy, z - data[2] - oz
        square = tx * tx + ty * ty + tz * tz
        # (p - q).q' along the curve itself bends by (p - q).q'' less its part along q'
        slope = vx * tx + vy * ty + vz * tz
        bend = square + vx * ox + vy * oy + vz * oz
        turn = slope / max(bend, LEAST_BEND * square)
        limit = LONGEST_STEP * sqrt((vx * vx + vy * vy + vz * vz) / square)
        half = 0.5 * min(max(turn, -limit), limit)
        length = abs(half)
        over = 1.0 + half * half
        cc, ss = (1.0 - half * half) / over, 2.0 * half / over
        c, s = c * cc - s * ss, s * cc + c * ss
        if length <= 1e-16 or (length >= before and length <= 1e-13):
            break
        before = length
    length = sqrt(c * c + s * s)
    c, s = c / length, s / length
    return (
        data[0] + c * data[3] + s * data[6],
        data[1] + c * data[4] + s * data[7],
        data[2] + c * data[5] + s * data[8],
    )
