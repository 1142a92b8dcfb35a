"""The nearest point of an elliptic cylinder's cross-section, compiled; see `point_ellipse`."""

from __future__ import annotations

from math import hypot, sqrt

from decomp.carriers.point_ellipse import AT_REST, CLEAR, MOST_STEPS, ON_MAJOR
from decomp.kernels.compiled import inner
from decomp.vectors import Array

Five = tuple[float, float, float, float, float]


@inner
def ellipse_foot(u: float, v: float, a: float, b: float) -> tuple[float, float]:
    """Cosine and sine of the point (a c, b s) nearest to (u, v), a >= b."""
    q = (a - b) * (a + b) / (b * b)
    along, across = a / b * (a / b) * (abs(u) / a), abs(v) / b
    if across <= ON_MAJOR:
        c, s = 1.0, 0.0
        if along < q:
            c = along / q
            s = sqrt((1.0 - c) * (1.0 + c))
    else:
        least = max(across, along - q)
        t = least
        if along < (least + q) * (1.0 - CLEAR):
            c = along / (least + q)
            c = along / (across / sqrt((1.0 - c) * (1.0 + c)) + q)
            t = max(t, across / sqrt((1.0 - c) * (1.0 + c)))
        for _ in range(MOST_STEPS):
            c, s = along / (t + q), across / t
            size = hypot(c, s)
            step = size * size * (size - 1.0) / (c * c / (t + q) + s * s / t)
            t = max(t + step, least)
            if abs(step) <= AT_REST * t:
                break
        c, s = along / (t + q), across / t
        size = hypot(c, s)
        c, s = c / size, s / size
    return (-c if u < 0.0 else c), (-s if v < 0.0 else s)


@inner
def elliptic_axes(packed: Array, k: int) -> tuple[float, float, float]:
    """The direction of an elliptic cylinder's minor semi-axis."""
    ax, ay, az = packed[k, 3], packed[k, 4], packed[k, 5]
    bx, by, bz = packed[k, 8], packed[k, 9], packed[k, 10]
    return ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx


@inner
def elliptic_split(packed: Array, k: int, x: float, y: float, z: float) -> Five:
    """Height, coordinates along both semi-axes, and cosine and sine of the nearest point."""
    vx, vy, vz = x - packed[k, 0], y - packed[k, 1], z - packed[k, 2]
    yx, yy, yz = elliptic_axes(packed, k)
    height = vx * packed[k, 3] + vy * packed[k, 4] + vz * packed[k, 5]
    u = vx * packed[k, 8] + vy * packed[k, 9] + vz * packed[k, 10]
    v = vx * yx + vy * yy + vz * yz
    c, s = ellipse_foot(u, v, packed[k, 6], packed[k, 7])
    return height, u, v, c, s


@inner
def elliptic_distance(packed: Array, k: int, x: float, y: float, z: float) -> float:
    """Signed distance to an elliptic cylinder."""
    _, u, v, c, s = elliptic_split(packed, k, x, y, z)
    a, b = packed[k, 6], packed[k, 7]
    return float((b * c * (u - a * c) + a * s * (v - b * s)) / hypot(b * c, a * s))


@inner
def elliptic_normal(
    packed: Array, k: int, x: float, y: float, z: float
) -> tuple[float, float, float]:
    """Outward unit normal of an elliptic cylinder at the foot of a point."""
    _, _, _, c, s = elliptic_split(packed, k, x, y, z)
    a, b = packed[k, 6], packed[k, 7]
    length = hypot(b * c, a * s)
    p, q = b * c / length, a * s / length
    yx, yy, yz = elliptic_axes(packed, k)
    return p * packed[k, 8] + q * yx, p * packed[k, 9] + q * yy, p * packed[k, 10] + q * yz


@inner
def elliptic_foot(
    packed: Array, k: int, x: float, y: float, z: float
) -> tuple[float, float, float]:
    """The nearest point of an elliptic cylinder."""
    height, _, _, c, s = elliptic_split(packed, k, x, y, z)
    p, q = packed[k, 6] * c, packed[k, 7] * s
    yx, yy, yz = elliptic_axes(packed, k)
    return (
        packed[k, 0] + height * packed[k, 3] + p * packed[k, 8] + q * yx,
        packed[k, 1] + height * packed[k, 4] + p * packed[k, 9] + q * yy,
        packed[k, 2] + height * packed[k, 5] + p * packed[k, 10] + q * yz,
    )


@inner
def elliptic_bend(packed: Array, k: int, x: float, y: float, z: float) -> float:
    """Curvature of the section at the foot of a point."""
    _, _, _, c, s = elliptic_split(packed, k, x, y, z)
    a, b = packed[k, 6], packed[k, 7]
    return float(a * b / hypot(b * c, a * s) ** 3)
