"""Touches of higher order between a traced curve and a carrier.

Such a touch keeps within the tolerance over a long stretch of the curve, in which minima of the
distance are anywhere. The polynomial through values from farther away tells where it is.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.polynomial import chebyshev

from decomp.curves.base import Curve
from decomp.curves.critical import critical_points
from decomp.curves.series import Chebyshev
from decomp.tolerance import LAST_STEP
from decomp.vectors import Array, Ints, norm

HALF_WINDOW = 0.15
"""Half of the length over which the polynomial is taken, as a part of the curve's size."""
DEGREE = 16
DISTANCE_NOISE = 2e-15
"""Signed distances are no more exact than this part of the coordinates."""

Function = Callable[[Array], Array]


def flat_touches(curve: Curve, distance: Function, t: Array, tolerance: float) -> Array:
    """Touches, increasing, of which those along one flat stretch are one.

    Args:
        curve: the curve.
        distance: from a parameter to the signed distance from the carrier.
        t: parameters (k,) at which the curve seems to touch the carrier.
        tolerance: distances within it count as none.
    """
    t = np.sort(t)
    if curve.closed and len(t) > 1:
        # begin behind the widest gap, so that no stretch is torn apart at the domain's end
        first = int(np.argmax(np.diff(t, prepend=t[-1] - curve.period)))
        t = np.concatenate([t[first:], t[:first] + curve.period])
    return np.array(
        [
            _told(curve, distance, t[group], tolerance)
            for group in _stretches(distance, t, tolerance)
        ]
    )


def _stretches(distance: Function, t: Array, tolerance: float) -> list[Ints]:
    """Groups of touches between which the distance never leaves the tolerance."""
    if not len(t):
        return []
    between = t[:-1, None] + np.diff(t)[:, None] * np.linspace(0.0, 1.0, 9)
    leaves = (np.abs(distance(between)) > tolerance).any(axis=1)
    return np.split(np.arange(len(t)), np.flatnonzero(leaves) + 1)


def _told(curve: Curve, distance: Function, group: Array, tolerance: float) -> float:
    """Where the one touch is that a group of them stands for."""
    nearest = float(group[np.argmin(np.abs(distance(group)))])
    centre, size = curve.bounding_ball()
    noise = DISTANCE_NOISE * (size + float(norm(centre)))
    middle, half = float(group[0] + group[-1]) / 2, float(group[-1] - group[0]) / 2
    low, high = middle - HALF_WINDOW * size, middle + HALF_WINDOW * size
    if not curve.closed and (low < curve.domain[0] or high > curve.domain[1]):
        return nearest
    # a touch of second order leaves the tolerance within its root
    reach = size * (tolerance / size) ** (1 / 3)
    if float(np.abs(distance(np.array([middle - reach, middle + reach]))).max()) > tolerance:
        return nearest
    # along the tangent everything is analytic; the parameter has kinks of higher order at samples
    origin, tangent = curve.point(np.array(middle)), curve.derivative(np.array(middle))
    tangent = tangent / norm(tangent)
    nodes = np.cos(np.pi * (np.arange(DEGREE + 1) + 0.5) / (DEGREE + 1))
    t = middle + HALF_WINDOW * size * nodes
    along = (curve.point(t) - origin) @ tangent
    width = float(np.abs(along).max())
    matrix = chebyshev.chebvander(along / width, DEGREE)
    coefficients = np.asarray(np.linalg.solve(matrix, distance(t)), dtype=np.float64)
    found = critical_points(Chebyshev(coefficients, (-width, width)), None, noise)
    found = found[np.abs(found) <= half + 2 * reach]
    if not len(found):
        return nearest
    place = float(found[np.argmin(np.abs(found))])
    return _at(curve, middle, origin, tangent, place)


def _at(curve: Curve, t: float, origin: Array, tangent: Array, place: float) -> float:
    """The curve's parameter, near t, at a place along the tangent there."""
    for _ in range(20):
        slope = float(curve.derivative(np.array(t)) @ tangent)
        step = (place - float((curve.point(np.array(t)) - origin) @ tangent)) / slope
        t += step
        if abs(step) <= LAST_STEP * curve.period:
            break
    return t
