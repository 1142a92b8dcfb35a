"""The nearest point of an ellipse.

The ellipse is (a c, b s) with c^2 + s^2 = 1 and a >= b. By symmetry a point (u, v) may be taken
from the first quadrant, where its nearest point is. With r = (a / b)^2 and q = r - 1 that is

    c = (r u / a) / (t + q),    s = (v / b) / t,

where t > 0 is the one root of c^2 + s^2 = 1. The left side falls and is convex, so Newton's method
for 1 / hypot(c, s) = 1, begun below the root, climbs to it and cannot miss it (the equation is the
classical one, D. Eberly, Distance from a point to an ellipse, an ellipsoid, or a hyperellipsoid,
2013, there in t - 1, whose digits are lost near the major axis). On the major axis t = 0 stands for
the two feet beside it.
"""

from __future__ import annotations

import numpy as np

from decomp.vectors import Array

MOST_STEPS = 60
AT_REST = 4e-16
"""Steps below this part of t are rounding."""
ON_MAJOR = 1e-290
"""Points nearer to the major axis than this part of b are on it."""
CLEAR = 1e-15
"""1 - c must be above rounding to tell anything."""


def nearest_on_ellipse(u: Array, v: Array, a: Array, b: Array) -> tuple[Array, Array]:
    """Cosine and sine (...) of the nearest points (a c, b s) to points (u, v).

    Where several are as near, on the evolute's axis, it is the one with s >= 0.

    Args:
        u: coordinates (...) along the major semi-axis.
        v: those along the minor one.
        a: major semi-axis, a number or (...).
        b: minor one, at most a.
    """
    u, v, a, b = np.broadcast_arrays(u, v, a, b)
    r, q = (a / b) ** 2, (a - b) * (a + b) / b**2
    along, across = r * (np.abs(u) / a), np.abs(v) / b
    on_axis = across <= ON_MAJOR
    z = np.where(on_axis, 1.0, across)
    least = np.maximum(z, along - q)
    t = np.maximum(least, _bound(along, z, q, least))
    moving = ~on_axis
    for _ in range(MOST_STEPS):
        if not moving.any():
            break
        c, s = along / (t + q), z / t
        size = np.hypot(c, s)
        step = size**2 * (size - 1) / (c**2 / (t + q) + s**2 / t)
        t = np.where(moving, np.maximum(t + step, least), t)
        moving = moving & (np.abs(step) > AT_REST * t)
    beside = on_axis & (along < q)
    c = np.where(on_axis, np.where(beside, along / np.where(beside, q, 1.0), 1.0), along / (t + q))
    s = np.where(on_axis, np.sqrt(np.maximum((1 - c) * (1 + c), 0.0)), z / t)
    size = np.hypot(c, s)
    return np.copysign(c / size, u), np.where(v < 0, -1.0, 1.0) * (s / size)


def _bound(along: Array, across: Array, q: Array, least: Array) -> Array:
    """A lower bound of t, close to it beside the major axis, where t is many times `across`.

    c falls with t: a lower bound of t gives an upper one of c and so, by c^2 + s^2 = 1, a lower one
    of s and an upper one of t, from which a better lower one follows in the same way.
    """
    c = np.minimum(along / (least + q), 1 - CLEAR)
    most = across / np.sqrt((1 - c) * (1 + c))
    c = np.minimum(along / (most + q), 1 - CLEAR)
    return np.where(along < (least + q) * (1 - CLEAR), across / np.sqrt((1 - c) * (1 + c)), least)
