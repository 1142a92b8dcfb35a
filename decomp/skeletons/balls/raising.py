"""Points on a sheet over their feet, compiled: a sheet is a graph over its footprint (design: 3.4).

From a point's foot q on one of the two sites the ball that touches there grows along the direction
n into the region until it touches the other site: d(q + r n) = r. A distance changes no faster than
the place, so d(q + r n) - r falls, its root can be bracketed, and the search cannot miss it.
"""

from __future__ import annotations

from math import inf

import numpy as np

from decomp.kernels.compiled import inner, scalar
from decomp.skeletons.balls.fields import support_fields
from decomp.skeletons.balls.supports import FACE, SupportTable, support
from decomp.tolerance import CONVERGED
from decomp.vectors import Array, Bools, Ints, norm

STEPS = 200
AT_REST = 4e-16
"""Steps below this part of the size are the last ones."""
LEAST = 1e-9
"""The first radius is at least this part of the size."""
UNIT = 0.5
"""Gradients are of unit length, or 0 at a point of an edge or a vertex itself."""


@inner
def grown(
    table: SupportTable,
    other: int,
    q: Array,
    n: Array,
    start: float,
    size: float,
    near: Array,
) -> float:
    """The radius of the ball at q along n that touches another support; -1 if there is none.

    Newton's method within a bracket that shrinks at every step.

    Args:
        table: of supports.
        other: the one that is touched.
        q, n: (3,), where the ball stands and its unit normal.
        start: a first radius.
        size: of the region; balls are no larger.
        near: (3,), a foot on the other support near by; replaced.
    """
    low, high = 0.0, inf
    r = min(max(start, LEAST * size), size)
    for _ in range(STEPS):
        x, y, z = q[0] + r * n[0], q[1] + r * n[1], q[2] + r * n[2]
        away, gx, gy, gz, hx, hy, hz = support(table, other, x, y, z, near[0], near[1], near[2])
        near[0], near[1], near[2] = hx, hy, hz
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
        away, _, _, _, _, _, _ = support(table, other, q[0], q[1], q[2], near[0], near[1], near[2])
        if away < -CONVERGED * size:
            return -1.0
    return r


@scalar
def grow_all(
    table: SupportTable,
    which: Ints,
    size: float,
    at: Array,
    start: Array,
    feet: Array,
    radius: Array,
) -> None:
    """Fill in radii (k,) of balls that touch supports (k,), see `grown`.

    Args:
        table, size: as there.
        which: supports (k,).
        at: (k, 2, 3), where the balls stand, and unit normals.
        start: first radii (k,).
        feet: (k, 3), near by on the supports; replaced.
        radius: filled in.
    """
    for i in range(len(at)):
        radius[i] = grown(table, which[i], at[i, 0], at[i, 1], start[i], size, feet[i])


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
        own, other = (np.ascontiguousarray(which[:, k], dtype=np.int64) for k in order)
        under = support_fields(table, own, points, feet[:, order[0]])
        far_feet = np.array(feet[:, order[1]], dtype=np.float64)
        # inside the region, or beside a face: its distance has a sign
        stands = np.flatnonzero(
            (norm(under.gradient) > UNIT) & ((table.kinds[own] == FACE) | (under.distance > 0.0))
        )
        radius = np.full(len(points), -1.0)
        radius[stands], far_feet[stands] = _grown_at(
            table,
            size,
            other[stands],
            np.stack([under.foot[stands], under.gradient[stands]], axis=1),
            np.abs(under.distance[stands]),
            far_feet[stands],
        )
        placed = under.foot + radius[:, None] * under.gradient
        far = np.where(radius >= 0.0, norm(placed - points), np.inf)
        better = np.flatnonzero(far < gap)
        found[better], gap[better] = placed[better], far[better]
        touched[better, order[0]] = under.foot[better]
        touched[better, order[1]] = far_feet[better]
    return found, touched, np.isfinite(gap)


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
    radius, _ = _grown_at(table, size, others, np.stack([q, n], axis=1), guess, feet)
    return np.where(radius < 0.0, np.nan, radius)


def _grown_at(
    table: SupportTable, size: float, which: Ints, at: Array, start: Array, feet: Array
) -> tuple[Array, Array]:
    """Radii (k,), and the feet (k, 3) where they touch, see `grow_all`."""
    radius, touched = np.empty(len(at)), np.array(feet, dtype=np.float64)
    grow_all(
        table,
        np.ascontiguousarray(which, dtype=np.int64),
        size,
        np.ascontiguousarray(at, dtype=np.float64),
        np.ascontiguousarray(start, dtype=np.float64),
        touched,
        radius,
    )
    return radius, touched
