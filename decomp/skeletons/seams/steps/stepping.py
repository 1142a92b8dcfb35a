"""Single steps along a seam with constant sites, compiled: ahead along it, and back onto it.

Points are kept in the rows of a track.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import inf, sqrt

import numpy as np

from decomp.carriers.compiled_carriers import Triple
from decomp.kernels.compiled import scalar
from decomp.kernels.records import Record
from decomp.skeletons.balls.balance import balance
from decomp.skeletons.balls.contact_rows import ContactRows, contact_rows
from decomp.skeletons.balls.supports import SupportTable
from decomp.vectors import Array

FLAT = 1e-7
"""Unit vectors that leave a plane by less than this lie in it."""
TURN = 0.9945
"""Cosine of the largest turn in a step, 6 degrees."""
RESIDUAL = 1e-12
"""Distances of a point from its contacts differ by less than this part of the size."""
ROUNDING = 1e-13
"""Of points, as a part of the size: short steps are swamped by it."""
OFF = 0.5
"""The point of a seam is farther or nearer than a step is long by less than this part of it."""
AHEAD = 0.9
"""Cosine of the largest angle between the tangent and the way to the next point."""


@dataclass(frozen=True, eq=False)
class Track(Record):
    """Room for the points of a seam with m contacts.

    Args:
        points: (n, 3).
        radius: (n,).
        tangents: (n, 3), in the sense of travel.
        slopes: (n,), how the radius changes along them.
        contacts: m of each point.
    """

    points: Array
    radius: Array
    tangents: Array
    slopes: Array
    contacts: ContactRows


def track(sites: Sequence[int], length: int, size: float) -> Track:
    """Room for `length` points of a seam with given sites, in a region of a given size."""
    return Track(
        np.empty((length, 3)),
        np.empty(length),
        np.empty((length, 3)),
        np.empty(length),
        contact_rows(np.tile(sites, (length, 1)), np.empty((length, len(sites), 3)), size),
    )


@scalar
def settle(
    table: SupportTable, track: Track, row: int, place: Triple, sense: Triple, strict: bool
) -> bool:
    """Put the point of the seam next to a place into a row of a track.

    Feet close by must stand in the row; `sense` is the sense of travel. If `strict`, the contacts
    must define a curve there.
    """
    contacts = track.contacts
    count, work, size = contacts.count, contacts.work, contacts.size
    first = row * count
    for c in range(count):
        if not abs(contacts.feet[first + c, 0]) < inf:
            return False
    x, y, z, radius, gap = balance(table, contacts, first, place[0], place[1], place[2])
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
    if tx * sense[0] + ty * sense[1] + tz * sense[2] < 0.0:
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
    table: SupportTable, track: Track, here: int, row: int, step: float, strict: bool
) -> bool:
    """Put the point of the seam a step ahead of row `here` into another row.

    If `strict`, the contacts must define a curve there, which turns little on the way.
    """
    contacts = track.contacts
    count, feet = contacts.count, contacts.feet
    for c in range(count):
        for j in range(3):
            feet[row * count + c, j] = feet[here * count + c, j]
    dx, dy, dz = track.tangents[here, 0], track.tangents[here, 1], track.tangents[here, 2]
    px, py, pz = track.points[here, 0], track.points[here, 1], track.points[here, 2]
    place = (px + step * dx, py + step * dy, pz + step * dz)
    if not settle(table, track, row, place, (dx, dy, dz), strict):
        return False
    wx, wy, wz = track.points[row, 0] - px, track.points[row, 1] - py, track.points[row, 2] - pz
    length = sqrt(wx * wx + wy * wy + wz * wz)
    rounding = ROUNDING * contacts.size
    if abs(length - abs(step)) > OFF * abs(step) + rounding:
        return False
    bend = track.tangents[row, 0] * dx + track.tangents[row, 1] * dy + track.tangents[row, 2] * dz
    ahead = (wx * dx + wy * dy + wz * dz) * (1.0 if step >= 0.0 else -1.0)
    return (bend >= TURN or not strict) and float(ahead) > AHEAD * length - rounding
