"""Points on a sheet over their feet: a sheet is a graph over its footprint (design: 3.4), compiled.

From a point's foot q on one of the two sites the ball that touches there grows along the direction n
into the region until it touches the other site: d(q + r n) = r. A distance changes no faster than the
place, so d(q + r n) - r falls, its root can be bracketed, and the search cannot miss it.
"""

from __future__ import annotations

from math import sqrt

import numpy as np

from decomp.tracing.compiled import inner, scalar
from decomp.tracing.supports import FACE, SupportTable, support
from decomp.vectors import Array, Bools, Ints, norm

DOUBLINGS, HALVINGS = 60, 120


@inner
def excess(
    table: SupportTable, other: int, q: Array, n: Array, r: float, foot: Array, i: int, c: int
) -> float:
    """By how much a ball's centre is farther from another support than from q, r away along n."""
    x, y, z = q[0] + r * n[0], q[1] + r * n[1], q[2] + r * n[2]
    away, _, _, _, fx, fy, fz = support(
        table, other, x, y, z, foot[i, c, 0], foot[i, c, 1], foot[i, c, 2]
    )
    foot[i, c, 0], foot[i, c, 1], foot[i, c, 2] = fx, fy, fz
    return float(away - r)


@inner
def grown(
    table: SupportTable,
    other: int,
    q: Array,
    n: Array,
    start: float,
    largest: float,
    feet: Array,
    i: int,
    c: int,
) -> float:
    """The radius of the ball at q along n that touches another support; -1 if there is none."""
    if excess(table, other, q, n, 0.0, feet, i, c) < 0.0:
        return -1.0
    low, high = 0.0, max(start, 1e-9 * largest)
    for _ in range(DOUBLINGS):
        if excess(table, other, q, n, high, feet, i, c) <= 0.0:
            break
        low, high = high, 2.0 * high
        if low > largest:
            return -1.0
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        if middle <= low or middle >= high:
            break
        if excess(table, other, q, n, middle, feet, i, c) > 0.0:
            low = middle
        else:
            high = middle
    return 0.5 * (low + high)


@scalar
def raise_all(
    table: SupportTable,
    which: Ints,
    size: float,
    points: Array,
    feet: Array,
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
        feet: (k, 2, 3), known ones near by; replaced.
        placed, radius: filled in.
        q, n: scratch (3,).
    """
    for i in range(len(points)):
        x, y, z = points[i, 0], points[i, 1], points[i, 2]
        own = which[i, 0]
        away, gx, gy, gz, fx, fy, fz = support(
            table, own, x, y, z, feet[i, 0, 0], feet[i, 0, 1], feet[i, 0, 2]
        )
        feet[i, 0, 0], feet[i, 0, 1], feet[i, 0, 2] = fx, fy, fz
        q[0], q[1], q[2], n[0], n[1], n[2] = fx, fy, fz, gx, gy, gz
        radius[i] = -1.0
        length = sqrt(gx * gx + gy * gy + gz * gz)
        if length > 0.5 and (table.kinds[own] == FACE or away > 0.0):
            radius[i] = grown(table, which[i, 1], q, n, abs(away), size, feet, i, 1)
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
        own = np.ascontiguousarray(np.asarray(feet, dtype=np.float64)[:, order])
        placed, radius = np.empty_like(points), np.empty(len(points))
        raise_all(table, pair, size, points, own, placed, radius, np.empty(3), np.empty(3))
        far = np.where(radius >= 0.0, norm(placed - points), np.inf)
        better = np.flatnonzero(far < gap)
        found[better], gap[better] = placed[better], far[better]
        touched[better] = own[better][:, order]
    return found, touched, np.isfinite(gap)
