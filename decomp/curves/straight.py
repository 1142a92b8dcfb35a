"""Where a straight line meets many carriers at once, in closed form.

On a plane or quadric the line o + t d satisfies q t^2 + 2 h t + c = 0. A double
root is a touch; near one the line's least distance decides, as sqrt(h^2 - q c) is ill-conditioned.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np

from decomp.carriers.kinds import KINDS
from decomp.carriers.table import CarrierTable
from decomp.curves.crossings import crossings
from decomp.curves.line import Line
from decomp.curves.touching import CROSSINGS_APART, anywhere
from decomp.vectors import Array, Bools, Ints

NO_SQUARE = 1e-14
"""Coefficient of t^2, for a unit direction, up to which the equation is linear."""
SLOPE_STEP = 1e-6
"""Slopes of distances are differences over this part of the line, to both sides."""


@dataclass(frozen=True, eq=False)
class LineCrossings:
    """Meeting points of a line with carriers.

    Args:
        parameters: all t (k,), in no particular order.
        carriers: the carrier (k,) met at each.
        contained: indices of the carriers that hold the whole line.
    """

    parameters: Array
    carriers: Ints
    contained: Ints


TouchingEach = Callable[[int, Array], Bools]
"""The same as `Touching`, for a carrier by its number."""


def any_of_them(carrier: int, points: Array) -> Bools:
    """Every dip is a touch."""
    return anywhere(points)


def line_crossings(
    line: Line,
    table: CarrierTable,
    among: Ints,
    tolerance: float,
    touches: TouchingEach = any_of_them,
) -> LineCrossings:
    """Find all points in the line's domain where it meets or touches the carriers `among`.

    What `touches` tells is a touch, see `crossings`.
    """
    low, high = line.domain
    probes = line.point(np.array([low, 0.41 * low + 0.59 * high, high]))
    inside = (np.abs(table.distances(probes, among)) <= tolerance).all(axis=1)
    contained, rest = among[inside], among[~inside]
    steep = np.array([table.carriers[k].degree > 2 for k in rest], dtype=np.bool_)
    higher, rest = rest[steep], rest[~steep]
    t, which = _quadratic_roots(line, table, rest, tolerance, touches)
    for k in higher:
        met = crossings(line, table.carriers[k], tolerance, partial(touches, int(k)))
        t = np.concatenate([t, met.parameters])
        which = np.concatenate([which, np.full(len(met.parameters), k)])
    return LineCrossings(t, which, contained)


def _quadratic_roots(
    line: Line, table: CarrierTable, among: Ints, tolerance: float, touches: TouchingEach
) -> tuple[Array, Ints]:
    quadratic, half, constant = _coefficients(line, table, among)
    low, high = line.domain
    with np.errstate(divide="ignore", invalid="ignore"):
        middle = -half / quadratic
        # distance of the roots from the middle; negative squares that are touches count as zero
        square = middle**2 - constant / quadratic
        spread = np.sqrt(np.maximum(square, 0.0))
        single = -constant / (2 * half)
        below, above = middle - spread, middle + spread
    straight = np.abs(quadratic) <= NO_SQUARE
    touch = ~straight & _touches(line, table, among, middle, tolerance)
    for row in np.flatnonzero(touch & (2 * spread > CROSSINGS_APART * tolerance)):
        touch[row] = touches(int(among[row]), line.point(middle[row : row + 1]))[0]
    crossing = ~straight & ~touch & (square > 0)
    rows = np.arange(len(among))
    t = np.concatenate([single[straight], middle[touch], below[crossing], above[crossing]])
    which = np.concatenate([rows[straight], rows[touch], rows[crossing], rows[crossing]])
    within = np.isfinite(t) & (t >= low - tolerance) & (t <= high + tolerance)
    t, which = np.clip(t[within], low, high), which[within]
    t = _polished(line, table, among[which], t)
    on = np.abs(_own_distance(table, among[which], line.point(t))) <= tolerance
    return t[on], among[which[on]]


def _coefficients(line: Line, table: CarrierTable, among: Ints) -> tuple[Array, Array, Array]:
    quadratic, half, constant = (np.empty(len(among)) for _ in range(3))
    kinds = table.kinds[among]
    for code in np.unique(kinds).tolist():
        here = np.flatnonzero(kinds == code)
        found = KINDS[code].along_line(table.rows[among[here]], line.origin, line.direction)
        quadratic[here], half[here], constant[here] = found
    return quadratic, half, constant


def _touches(
    line: Line, table: CarrierTable, among: Ints, middle: Array, tolerance: float
) -> Bools:
    """Whether the point halfway between the roots is on the carrier itself."""
    result = np.zeros(len(among), dtype=np.bool_)
    rows = np.flatnonzero(np.isfinite(middle))
    points = line.point(middle[rows])
    result[rows] = np.abs(_own_distance(table, among[rows], points)) <= tolerance
    return result


def _polished(line: Line, table: CarrierTable, which: Ints, t: Array) -> Array:
    """One Newton step on the signed distance; not at touches, where its slope is zero."""
    points = line.point(t)
    distance = _own_distance(table, which, points)
    step = SLOPE_STEP * (line.domain[1] - line.domain[0])
    ahead = _own_distance(table, which, line.point(t + step))
    behind = _own_distance(table, which, line.point(t - step))
    slope = (ahead - behind) / (2 * step)
    steep = np.abs(slope) > 1e-3
    corrected = np.where(steep, t - distance / np.where(steep, slope, 1.0), t)
    return np.clip(corrected, *line.domain)


def _own_distance(table: CarrierTable, which: Ints, points: Array) -> Array:
    """Signed distance (k,) of each point to its own carrier."""
    result = np.empty(len(which))
    for carrier in np.unique(which):
        rows = which == carrier
        result[rows] = table.carriers[carrier].signed_distance(points[rows])
    return result
