"""Cylindrical coordinates about an axis, shared by cylinder, cone and torus."""

from __future__ import annotations

import numpy as np

from decomp.vectors import Array, cross, dot, norm, perpendicular


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


def off_axis(p: Array, point: Array, axis: Array) -> Array:
    """Distance (k,) of points p (k, 3) from the line through a point along an axis."""
    away = p - point
    return norm(away - (away @ axis)[:, None] * axis)


def axial_rows(rows: Array, p: Array) -> tuple[Array, Array]:
    """Height and distance (m, n) of points p (n, 3) from the axes of carriers' rows (m, ROW)."""
    away = p[None, :, :] - rows[:, None, :3]
    axis = rows[:, None, 3:6]
    z = dot(away, axis)
    return z, norm(away - z[..., None] * axis)


def axial_line(rows: Array, origin: Array, direction: Array) -> tuple[Array, Array, Array, Array]:
    """Products (m,) of a line's origin, seen from carriers' points, and its unit direction.

    direction . axis, origin . direction, origin . axis, origin . origin.
    """
    away, axis = origin - rows[:, :3], rows[:, 3:6]
    return axis @ direction, away @ direction, dot(away, axis), dot(away, away)


def straight_box(point: Array, axis: Array, reach: Array) -> Array:
    """Corners (2, 3) of the box around what reaches so far (3,) from a line, infinite along it."""
    flat = axis == 0.0
    low, high = np.where(flat, point - reach, -np.inf), np.where(flat, point + reach, np.inf)
    return np.array([low, high])


def round_reach(axis: Array, radius: float) -> Array:
    """How far (3,) a circle about an axis reaches along the coordinates."""
    return np.asarray(radius * np.sqrt(np.maximum(0.0, 1 - axis**2)))


def circle_through(p: Array, point: Array, axis: Array) -> tuple[Array, Array, Array, float, float]:
    """The circle about an axis through p (3,), from there on: see `Carrier.level`."""
    z, rho, out = axial_split(p, point, axis)
    return point + z * axis, out, cross(axis, out), float(rho), float(rho)


def box_between(point: Array, axis: Array, parts: Array, reach: Array) -> Array:
    """Corners (2, 3) of the box around a cylinder between the heights of some boxes (k, 6).

    Args:
        point: of the axis, (3,).
        axis: unit direction, (3,).
        parts: lower and upper corners.
        reach: how far (3,) the section reaches along the coordinates.
    """
    centres = point + heights(point, axis, parts)[:, None] * axis
    return np.array([(centres - reach).min(axis=0), (centres + reach).max(axis=0)])


def heights(point: Array, axis: Array, parts: Array) -> Array:
    """Least and greatest height (2,) along an axis of the corners of boxes (k, 6)."""
    middle, half = (parts[:, :3] + parts[:, 3:]) / 2, (parts[:, 3:] - parts[:, :3]) / 2
    height, spread = (middle - point) @ axis, half @ np.abs(axis)
    return np.array([(height - spread).min(), (height + spread).max()])


def odd_side(axis: Array) -> Array:
    """A unit vector across an axis, in a direction that is along no other carrier's symmetry."""
    x = perpendicular(axis)
    return np.asarray(np.cos(0.7391) * x + np.sin(0.7391) * cross(axis, x))


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
