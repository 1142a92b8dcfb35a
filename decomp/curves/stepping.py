"""Newton's steps onto two carriers, compiled."""

from __future__ import annotations

from functools import lru_cache

from decomp.carriers import Carrier
from decomp.carriers.compiled_carriers import CarrierTable, carrier_table, normal, signed_distance
from decomp.kernels.compiled import scalar
from decomp.tolerance import SINGULAR
from decomp.vectors import Array


@lru_cache(maxsize=4096)
def table_of(a: Carrier, b: Carrier) -> CarrierTable:
    """The two carriers as kernels take them."""
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
