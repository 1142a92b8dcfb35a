"""Normals and feet of many points, each on a carrier of its own."""

from __future__ import annotations

import numpy as np

from decomp.carriers.compiled_carriers import CarrierTable, foot, normal, signed_distance
from decomp.kernels.compiled import scalar
from decomp.vectors import Array, Ints

STEPS = 2
"""Corrections of a foot, see `Carrier.project`."""


def normals_at(table: CarrierTable, carriers: Ints, points: Array) -> Array:
    """Outward unit normals (k, 3) of carriers (k,) at points (k, 3) on or near them."""
    result = np.empty(points.shape)
    _normals(table, carriers, points, result)
    return result


def projected(table: CarrierTable, carriers: Ints, points: Array) -> Array:
    """Feet (k, 3) of points (k, 3) on carriers (k,), on them to rounding."""
    result = np.empty(points.shape)
    _projected(table, carriers, points, result)
    return result


@scalar
def _normals(table: CarrierTable, carriers: Ints, points: Array, result: Array) -> None:
    for i in range(len(points)):
        x, y, z = normal(table, carriers[i], points[i, 0], points[i, 1], points[i, 2])
        result[i, 0], result[i, 1], result[i, 2] = x, y, z


@scalar
def _projected(table: CarrierTable, carriers: Ints, points: Array, result: Array) -> None:
    for i in range(len(points)):
        c = carriers[i]
        x, y, z = foot(table, c, points[i, 0], points[i, 1], points[i, 2])
        for _ in range(STEPS):
            nx, ny, nz = normal(table, c, x, y, z)
            away = signed_distance(table, c, x, y, z)
            x, y, z = x - away * nx, y - away * ny, z - away * nz
        result[i, 0], result[i, 1], result[i, 2] = x, y, z
