"""Newton's method onto the intersection of two carriers, for many points at once."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from decomp.carriers import Carrier
from decomp.kernels.carriers import CarrierTable, carrier_table, normal, signed_distance
from decomp.kernels.compiled import scalar
from decomp.vectors import Array, cross, norm

SINGULAR = 1e-7
"""Sine of the angle between two normals below which they count as parallel."""
EXACT = 1e-14
"""Steps smaller than this part of the greatest coordinate are the last."""


def onto_pair(a: Carrier, b: Carrier, p: Array, along: Array, steps: int = 6) -> Array:
    """Bring points p (..., 3) onto both carriers, moving only across the unit vectors `along`.

    In the plane across `along` the two linear equations n_a.x = -a, n_b.x = -b are solved, step
    by step; where the normals are parallel there, the least-norm solution is taken.
    """
    moved = np.array(p, dtype=np.float64).reshape(-1, 3)
    ways = np.ascontiguousarray(np.broadcast_to(along, np.shape(p)), dtype=np.float64)
    small = EXACT * float(np.max(np.abs(moved), initial=0.0))
    move_onto_pair(_table(a, b), moved, ways.reshape(-1, 3), steps, small)
    return moved.reshape(np.shape(p))


@lru_cache(maxsize=4096)
def _table(a: Carrier, b: Carrier) -> CarrierTable:
    return carrier_table([a, b])


@scalar
def move_onto_pair(
    table: CarrierTable, points: Array, along: Array, steps: int, small: float
) -> None:
    """Move points (n, 3) onto carriers 0 and 1 in place, until a step is smaller than `small`."""
    for i in range(len(points)):
        x, y, z = points[i, 0], points[i, 1], points[i, 2]
        wx, wy, wz = along[i, 0], along[i, 1], along[i, 2]
        for _ in range(steps):
            fa, fb = signed_distance(table, 0, x, y, z), signed_distance(table, 1, x, y, z)
            nx, ny, nz = normal(table, 0, x, y, z)
            mx, my, mz = normal(table, 1, x, y, z)
            part = nx * wx + ny * wy + nz * wz
            nx, ny, nz = nx - part * wx, ny - part * wy, nz - part * wz
            part = mx * wx + my * wy + mz * wz
            mx, my, mz = mx - part * wx, my - part * wy, mz - part * wz
            cx, cy, cz = ny * mz - nz * my, nz * mx - nx * mz, nx * my - ny * mx
            det = cx * wx + cy * wy + cz * wz
            if abs(det) < SINGULAR:
                sign = -1.0 if nx * mx + ny * my + nz * mz < 0.0 else 1.0
                least = -0.5 * (fa + sign * fb)
                dx, dy, dz = least * nx, least * ny, least * nz
            else:
                # x with n_a.x = -fa and n_b.x = -fb:  (fa n_b - fb n_a) x along / det
                gx, gy, gz = fa * mx - fb * nx, fa * my - fb * ny, fa * mz - fb * nz
                dx, dy, dz = (
                    (gz * wy - gy * wz) / det,
                    (gx * wz - gz * wx) / det,
                    (gy * wx - gx * wy) / det,
                )
            x, y, z = x + dx, y + dy, z + dz
            if dx * dx + dy * dy + dz * dz <= small * small:
                break
        points[i, 0], points[i, 1], points[i, 2] = x, y, z


def cross_direction(a: Carrier, b: Carrier, p: Array) -> tuple[Array, Array]:
    """Unit vectors along n_a x n_b and the lengths of these products (0 where parallel)."""
    product = cross(a.normal(p), b.normal(p))
    size = norm(product)
    return product / np.where(size > 0, size, 1.0)[..., None], size
