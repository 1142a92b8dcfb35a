"""Which of many carriers may meet each other: cheap rejections."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from decomp.carriers import Carrier, Cylinder, Plane, Sphere, Torus
from decomp.carriers.table import CarrierTable
from decomp.tolerance import EXACTLY_PARALLEL
from decomp.vectors import Array, Bools, Ints, dot, norm

PAIRS_AT_ONCE = 2_000_000
DRIFT = 1e-14
"""Axes that move apart by less are parallel, however small the tolerance is; a length."""


def may_meet(a: Carrier, b: Carrier, tolerance: float) -> bool:
    """False if the two carriers certainly have no common point, even within `tolerance`."""
    table = CarrierTable([a, b])
    one, two = np.array([0]), np.array([1])
    return bool(_may_meet(table, one, two, None, 0.0, tolerance)[0])


def meeting_pairs(
    carriers: Sequence[Carrier], centre: Array, radius: float, tolerance: float
) -> list[tuple[int, int]]:
    """Pairs (i, j), i < j, of carriers that may meet inside the ball (centre, radius)."""
    table = CarrierTable(carriers)
    centre = np.asarray(centre, dtype=np.float64)
    reach = radius + tolerance
    near = np.nonzero(np.abs(table.distances(centre[None])[:, 0]) <= reach)[0]
    pairs: list[tuple[int, int]] = []
    rows = max(1, PAIRS_AT_ONCE // max(len(near), 1))
    for start in range(0, len(near), rows):
        block = near[start : start + rows]
        i, j = np.nonzero(block[:, None] < near[None, :])
        one, two = block[i], near[j]
        keep = _may_meet(table, one, two, centre, radius, tolerance)
        pairs += list(zip(one[keep].tolist(), two[keep].tolist(), strict=True))
    return pairs


def _may_meet(
    table: CarrierTable, i: Ints, j: Ints, centre: Array | None, radius: float, tolerance: float
) -> Bools:
    """Tell for each pair whether it may meet; without a centre, anywhere in space."""
    swap = table.kinds[i] > table.kinds[j]
    i, j = np.where(swap, j, i), np.where(swap, i, j)
    keep = np.ones(len(i), dtype=bool)
    kinds = table.kinds
    for code in (Sphere.code, Torus.code):
        for ball, other in ((i, j), (j, i)):
            rows = np.nonzero((kinds[ball] == code) & keep)[0]
            keep[rows] = _ball_meets(table, ball[rows], other[rows], tolerance)
    both = (kinds[i] == Plane.code) & (kinds[j] == Plane.code)
    rows = np.nonzero(both)[0]
    keep[rows] = _planes(table, i[rows], j[rows], centre, radius, tolerance)
    rows = np.nonzero((kinds[i] == Plane.code) & (kinds[j] == Cylinder.code))[0]
    keep[rows] = _plane_cylinder(table, i[rows], j[rows], centre, radius, tolerance)
    rows = np.nonzero((kinds[i] == Cylinder.code) & (kinds[j] == Cylinder.code))[0]
    keep[rows] = _cylinders(table, i[rows], j[rows], centre, radius, tolerance)
    return keep


def _ball_meets(table: CarrierTable, ball: Ints, other: Ints, tolerance: float) -> Bools:
    """A signed distance at a ball's centre tells whether the carrier reaches into the ball."""
    result = np.ones(len(ball), dtype=bool)
    order = np.argsort(ball, kind="stable")
    cuts = np.nonzero(np.diff(ball[order]))[0] + 1
    for group in np.split(order, cuts) if len(order) else []:
        row = table.rows[ball[group[0]]]
        distance = table.distances(row[None, :3], other[group])[:, 0]
        torus = table.kinds[ball[group[0]]] == Torus.code
        reach = row[6] + row[7] + tolerance
        hollow = row[6] - row[7] if torus else row[6]
        result[group] = np.abs(distance) <= reach
        # a sphere or torus that keeps inside a ball which the other ball surface surrounds
        spheres = table.kinds[other[group]] == Sphere.code
        gap = norm(table.rows[other[group], :3] - row[:3]) + table.rows[other[group], 6]
        result[group] &= ~(spheres & (gap < hollow - tolerance))
    return result


def _planes(
    table: CarrierTable, i: Ints, j: Ints, centre: Array | None, radius: float, tolerance: float
) -> Bools:
    """The common line's distance from the centre: solve both planes in span(n_a, n_b)."""
    a, b = table.rows[i], table.rows[j]
    cross = np.cross(a[:, 3:6], b[:, 3:6])
    size = norm(cross)
    if centre is None:
        gap = np.abs(dot(a[:, :3] - b[:, :3], a[:, 3:6]))
        return np.asarray((size > EXACTLY_PARALLEL) | (gap <= tolerance))
    fa = dot(centre - a[:, :3], a[:, 3:6])[:, None]
    fb = dot(centre - b[:, :3], b[:, 3:6])[:, None]
    foot = np.cross(fa * b[:, 3:6] - fb * a[:, 3:6], cross)
    return np.asarray((size * radius > tolerance) & (norm(foot) <= (radius + tolerance) * size**2))


def _plane_cylinder(
    table: CarrierTable, i: Ints, j: Ints, centre: Array | None, radius: float, tolerance: float
) -> Bools:
    """In the window the axis comes no nearer to the plane than at its ends there."""
    a, b = table.rows[i], table.rows[j]
    n, k = a[:, 3:6], b[:, 3:6]
    slope = np.abs(dot(n, k))
    if centre is None:
        distance = np.abs(dot(b[:, :3] - a[:, :3], n))
        return np.asarray((slope > EXACTLY_PARALLEL) | (distance <= b[:, 6] + tolerance))
    middle = b[:, :3] + dot(centre - b[:, :3], k)[:, None] * k
    distance = np.abs(dot(middle - a[:, :3], n))
    across = np.sqrt(np.maximum(1 - slope**2, 0.0))
    return np.asarray(distance <= b[:, 6] * across + slope * radius + tolerance)


def _cylinders(
    table: CarrierTable, i: Ints, j: Ints, centre: Array | None, radius: float, tolerance: float
) -> Bools:
    """Distance of the axes; in a window, of the axes' parts there; parallel ones may nest."""
    a, b = table.rows[i], table.rows[j]
    ka, kb, r, s = a[:, 3:6], b[:, 3:6], a[:, 6], b[:, 6]
    cross = np.cross(ka, kb)
    sine = norm(cross)
    reach = radius if centre is not None else 0.0
    start = np.zeros(3) if centre is None else centre
    pa = a[:, :3] + dot(start - a[:, :3], ka)[:, None] * ka
    pb = b[:, :3] + dot(start - b[:, :3], kb)[:, None] * kb
    away = pb - pa
    parallel = sine * max(reach, 1.0) <= max(tolerance, DRIFT)
    side = norm(away - dot(away, ka)[:, None] * ka)
    apart = (side > r + s + tolerance) | (side < np.abs(r - s) - tolerance)
    gap = np.abs(dot(away, cross)) / np.where(sine > 0, sine, 1.0)
    far = gap > r + s + tolerance
    if centre is not None:
        # points of the window lie within `radius` along each axis of these middle points
        far |= side > r + s + sine * reach + tolerance
    return np.where(parallel, ~apart, ~far)
