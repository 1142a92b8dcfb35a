"""The nearest point of an edge: closed form on lines and circles, Newton between samples elsewhere.

Notation: p the query point, a and b the signed distances to the two carriers of the edge, u in
[0, 1] the position on the chord between two samples, C(u) the curve's point across from it.
"""

from __future__ import annotations

from math import atan2, cos, inf, pi, sin, sqrt

from decomp.carriers.compiled_carriers import CarrierTable, Triple, normal, signed_distance
from decomp.kernels.compiled import inlined, inner, scalar
from decomp.tolerance import LAST_STEP, TINY
from decomp.vectors import Array

LINE, ARC, SAMPLED = range(3)
NEXT_TO_TOUCH = 1e-6
HASTE = 8
NEXT_TO_CONTACT = 1e-6
"""The part of a chord next to a point where two carriers touch that is looked at first."""
BESIDE_FARTHEST = 1e-3
"""How far beside a farthest point nearest ones are looked for, as a part of the way to a sample."""
FLAT_CHORD = 0.2
"""Less than this part of a chord p goes from ahead to behind along it, close to centres."""
CHORD_PARTS = 8
"""Into so many the chord is then cut."""
LEVEL_WITH = 1e-13
"""A point is neither ahead of another nor behind if it is so by this part of their distance."""
WHOLE_TURN = 2 * pi * (1 - 1e-12)
"""An arc of so much (radians) is a whole circle but for rounding."""
NARROWED = 1e-14
"""Part of a chord below which a level point is not looked for more closely."""


@inner
def line_foot(
    data: Array, e: int, x: float, y: float, z: float
) -> tuple[float, float, float, float]:
    """On a segment: start point (0:3), unit direction (3:6), length (9).

    Returns:
        The foot, and how far p's projection lies beyond the nearer end (0 if it is between them).
    """
    dx, dy, dz = data[e, 3], data[e, 4], data[e, 5]
    t = (x - data[e, 0]) * dx + (y - data[e, 1]) * dy + (z - data[e, 2]) * dz
    beyond = max(-t, t - data[e, 9], 0.0)
    t = min(max(t, 0.0), data[e, 9])
    return data[e, 0] + t * dx, data[e, 1] + t * dy, data[e, 2] + t * dz, beyond


@inner
def arc_foot(
    data: Array, e: int, x: float, y: float, z: float
) -> tuple[float, float, float, float]:
    """On an arc: centre (0:3), x (3:6), y (6:9), radius (9), first and last angle (10, 11).

    Returns:
        The foot, and the angle by which p lies beyond the nearer end (0 if between them).
    """
    vx, vy, vz = x - data[e, 0], y - data[e, 1], z - data[e, 2]
    u = vx * data[e, 3] + vy * data[e, 4] + vz * data[e, 5]
    v = vx * data[e, 6] + vy * data[e, 7] + vz * data[e, 8]
    start, span, beyond = data[e, 10], data[e, 11] - data[e, 10], 0.0
    rho = sqrt(u * u + v * v)
    if span < WHOLE_TURN or rho <= TINY:
        past = (atan2(v, u) - start) % (2 * pi)
        if past > span:
            beyond = min(2 * pi - past, past - span)
            past = 0.0 if 2 * pi - past == beyond else span
        u, v, rho = cos(start + past), sin(start + past), 1.0
    u, v = data[e, 9] * (u / rho), data[e, 9] * (v / rho)
    return (
        data[e, 0] + u * data[e, 3] + v * data[e, 6],
        data[e, 1] + u * data[e, 4] + v * data[e, 7],
        data[e, 2] + u * data[e, 5] + v * data[e, 8],
        beyond,
    )


@inlined
def circle_distance(data: Array, e: int, x: float, y: float, z: float) -> float:
    """Distance to the whole circle of an arc."""
    vx, vy, vz = x - data[e, 0], y - data[e, 1], z - data[e, 2]
    u = vx * data[e, 3] + vy * data[e, 4] + vz * data[e, 5]
    v = vx * data[e, 6] + vy * data[e, 7] + vz * data[e, 8]
    wx = vx - u * data[e, 3] - v * data[e, 6]
    wy = vy - u * data[e, 4] - v * data[e, 7]
    wz = vz - u * data[e, 5] - v * data[e, 8]
    out = sqrt(u * u + v * v) - data[e, 9]
    return sqrt(out * out + wx * wx + wy * wy + wz * wz)


@inner
def chord_foot(samples: Array, i: int, x: float, y: float, z: float) -> float:
    """Distance from the chord between samples i and i + 1."""
    ax, ay, az = samples[i, 0], samples[i, 1], samples[i, 2]
    wx, wy, wz = samples[i + 1, 0] - ax, samples[i + 1, 1] - ay, samples[i + 1, 2] - az
    square = wx * wx + wy * wy + wz * wz
    u = 0.0
    if square > 0.0:
        u = min(max(((x - ax) * wx + (y - ay) * wy + (z - az) * wz) / square, 0.0), 1.0)
    rx, ry, rz = x - ax - u * wx, y - ay - u * wy, z - az - u * wz
    return sqrt(rx * rx + ry * ry + rz * rz)


@inner
def curve_point(
    table: CarrierTable, a: int, b: int, samples: Array, i: int, u: float
) -> tuple[bool, float, float, float, float, float, float]:
    """C(u) between samples i and i + 1, and the curve's tangent there, not of unit length.

    The first value is False where the two carriers touch, so that there is no such point.
    """
    ax, ay, az = samples[i, 0], samples[i, 1], samples[i, 2]
    wx, wy, wz = samples[i + 1, 0] - ax, samples[i + 1, 1] - ay, samples[i + 1, 2] - az
    chord = sqrt(wx * wx + wy * wy + wz * wz)
    x, y, z = ax + u * wx, ay + u * wy, az + u * wz
    tx, ty, tz = wx, wy, wz
    if chord == 0.0:
        return False, x, y, z, tx, ty, tz
    wx, wy, wz = wx / chord, wy / chord, wz / chord
    for _ in range(8):
        nx, ny, nz = normal(table, a, x, y, z)
        mx, my, mz = normal(table, b, x, y, z)
        tx, ty, tz = ny * mz - nz * my, nz * mx - nx * mz, nx * my - ny * mx
        det = tx * wx + ty * wy + tz * wz
        if abs(det) < NEXT_TO_TOUCH:
            return False, x, y, z, tx, ty, tz
        da, db = signed_distance(table, a, x, y, z), signed_distance(table, b, x, y, z)
        # across the chord: n.step = -da, m.step = -db, w.step = 0
        x -= (da * (my * wz - mz * wy) + db * (wy * nz - wz * ny)) / det
        y -= (da * (mz * wx - mx * wz) + db * (wz * nx - wx * nz)) / det
        z -= (da * (mx * wy - my * wx) + db * (wx * ny - wy * nx)) / det
        if abs(da) + abs(db) <= LAST_STEP * chord:
            break
    if det < 0.0:
        tx, ty, tz = -tx, -ty, -tz
    return True, x, y, z, tx, ty, tz


@scalar
def chord_gap(table: CarrierTable, a: int, b: int, samples: Array, i: int) -> float:
    """Bound on the distance between the curve and the chord from sample i to the next."""
    wx, wy, wz = (
        samples[i + 1, 0] - samples[i, 0],
        samples[i + 1, 1] - samples[i, 1],
        samples[i + 1, 2] - samples[i, 2],
    )
    gap = 0.0
    for k in range(1, 4):
        u = 0.25 * k
        good, x, y, z, _, _, _ = curve_point(table, a, b, samples, i, u)
        if not good:
            return 0.25 * sqrt(wx * wx + wy * wy + wz * wz)
        rx, ry, rz = x - samples[i, 0] - u * wx, y - samples[i, 1] - u * wy, z - samples[i, 2]
        rz -= u * wz
        gap = max(gap, sqrt(rx * rx + ry * ry + rz * rz))
    return 1.5 * gap


@inner
def advance(
    table: CarrierTable, a: int, b: int, samples: Array, i: int, u: float, p: Triple
) -> tuple[bool, float, Triple]:
    """How far p lies ahead of C(u) along the tangent there, and C(u)."""
    good, x, y, z, tx, ty, tz = curve_point(table, a, b, samples, i, u)
    ahead = (p[0] - x) * tx + (p[1] - y) * ty + (p[2] - z) * tz
    # the tangent vanishes where carriers touch: its length must not count
    return good, ahead / max(sqrt(tx * tx + ty * ty + tz * tz), TINY), (x, y, z)


@inner
def away(p: Triple, q: Triple) -> float:
    """The distance between two points."""
    x, y, z = p[0] - q[0], p[1] - q[1], p[2] - q[2]
    return sqrt(x * x + y * y + z * z)


@inner
def from_end(
    table: CarrierTable, a: int, b: int, samples: Array, i: int, end: float, p: Triple
) -> tuple[float, bool, float, Triple]:
    """`advance` at an end, 0 or 1, of a chord, or beside it where that tells nothing.

    So it is where the carriers touch, and where p is neither ahead nor behind: it may be farthest.

    Returns:
        First u, then what `advance` returns.
    """
    u, off = end, NEXT_TO_CONTACT
    good, ahead, q = advance(table, a, b, samples, i, u, p)
    level = LEVEL_WITH * away(p, q)
    while (not good or abs(ahead) <= level) and off < 0.1:
        u = off if end == 0.0 else 1.0 - off
        good, ahead, q = advance(table, a, b, samples, i, u, p)
        off *= 4.0
    return u, good, ahead, q


@inner
def level_point(
    table: CarrierTable,
    a: int,
    b: int,
    samples: Array,
    i: int,
    span: tuple[float, float],
    ends: tuple[float, float],
    p: Triple,
) -> tuple[bool, float, Triple]:
    """Where p is neither ahead nor behind, between two places where it is (regula falsi, halving).

    Args:
        table, a, b, samples, i, p: as in `advance`.
        span: u of the places.
        ends: how far p is ahead at the first, above 0, and at the second, below 0.

    Returns:
        whether there is such a point, u, and the point.
    """
    (low, high), (ahead, behind) = span, ends
    least, at, best = inf, low, p
    for step in range(60):
        u = high - behind * (high - low) / (behind - ahead)
        if (step > HASTE and step % 2 == 0) or not low < u < high:
            # at a centre of curvature the function is so flat that secants creep, or do not move
            u = (low + high) / 2
        if not low < u < high:
            break
        good, value, q = advance(table, a, b, samples, i, u, p)
        if not good:
            return False, u, q
        # the last point need not be the best one: it can be a half
        if abs(value) < least:
            least, at, best = abs(value), u, q
        if value == 0.0:
            break
        if value > 0.0:
            factor = value / (value + ahead)
            low, ahead, behind = u, value, behind * (1.0 - factor)
        else:
            factor = value / (value + behind)
            high, behind, ahead = u, value, ahead * (1.0 - factor)
        if high - low < NARROWED:
            break
    return least < inf, at, best


@inner
def nearest_level(
    table: CarrierTable,
    a: int,
    b: int,
    samples: Array,
    i: int,
    span: tuple[float, float],
    ends: tuple[float, float],
    p: Triple,
) -> tuple[bool, Triple]:
    """The nearest point between two places as in `level_point`.

    The one found first can be the farthest between two that are nearest: p is behind before it.
    Then these are looked for on both sides of it.
    """
    found, u, best = level_point(table, a, b, samples, i, span, ends, p)
    if not found:
        return False, best
    before, after = u - BESIDE_FARTHEST * (u - span[0]), u + BESIDE_FARTHEST * (span[1] - u)
    good, value, _ = advance(table, a, b, samples, i, before, p)
    if not (good and value < 0.0):
        return True, best
    found, _, best = level_point(table, a, b, samples, i, (span[0], before), (ends[0], value), p)
    good, value, _ = advance(table, a, b, samples, i, after, p)
    if good and value > 0.0:
        good, _, q = level_point(table, a, b, samples, i, (after, span[1]), (value, ends[1]), p)
        if good and (not found or away(p, q) < away(p, best)):
            found, best = True, q
    return found, best


@inner
def between_samples(
    table: CarrierTable, a: int, b: int, samples: Array, i: int, p: Triple
) -> tuple[bool, Triple]:
    """The nearest point strictly between two samples, if there is one.

    Close to a centre of curvature there can be several, so they are looked for in parts.
    """
    low, good, ahead, q = from_end(table, a, b, samples, i, 0.0, p)
    high, good2, behind, r = from_end(table, a, b, samples, i, 1.0, p)
    if not (good and good2):
        return False, q
    if ahead - behind >= FLAT_CHORD * away(q, r):
        if not (ahead > 0.0 and behind < 0.0):
            return False, q
        return nearest_level(table, a, b, samples, i, (low, high), (ahead, behind), p)
    least, best, v, value = inf, q, low, ahead
    for k in range(1, CHORD_PARTS + 1):
        u, next_value = high, behind
        if k < CHORD_PARTS:
            u = low + k * (high - low) / CHORD_PARTS
            good, next_value, _ = advance(table, a, b, samples, i, u, p)
            if not good:
                return False, q
        # where p is neither ahead nor behind it is both, seen from the two sides
        if value >= 0.0 and next_value <= 0.0:
            ends = (max(value, TINY), min(next_value, -TINY))
            found, q = nearest_level(table, a, b, samples, i, (v, u), ends, p)
            if found and away(p, q) < least:
                least, best = away(p, q), q
        v, value = u, next_value
    return least < inf, best


@inner
def sampled_foot(
    table: CarrierTable,
    carriers: tuple[int, int],
    samples: Array,
    span: tuple[int, int],
    gap: float,
    p: Triple,
) -> tuple[float, float, float, int]:
    """On a curve through samples span[0] to span[1], at most `gap` away from their chords.

    Returns:
        The foot, and which sample it is (-1 for a point between two).
    """
    best, x, y, z, which = inf, 0.0, 0.0, 0.0, -1
    for i in range(span[0], span[1] + 1):
        rx, ry, rz = samples[i, 0] - p[0], samples[i, 1] - p[1], samples[i, 2] - p[2]
        square = rx * rx + ry * ry + rz * rz
        if square < best:
            best, x, y, z, which = square, samples[i, 0], samples[i, 1], samples[i, 2], i
    best = sqrt(best)
    for i in range(span[0], span[1]):
        if chord_foot(samples, i, p[0], p[1], p[2]) - gap >= best:
            continue
        found, q = between_samples(table, carriers[0], carriers[1], samples, i, p)
        if found:
            distance = away(p, q)
            if distance < best:
                best, x, y, z, which = distance, q[0], q[1], q[2], -1
    return x, y, z, which
