"""The least and the greatest radius along the lines of a skeleton."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from decomp.complex.model import CurveElement
from decomp.skeletons.balls.queries import RegionQueries
from decomp.skeletons.curves.curve_elements import place_each
from decomp.vectors import Array, Ints

SECTIONS = 14
GOLDEN = (5**0.5 - 1) / 2
NOISE = 1e-14
"""Radii that differ by less than this part of the size are equal."""
NEAR_END = 1e-4
"""So far along a chord it is asked whether the radius grows or shrinks from its ends on."""

Range = tuple[float, float]


def ranges_along(
    queries: RegionQueries,
    curves: Sequence[CurveElement],
    lines: Sequence[Ints],
    points: Array,
    radius: Array,
) -> list[Range]:
    """Least and greatest radius along polylines of exact vertices.

    Args:
        queries: of the region.
        curves: that the vertices of each line lie on.
        lines: vertices in order.
        points: (n, 3) all vertices.
        radius: (n,) there.
    """
    if not lines:
        return []
    which = np.repeat(np.arange(len(lines)), [len(line) - 1 for line in lines])
    one = np.concatenate([line[:-1] for line in lines])
    two = np.concatenate([line[1:] for line in lines])
    inside = np.flatnonzero(np.maximum(radius[one], radius[two]) > 0)
    which, one, two = which[inside], one[inside], two[inside]
    first, way = points[one], points[two] - points[one]
    low = np.array([float(radius[line].min()) for line in lines])
    high = np.array([float(radius[line].max()) for line in lines])

    def at(rows: Ints, s: Array) -> Array:
        spots = first[rows] + s[:, None] * way[rows]
        return queries.depth(place_each(curves, which[rows], spots))[1]

    every = np.arange(len(which))
    starts = at(every, np.full(len(every), NEAR_END)) - radius[one]
    ends = at(every, np.full(len(every), 1 - NEAR_END)) - radius[two]
    for sign in (1.0, -1.0):
        turning = np.minimum(sign * starts, sign * ends) > NOISE * queries.size
        rows = np.flatnonzero(turning)
        if len(rows):
            found = _extrema(at, rows, sign)
            np.maximum.at(high, which[rows], found)
            np.minimum.at(low, which[rows], found)
    return [(float(a), float(b)) for a, b in zip(low, high, strict=True)]


def _extrema(at: Callable[[Ints, Array], Array], rows: Ints, sign: float) -> Array:
    """Extrema (k,) of functions of s from 0 to 1: golden sections, then the top of a parabola."""
    low, high = np.zeros(len(rows)), np.ones(len(rows))
    one, other = high - GOLDEN * (high - low), low + GOLDEN * (high - low)
    f, g = sign * at(rows, one), sign * at(rows, other)
    for _ in range(SECTIONS):
        left = f > g
        low, high = np.where(left, low, one), np.where(left, other, high)
        new = np.where(left, high - GOLDEN * (high - low), low + GOLDEN * (high - low))
        value = sign * at(rows, new)
        one, other = np.where(left, new, other), np.where(left, one, new)
        f, g = np.where(left, value, g), np.where(left, f, value)
    best, middle = np.maximum(f, g), np.where(f > g, one, other)
    width = high - low
    for _ in range(2):
        before, after = sign * at(rows, middle - width), sign * at(rows, middle + width)
        here = sign * at(rows, middle)
        bend = before - 2 * here + after
        curved = bend < -NOISE
        shift = np.where(curved, (before - after) / (2 * np.where(curved, bend, -1.0)), 0.0)
        middle = middle + width * np.clip(shift, -1, 1)
        best = np.maximum(best, here)
    return np.asarray(sign * np.maximum(best, sign * at(rows, middle)))
