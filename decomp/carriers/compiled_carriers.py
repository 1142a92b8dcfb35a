"""The carriers as compiled scalar kernels: signed distance, foot, normal.

Same formulas as `decomp.carriers`, for one carrier and one point at a time. A carrier is a row
of a `CarrierTable`; points and vectors are three floats.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import hypot, inf, sqrt

import numpy as np

from decomp.carriers.base import ROW, Carrier
from decomp.carriers.compiled_ellipse import (
    elliptic_bend,
    elliptic_distance,
    elliptic_foot,
    elliptic_normal,
)
from decomp.carriers.kinds import codes_of
from decomp.kernels.compiled import inlined, inner
from decomp.kernels.records import Record
from decomp.vectors import Array, Ints

Triple = tuple[float, float, float]

PLANE, SPHERE, CYLINDER, CONE, TORUS, ELLIPTIC_CYLINDER = range(6)
TINY = 1e-300
ON_AXIS = 1e-30
"""Square of the angle at the reference point below which a point counts as on the axis."""


@dataclass(frozen=True, eq=False)
class CarrierTable(Record):
    """Carriers as arrays: `codes` (n,) and `packed` (n, ROW), see `Carrier.packed`."""

    codes: Ints
    packed: Array


def carrier_table(carriers: Sequence[Carrier]) -> CarrierTable:
    """Lay out carriers for the kernels, which trust their codes.

    Raises:
        TypeError: a carrier is of an unknown kind.
    """
    codes = codes_of(carriers)
    packed = np.array([c.packed() for c in carriers], dtype=np.float64).reshape(-1, ROW)
    return CarrierTable(codes, packed)


@inner
def perpendicular_to(ax: float, ay: float, az: float) -> Triple:
    """A unit vector at right angles to a unit vector: the one of `vectors.perpendicular`."""
    if abs(ax) <= abs(ay) and abs(ax) <= abs(az):
        x, y, z = 0.0, -az, ay
    elif abs(ay) <= abs(az):
        x, y, z = az, 0.0, -ax
    else:
        x, y, z = -ay, ax, 0.0
    length = sqrt(x * x + y * y + z * z)
    return x / length, y / length, z / length


@inlined
def axial(packed: Array, c: int, x: float, y: float, z: float) -> tuple[float, float]:
    """Height along carrier c's axis and distance from it."""
    ax, ay, az = packed[c, 3], packed[c, 4], packed[c, 5]
    vx, vy, vz = x - packed[c, 0], y - packed[c, 1], z - packed[c, 2]
    height = vx * ax + vy * ay + vz * az
    rx, ry, rz = vx - height * ax, vy - height * ay, vz - height * az
    return height, sqrt(rx * rx + ry * ry + rz * rz)


@inlined
def radial(packed: Array, c: int, x: float, y: float, z: float) -> Triple:
    """Unit vector away from carrier c's axis; on the axis a fixed one at right angles to it."""
    ax, ay, az = packed[c, 3], packed[c, 4], packed[c, 5]
    vx, vy, vz = x - packed[c, 0], y - packed[c, 1], z - packed[c, 2]
    height = vx * ax + vy * ay + vz * az
    rx, ry, rz = vx - height * ax, vy - height * ay, vz - height * az
    # close to the axis rounding has left a part along it
    along = rx * ax + ry * ay + rz * az
    rx, ry, rz = rx - along * ax, ry - along * ay, rz - along * az
    square = rx * rx + ry * ry + rz * rz
    if square <= ON_AXIS * (vx * vx + vy * vy + vz * vz):
        return perpendicular_to(ax, ay, az)
    rho = sqrt(square)
    return rx / rho, ry / rho, rz / rho


@inlined
def signed_distance(table: CarrierTable, c: int, x: float, y: float, z: float) -> float:
    """Euclidean distance to carrier c, negative inside."""
    packed, code = table.packed, table.codes[c]
    if code == PLANE:
        return float(
            (x - packed[c, 0]) * packed[c, 3]
            + (y - packed[c, 1]) * packed[c, 4]
            + (z - packed[c, 2]) * packed[c, 5]
        )
    if code == SPHERE:
        vx, vy, vz = x - packed[c, 0], y - packed[c, 1], z - packed[c, 2]
        return float(sqrt(vx * vx + vy * vy + vz * vz) - packed[c, 6])
    height, rho = axial(packed, c, x, y, z)
    if code == CYLINDER:
        return float(rho - packed[c, 6])
    if code == CONE:
        sine, cosine = packed[c, 6], packed[c, 7]
        if rho * sine + height * cosine > 0.0:
            return float(rho * cosine - height * sine)
        return hypot(rho, height)
    if code == TORUS:
        return float(hypot(rho - packed[c, 6], height) - packed[c, 7])
    return elliptic_distance(packed, c, x, y, z)


@inner
def normal(table: CarrierTable, c: int, x: float, y: float, z: float) -> Triple:
    """Outward unit normal of carrier c at a point on or near it."""
    packed, code = table.packed, table.codes[c]
    ax, ay, az = packed[c, 3], packed[c, 4], packed[c, 5]
    if code == PLANE:
        return ax, ay, az
    if code == SPHERE:
        vx, vy, vz = x - packed[c, 0], y - packed[c, 1], z - packed[c, 2]
        length = sqrt(vx * vx + vy * vy + vz * vz)
        if length == 0.0:
            return 0.0, 0.0, 1.0
        return vx / length, vy / length, vz / length
    if code == ELLIPTIC_CYLINDER:
        return elliptic_normal(packed, c, x, y, z)
    ux, uy, uz = radial(packed, c, x, y, z)
    if code == CYLINDER:
        return ux, uy, uz
    if code == CONE:
        sine, cosine = packed[c, 6], packed[c, 7]
        return cosine * ux - sine * ax, cosine * uy - sine * ay, cosine * uz - sine * az
    height, rho = axial(packed, c, x, y, z)
    out = rho - packed[c, 6]
    length = hypot(out, height)
    if length <= TINY:
        return ux, uy, uz
    out, height = out / length, height / length
    return out * ux + height * ax, out * uy + height * ay, out * uz + height * az


@inner
def foot(table: CarrierTable, c: int, x: float, y: float, z: float) -> Triple:
    """The nearest point of carrier c (any one of them on its reflexive locus)."""
    packed, code = table.packed, table.codes[c]
    px, py, pz = packed[c, 0], packed[c, 1], packed[c, 2]
    ax, ay, az = packed[c, 3], packed[c, 4], packed[c, 5]
    if code == PLANE:
        away = signed_distance(table, c, x, y, z)
        return x - away * ax, y - away * ay, z - away * az
    if code == SPHERE:
        nx, ny, nz = normal(table, c, x, y, z)
        r = packed[c, 6]
        return px + r * nx, py + r * ny, pz + r * nz
    if code == ELLIPTIC_CYLINDER:
        return elliptic_foot(packed, c, x, y, z)
    ux, uy, uz = radial(packed, c, x, y, z)
    height, rho = axial(packed, c, x, y, z)
    if code == CYLINDER:
        r = packed[c, 6]
        return px + height * ax + r * ux, py + height * ay + r * uy, pz + height * az + r * uz
    if code == CONE:
        sine, cosine = packed[c, 6], packed[c, 7]
        along = max(rho * sine + height * cosine, 0.0)
        out, height = along * sine, along * cosine
        return px + out * ux + height * ax, py + out * uy + height * ay, pz + out * uz + height * az
    nx, ny, nz = normal(table, c, x, y, z)
    major, minor = packed[c, 6], packed[c, 7]
    return (
        px + major * ux + minor * nx,
        py + major * uy + minor * ny,
        pz + major * uz + minor * nz,
    )


@inner
def normal_curvature(
    table: CarrierTable, c: int, x: float, y: float, z: float, dx: float, dy: float, dz: float
) -> float:
    """Curvature of carrier c at a point on it along a unit tangent, see `Carrier`."""
    packed, code = table.packed, table.codes[c]
    if code == PLANE:
        return 0.0
    if code == SPHERE:
        return float(1.0 / packed[c, 6])
    ax, ay, az = packed[c, 3], packed[c, 4], packed[c, 5]
    if code == ELLIPTIC_CYLINDER:
        nx, ny, nz = elliptic_normal(packed, c, x, y, z)
        wx, wy, wz = ay * nz - az * ny, az * nx - ax * nz, ax * ny - ay * nx
        around = wx * dx + wy * dy + wz * dz
        return float(around * around * elliptic_bend(packed, c, x, y, z))
    ux, uy, uz = radial(packed, c, x, y, z)
    wx, wy, wz = ay * uz - az * uy, az * ux - ax * uz, ax * uy - ay * ux
    around = wx * dx + wy * dy + wz * dz
    if code == CYLINDER:
        return float(around * around / packed[c, 6])
    rho = (x - packed[c, 0]) * ux + (y - packed[c, 1]) * uy + (z - packed[c, 2]) * uz
    if code == CONE:
        return float(around * around * packed[c, 7] / rho)
    nx, ny, nz = normal(table, c, x, y, z)
    sx, sy, sz = wy * nz - wz * ny, wz * nx - wx * nz, wx * ny - wy * nx
    across = sx * dx + sy * dy + sz * dz
    parallel = (nx * ux + ny * uy + nz * uz) / rho
    return float(around * around * parallel + across * across / packed[c, 7])


@inner
def at_tip(table: CarrierTable, c: int, x: float, y: float, z: float, near: float) -> bool:
    """Whether a point is within `near` of carrier c's tip, which only cones have."""
    if table.codes[c] != CONE:
        return False
    packed = table.packed
    vx, vy, vz = x - packed[c, 0], y - packed[c, 1], z - packed[c, 2]
    return sqrt(vx * vx + vy * vy + vz * vz) <= near


@inner
def foot_spread(table: CarrierTable, c: int, x: float, y: float, z: float, radius: float) -> float:
    """How far from the foot of a point the feet of points within `radius` of it can be.

    Projection to a convex body does not spread feet of points outside. From inside a circle of
    radius r, at distance rho from its centre, it spreads them by r / rho at most.
    """
    packed, code = table.packed, table.codes[c]
    if code == PLANE:
        return radius
    if code == SPHERE:
        vx, vy, vz = x - packed[c, 0], y - packed[c, 1], z - packed[c, 2]
        clear = sqrt(vx * vx + vy * vy + vz * vz) - radius
    elif code == ELLIPTIC_CYLINDER:
        return radius if elliptic_distance(packed, c, x, y, z) >= radius else inf
    elif code == CYLINDER:
        clear = axial(packed, c, x, y, z)[1] - radius
    else:
        return inf
    return radius * max(1.0, packed[c, 6] / clear) if clear > 0.0 else inf
