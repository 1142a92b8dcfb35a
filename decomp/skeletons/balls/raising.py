"""Points on a sheet over their feet, compiled: a sheet is a graph over its footprint (design: 3.4).

From a point's foot q on one of the two sites the ball that touches there grows along the direction
n into the region until it touches the other site: d(q + r n) = r. A distance changes no faster than
the place, so d(q + r n) - r falls, its root can be bracketed, and the search cannot miss it.
"""

from __future__ import annotations

from math import inf, sqrt

import numpy as np

from decomp.kernels.compiled import inner, scalar
from decomp.skeletons.balls.supports import FACE, SupportTable, support
from decomp.tolerance import CONVERGED
from decomp.vectors import Array, Bools, Ints, norm

STEPS = 200
AT_REST = 4e-16
"""Steps below this part of the size are the last ones."""


@inner
def grown(
    table: SupportTable,
    other: int,
    q: Array,
    n: Array,
    start: float,
    size: float,
    feet: Array,
    i: int,
) -> float:
    """The radius of the ball at q along n that touches another support; -1 if there is none.

    Newton's method within a bracket that shrinks at every step.

    Args:
        table: of supports.
        other: the one that is touched.
        q, n: (3,), where the ball stands and its unit normal.
        start: a first radius.
        size: of the region; balls are no larger.
        feet: (k, 3), of which row i holds a foot on the other support near by; replaced.
        i: the row.
    """
    low, high = 0.0, inf
    r = min(max(start, 1e-9 * size), size)
    for _ in range(STEPS):
        away, gx, gy, gz, hx, hy, hz = support(
            table,
            other,
            q[0] + r * n[0],
            q[1] + r * n[1],
            q[2] + r * n[2],
            feet[i, 0],
            feet[i, 1],
            feet[i, 2],
        )
        feet[i, 0], feet[i, 1], feet[i, 2] = hx, hy, hz
        off = away - r
        if off == 0.0:
            return r
        if off > 0.0:
            low = r
            if low >= size:
                return -1.0
        else:
            high = r
        slope = 1.0 - (gx * n[0] + gy * n[1] + gz * n[2])
        after = r + off / slope if slope > 0.0 else -1.0
        if not low < after < high or after > 2.0 * r:
            after = 2.0 * r if high == inf else 0.5 * (low + high)
        after = min(after, size)
        step, r = after - r, after
        if abs(step) <= AT_REST * size or high - low <= AT_REST * size:
            break
    if r <= CONVERGED * size:
        away, _, _, _, _, _, _ = support(
            table, other, q[0], q[1], q[2], feet[i, 0], feet[i, 1], feet[i, 2]
        )
        if away < -CONVERGED * size:
            return -1.0
    return r


@scalar
def raise_all(
    table: SupportTable,
    which: Ints,
    size: float,
    points: Array,
    feet: Array,
    touched: Array,
    placed: Array,
    radius: Array,
    q: Array,
    n: Array,
) -> None:
    """Fill in `placed` (k, 3) and `radius` (k,), which is -1 where there is no such point.

    Args:
        table: of supports.
        which: of them (k, 2); balls stand on the first and touch the second.
        size: of the region; balls are no larger.
        points: (k, 3).
        feet, touched: (k, 3), known ones on the first and second; replaced.
        placed, radius: filled in.
        q, n: scratch (3,).
    """
    for i in range(len(points)):
        x, y, z = points[i, 0], points[i, 1], points[i, 2]
        own = which[i, 0]
        away, gx, gy, gz, fx, fy, fz = support(
            table, own, x, y, z, feet[i, 0], feet[i, 1], feet[i, 2]
        )
        feet[i, 0], feet[i, 1], feet[i, 2] = fx, fy, fz
        q[0], q[1], q[2], n[0], n[1], n[2] = fx, fy, fz, gx, gy, gz
        radius[i] = -1.0
        length = sqrt(gx * gx + gy * gy + gz * gz)
        if length > 0.5 and (table.kinds[own] == FACE or away > 0.0):
            radius[i] = grown(table, which[i, 1], q, n, abs(away), size, touched, i)
        for j in range(3):
            placed[i, j] = q[j] + radius[i] * n[j]


def raised(
    table: SupportTable, size: float, which: Ints, points: Array, feet: Array
) -> tuple[Array, Array, Bools]:
    """Points at equal distance from two supports each, over feet of given points.

    Of the two points over the feet on either support the nearer one is taken.

    Args:
        table: of supports.
        size: of the region.
        which: of them (k, 2).
        points: (k, 3).
        feet: (k, 2, 3), on each support, or close to it.

    Returns:
        The points (k, 3), their feet (k, 2, 3), and whether there is one (k,).
    """
    points = np.ascontiguousarray(points, dtype=np.float64)
    found, gap = np.array(points), np.full(len(points), np.inf)
    touched = np.array(feet, dtype=np.float64)
    for order in ((0, 1), (1, 0)):
        pair = np.ascontiguousarray(which[:, order], dtype=np.int64)
        own, far_feet = (np.array(feet[:, k], dtype=np.float64) for k in order)
        placed, radius = np.empty_like(points), np.empty(len(points))
        scratch = np.empty((2, 3))
        raise_all(table, pair, size, points, own, far_feet, placed, radius, *scratch)
        far = np.where(radius >= 0.0, norm(placed - points), np.inf)
        better = np.flatnonzero(far < gap)
        found[better], gap[better] = placed[better], far[better]
        touched[better, order[0]], touched[better, order[1]] = own[better], far_feet[better]
    return found, touched, np.isfinite(gap)


@scalar
def grow_all(
    table: SupportTable,
    others: Ints,
    size: float,
    q: Array,
    n: Array,
    guess: Array,
    feet: Array,
    radius: Array,
) -> None:
    """Fill in radii (k,) of balls at q along n (k, 3) that touch others (k,), see `grown`."""
    for i in range(len(q)):
        radius[i] = grown(table, others[i], q[i], n[i], guess[i], size, feet, i)


def touching_radii(
    table: SupportTable, size: float, others: Ints, q: Array, n: Array, guess: Array, feet: Array
) -> Array:
    """Radii (k,) of the balls that stand on points and touch a support each; nan if there is none.

    Args:
        table: of supports.
        size: of the region.
        others: the supports (k,).
        q, n: (k, 3), points and unit normals into the region.
        guess: (k,), first radii.
        feet: (k, 3), on the supports near where they are touched.
    """
    radius = np.empty(len(q))
    points, ways = (np.ascontiguousarray(a, dtype=np.float64) for a in (q, n))
    start = np.ascontiguousarray(guess, dtype=np.float64)
    which = np.ascontiguousarray(others, dtype=np.int64)
    grow_all(table, which, size, points, ways, start, np.array(feet, np.float64), radius)
    return np.where(radius < 0.0, np.nan, radius)
