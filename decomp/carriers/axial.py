"""Cylindrical coordinates about an axis, shared by cylinder, cone and torus."""

from __future__ import annotations

import numpy as np

from decomp.vectors import Array, dot, norm, perpendicular


def axial_split(p: Array, point: Array, axis: Array) -> tuple[Array, Array, Array]:
    """Return height z (...), distance rho (...) from the axis and unit outward direction (..., 3).

    On the axis itself, where every direction is outward, one fixed direction is taken.
    """
    away = p - point
    z = dot(away, axis)
    radial = away - z[..., None] * axis
    # close to the axis what is left is rounding error, which must at least be across it
    radial = radial - dot(radial, axis)[..., None] * axis
    rho = norm(radial)
    clear = rho > 1e-300
    if clear.all():
        return z, rho, radial / rho[..., None]
    outward = np.where(
        clear[..., None], radial / np.where(clear, rho, 1.0)[..., None], perpendicular(axis)
    )
    return z, rho, outward


def axis_deviation(point: Array, axis: Array, point2: Array, axis2: Array, reach: float) -> float:
    """Largest distance between two (undirected) lines near `point2`, up to `reach` from it."""
    sign = 1.0 if float(dot(axis, axis2)) > 0 else -1.0
    tilt = float(np.linalg.norm(axis - sign * axis2))
    away = point2 - point
    gap = float(np.linalg.norm(away - float(dot(away, axis)) * axis))
    return gap + tilt * reach


def nearest_to_origin(point: Array, axis: Array) -> Array:
    """The point of a line that lies nearest to the origin."""
    return np.asarray(point - float(dot(point, axis)) * axis)
