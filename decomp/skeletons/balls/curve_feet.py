"""Feet on the curves in which two carriers meet, compiled: Newton's method from a known foot."""

from __future__ import annotations

from math import inf, sqrt

from decomp.carriers.compiled_carriers import (
    CarrierTable,
    Triple,
    normal,
    normal_curvature,
    signed_distance,
)
from decomp.kernels.compiled import inner

LEAST_BEND, LONGEST_STEP = 1e-5, 0.25
"""Close to a centre of curvature Newton's steps along an edge, which grow without bound there, are
divided by no less than this, and are no longer than this part of the distance."""
TOUCHING = 1e-7
"""Sine of the angle between carriers below which rounding decides where they meet."""
FOOT_STEPS = 60
AT_REST, ROUNDING = 1e-16, 1e-13
"""Steps below the first are the last ones; so are those below the second that do not shrink."""


@inner
def curve_foot(
    table: CarrierTable,
    a: int,
    b: int,
    x: float,
    y: float,
    z: float,
    qx: float,
    qy: float,
    qz: float,
) -> Triple:
    """The foot of a point on the curve in which carriers a and b meet, near a known one.

    Newton's method on a(q) = 0, b(q) = 0, (p - q).t(q) = 0; the derivative of the last by q has
    the curve's bending k in it: -(1 - (p - q).k) t.
    """
    before = inf
    for _ in range(FOOT_STEPS):
        nx, ny, nz = normal(table, a, qx, qy, qz)
        mx, my, mz = normal(table, b, qx, qy, qz)
        tx, ty, tz = ny * mz - nz * my, nz * mx - nx * mz, nx * my - ny * mx
        sine = sqrt(tx * tx + ty * ty + tz * tz)
        cosine = nx * mx + ny * my + nz * mz
        da = -signed_distance(table, a, qx, qy, qz)
        db = -signed_distance(table, b, qx, qy, qz)
        if sine <= TOUCHING:
            # nothing tells the curve's tangent: only back onto the carriers
            sign = -1.0 if cosine < 0.0 else 1.0
            back = 0.5 * (da + sign * db)
            sx, sy, sz = back * nx, back * ny, back * nz
        else:
            tx, ty, tz = tx / sine, ty / sine, tz / sine
            vx, vy, vz = x - qx, y - qy, z - qz
            ha = -normal_curvature(table, a, qx, qy, qz, tx, ty, tz)
            hb = -normal_curvature(table, b, qx, qy, qz, tx, ty, tz)
            square = sine * sine
            ka, kb = (ha - cosine * hb) / square, (hb - cosine * ha) / square
            bent = ka * (vx * nx + vy * ny + vz * nz) + kb * (vx * mx + vy * my + vz * mz)
            along = (vx * tx + vy * ty + vz * tz) / max(1.0 - bent, LEAST_BEND)
            limit = LONGEST_STEP * sqrt(vx * vx + vy * vy + vz * vz)
            along = min(max(along, -limit), limit)
            # the step across the curve solves n.s = da, m.s = db in the plane of n and m
            ca, cb = (da - cosine * db) / square, (db - cosine * da) / square
            sx = ca * nx + cb * mx + along * tx
            sy = ca * ny + cb * my + along * ty
            sz = ca * nz + cb * mz + along * tz
        qx, qy, qz = qx + sx, qy + sy, qz + sz
        length = sqrt(sx * sx + sy * sy + sz * sz)
        if length <= AT_REST * (1.0 + abs(qx) + abs(qy) + abs(qz)):
            break
        if length >= before and length <= ROUNDING * (1.0 + abs(qx) + abs(qy) + abs(qz)):
            break
        before = length
    return qx, qy, qz
