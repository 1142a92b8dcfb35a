"""Points of a carrier around a given one, for each combination of sides that other carriers leave.

Where several carriers hold a point, not all combinations of their signs occur around it: outside
a plane that is tangent to a cylinder there is no point of the cylinder. On a small circle around
the point, drawn on its carrier, each of the others changes sign at some angles. Between
neighbouring angles, of whichever carriers, the signs are constant, so points there show all that
occur.
"""

from __future__ import annotations

from math import cos, pi, sin

from decomp.carriers.compiled_carriers import (
    CarrierTable,
    Triple,
    at_tip,
    foot,
    normal,
    perpendicular_to,
    signed_distance,
)
from decomp.kernels.compiled import inner
from decomp.vectors import Array, Ints

CIRCLE_SAMPLES = 32
"""Points of a circle between which signs are compared."""
MOST_TURNS = 96
"""At so many angles signs may change; of more, the rest is left out."""
BETWEEN_CHANGES = (0.5, 0.27, 0.81)
"""Where points are taken between two changes: in the middle a carrier may touch by symmetry."""
ROOM = CIRCLE_SAMPLES + len(BETWEEN_CHANGES) * MOST_TURNS
"""Most points of a circle."""
CIRCLE_BISECTIONS = 45
CROSSING = 1e-3
"""Carriers cross where the sine of their angle, or the volume of three normals, is above this."""
ONE_CHANGE = 1e-9
"""Changes nearer to each other than this angle are one."""


@inner
def point_nearby(
    table: CarrierTable, carrier: int, q: Triple, radius: float, angle: float
) -> Triple:
    """The point of a carrier at a small distance from its point q, in a direction.

    Around an apex that is as close the circle runs around the cone.
    """
    x, y, z = q
    packed = table.packed
    nx, ny, nz = normal(table, carrier, x, y, z)
    if at_tip(table, carrier, x, y, z, radius):
        px, py, pz = packed[carrier, 0], packed[carrier, 1], packed[carrier, 2]
        kx, ky, kz = packed[carrier, 3], packed[carrier, 4], packed[carrier, 5]
        ax, ay, az = perpendicular_to(kx, ky, kz)
        bx, by, bz = ky * az - kz * ay, kz * ax - kx * az, kx * ay - ky * ax
        along = 2.0 * radius * packed[carrier, 7]
        c = 2.0 * radius * packed[carrier, 6] * cos(angle)
        s = 2.0 * radius * packed[carrier, 6] * sin(angle)
        return (
            px + along * kx + c * ax + s * bx,
            py + along * ky + c * ay + s * by,
            pz + along * kz + c * az + s * bz,
        )
    ax, ay, az = perpendicular_to(nx, ny, nz)
    bx, by, bz = ny * az - nz * ay, nz * ax - nx * az, nx * ay - ny * ax
    c, s = radius * cos(angle), radius * sin(angle)
    return foot(
        table,
        carrier,
        x + c * ax + s * bx,
        y + c * ay + s * by,
        z + c * az + s * bz,
    )


@inner
def _gap(
    table: CarrierTable, carrier: int, other: int, q: Triple, radius: float, angle: float
) -> float:
    """Signed distance of another carrier from the point in a direction."""
    x, y, z = point_nearby(table, carrier, q, radius, angle)
    return float(signed_distance(table, other, x, y, z))


@inner
def _turn(
    table: CarrierTable,
    carrier: int,
    other: int,
    q: Triple,
    radius: float,
    low: float,
    high: float,
    before: float,
) -> float:
    """The angle between two at which another carrier changes sign from that of `before`."""
    for _ in range(CIRCLE_BISECTIONS):
        middle = (low + high) / 2
        if (_gap(table, carrier, other, q, radius, middle) < 0.0) == (before < 0.0):
            low = middle
        else:
            high = middle
    return (low + high) / 2


@inner
def points_nearby(
    table: CarrierTable,
    carrier: int,
    others: Ints,
    count: int,
    q: Triple,
    radius: float,
    turns: Array,
    points: Array,
) -> int:
    """Fill in points of a carrier at a small distance from its point q.

    Args:
        table, carrier: the carrier.
        others, count: carriers whose signs are to be told, the first `count` of an array.
        q: a point of the carrier.
        radius: the distance.
        turns: scratch (MOST_TURNS,).
        points: (ROOM, 3), filled in.

    Returns:
        How many points there are.
    """
    found, step = 0, 2.0 * pi / CIRCLE_SAMPLES
    for j in range(count):
        first = _gap(table, carrier, others[j], q, radius, 0.0)
        before = first
        for i in range(1, CIRCLE_SAMPLES + 1):
            here = first
            if i < CIRCLE_SAMPLES:
                here = _gap(table, carrier, others[j], q, radius, i * step)
            if (before < 0.0) != (here < 0.0) and found < MOST_TURNS:
                low, high = (i - 1) * step, i * step
                angle = _turn(table, carrier, others[j], q, radius, low, high, before)
                place = found
                while place > 0 and turns[place - 1] > angle:
                    turns[place] = turns[place - 1]
                    place -= 1
                turns[place] = angle
                found += 1
            before = here
    made = 0
    for k in range(found):
        low = turns[k]
        high = turns[k + 1] if k + 1 < found else turns[0] + 2.0 * pi
        if high - low <= ONE_CHANGE:
            continue
        for part in BETWEEN_CHANGES:
            x, y, z = point_nearby(table, carrier, q, radius, low + part * (high - low))
            points[made, 0], points[made, 1], points[made, 2] = x, y, z
            made += 1
    for i in range(CIRCLE_SAMPLES):
        # off the circle's symmetric places
        x, y, z = point_nearby(table, carrier, q, radius, (i + 0.377) * step)
        points[made, 0], points[made, 1], points[made, 2] = x, y, z
        made += 1
    return made


@inner
def in_general_position(
    table: CarrierTable, carrier: int, others: Ints, count: int, q: Triple, near: float
) -> bool:
    """Whether one or two other carriers cross a carrier at its point q, and each other there.

    Then all combinations of their signs occur around the point.

    Args:
        table, carrier, others, count, q: see `points_nearby`.
        near: nothing is said this close to an apex, which has no normal.
    """
    if count > 2:
        return False
    x, y, z = q
    for j in range(-1, count):
        k = carrier if j < 0 else others[j]
        if at_tip(table, k, x, y, z, near):
            return False
    nx, ny, nz = normal(table, carrier, x, y, z)
    ax, ay, az = normal(table, others[0], x, y, z)
    cx, cy, cz = ny * az - nz * ay, nz * ax - nx * az, nx * ay - ny * ax
    if count == 1:
        return bool(cx * cx + cy * cy + cz * cz >= CROSSING * CROSSING)
    bx, by, bz = normal(table, others[1], x, y, z)
    return bool(abs(cx * bx + cy * by + cz * bz) >= CROSSING)
