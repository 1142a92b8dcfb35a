"""Single steps along a seam with constant sites, compiled: ahead along it, and back onto it.

Points are kept in the rows of a track.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, sqrt

import numpy as np

from decomp.kernels.compiled import scalar
from decomp.kernels.records import Record
from decomp.skeletons.balls.balance import balance
from decomp.skeletons.balls.supports import SupportTable
from decomp.vectors import Array, Ints

FLAT = 1e-7
"""Unit vectors that leave a plane by less than this lie in it."""
TURN = 0.9945
"""Cosine of the largest turn in a step, 6 degrees."""
RESIDUAL = 1e-12


@dataclass(frozen=True, eq=False)
class Track(Record):
    """Room for the points of a seam with m contacts.

    Args:
        points: (n, 3).
        radius: (n,).
        tangents: (n, 3), in the sense of travel.
        slopes: (n,), how the radius changes along them.
        feet: (n * m, 3).
        work: scratch (m + 3, 7).
    """

    points: Array
    radius: Array
    tangents: Array
    slopes: Array
    feet: Array
    work: Array


def track(contacts: int, length: int) -> Track:
    """Room for `length` points."""
    return Track(
        np.empty((length, 3)),
        np.empty(length),
        np.empty((length, 3)),
        np.empty(length),
        np.empty((length * contacts, 3)),
        np.empty((contacts + 3, 7)),
    )


@scalar
def settle(
    table: SupportTable,
    which: Ints,
    track: Track,
    row: int,
    x: float,
    y: float,
    z: float,
    dx: float,
    dy: float,
    dz: float,
    size: float,
    strict: bool,
) -> bool:
    """Put the point of the seam next to (x, y, z) into a row of a track.

    Feet close by must stand in the row; (dx, dy, dz) is the sense of travel. If `strict`, the
    contacts must define a curve there.
    """
    count = len(which)
    work, first = track.work, row * count
    for c in range(count):
        if not abs(track.feet[first + c, 0]) < inf:
            return False
    x, y, z, radius, gap = balance(table, which, 0, count, track.feet, first, x, y, z, size, work)
    if not gap <= RESIDUAL * size or radius <= 0.0:
        return False
    rows, least, second, best = count - 1, inf, inf, 0
    for j in range(3):
        square = 0.0
        for k in range(rows):
            square += work[k, j] * work[k, j]
        if square < least:
            least, second, best = square, least, j
        elif square < second:
            second = square
    if strict and (second <= FLAT * FLAT or least > FLAT * FLAT):
        return False
    tx, ty, tz = work[rows, best], work[rows + 1, best], work[rows + 2, best]
    if tx * dx + ty * dy + tz * dz < 0.0:
        tx, ty, tz = -tx, -ty, -tz
    slope = 0.0
    for c in range(count):
        slope += work[c, 4] * tx + work[c, 5] * ty + work[c, 6] * tz
    track.points[row, 0], track.points[row, 1], track.points[row, 2] = x, y, z
    track.tangents[row, 0], track.tangents[row, 1], track.tangents[row, 2] = tx, ty, tz
    track.radius[row], track.slopes[row] = radius, slope / count
    return True


@scalar
def advance(
    table: SupportTable,
    which: Ints,
    track: Track,
    here: int,
    row: int,
    step: float,
    size: float,
    strict: bool,
) -> bool:
    """Put the point of the seam a step ahead of row `here` into another row.

    If `strict`, the contacts must define a curve there, which turns little on the way.
    """
    count = len(which)
    for c in range(count):
        for j in range(3):
            track.feet[row * count + c, j] = track.feet[here * count + c, j]
    dx, dy, dz = track.tangents[here, 0], track.tangents[here, 1], track.tangents[here, 2]
    px, py, pz = track.points[here, 0], track.points[here, 1], track.points[here, 2]
    good = settle(
        table,
        which,
        track,
        row,
        px + step * dx,
        py + step * dy,
        pz + step * dz,
        dx,
        dy,
        dz,
        size,
        strict,
    )
    if not good:
        return False
    wx, wy, wz = track.points[row, 0] - px, track.points[row, 1] - py, track.points[row, 2] - pz
    length = sqrt(wx * wx + wy * wy + wz * wz)
    # short steps are swamped by the rounding of the points
    rounding = 1e-13 * size
    if abs(length - abs(step)) > 0.5 * abs(step) + rounding:
        return False
    bend = track.tangents[row, 0] * dx + track.tangents[row, 1] * dy + track.tangents[row, 2] * dz
    ahead = (wx * dx + wy * dy + wz * dz) * (1.0 if step >= 0.0 else -1.0)
    return (bend >= TURN or not strict) and float(ahead) > 0.9 * length - rounding
