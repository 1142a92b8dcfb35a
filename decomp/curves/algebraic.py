"""Roots of a carrier's polynomial along a conic.

Between neighbouring critical points the polynomial is monotone: it has one simple root there if
its signs differ, none otherwise. A critical point on the carrier is a touch.
"""

from __future__ import annotations

import numpy as np

from decomp.carriers import Carrier
from decomp.curves.base import Curve
from decomp.curves.critical import critical_points
from decomp.curves.series import Series, series
from decomp.curves.touching import CROSSINGS_APART, Touching
from decomp.tolerance import LAST_DIGIT
from decomp.vectors import Array, Bools, dot

POLISHING_STEP = 1e-7
"""Newton steps longer than this part of the period lead elsewhere: they are not taken."""


def conic_roots(
    curve: Curve, carrier: Carrier, tolerance: float, touches: Touching
) -> tuple[Array, Bools]:
    """Parameters where the conic is on the carrier (or on a cone's other nappe); touches?"""
    f = series(curve, carrier)
    slope = f.derivative()
    critical = critical_points(f, curve.period if curve.closed else None)
    if curve.closed:
        if len(critical) == 0:
            return np.empty(0), np.empty(0, dtype=bool)
        stops = np.append(critical, critical[0] + curve.period)
    else:
        low, high = curve.domain
        critical = critical[(critical > low) & (critical < high)]
        stops = np.concatenate([[low], critical, [high]])
    values = f.value(stops)
    touch = np.abs(carrier.signed_distance(curve.point(stops))) <= tolerance
    if touch.any():
        dips = _dips(f, curve, stops, touch, CROSSINGS_APART * tolerance)
        if dips.any():
            dips[dips] = ~touches(curve.point(curve.wrapped(stops[dips])))
        touch &= ~dips
    sign = np.where(touch, 0.0, np.sign(values))
    cross = np.nonzero(sign[1:] * sign[:-1] < 0)[0]
    simple = bracketed(f, slope, stops[cross], stops[cross + 1])
    simple = on_carrier(curve, carrier, simple)
    tangential = np.ones(len(stops), dtype=bool)
    if not curve.closed:
        ends = np.array([0, -1])
        tangential[ends] = is_tangent(curve, carrier, stops[ends], tolerance)
    t = np.concatenate([simple, stops[touch]])
    return t, np.concatenate([np.zeros(len(simple), dtype=bool), tangential[touch]])


def _dips(f: Series, curve: Curve, stops: Array, touch: Bools, apart: float) -> Bools:
    """Which of the critical points that seem to be touches lie between two crossings.

    Args:
        f: the carrier's polynomial along the curve.
        curve: the curve.
        stops: critical points; of a closed curve the first one comes again at the end.
        touch: whether the carrier is there within the tolerance.
        apart: crossings nearer to each other are one touch.
    """
    values = f.value(stops)
    sign = np.where(touch, 0.0, np.sign(values))
    result = np.zeros(len(stops), dtype=np.bool_)
    count = len(stops)
    for k in np.flatnonzero(touch):
        before, after = k - 1, k + 1
        if curve.closed:
            before, after = (k - 1) % (count - 1), (k + 1) % (count - 1)
        elif k in (0, count - 1):
            continue
        if not (sign[before] * sign[after] > 0 and sign[before] * values[k] < 0):
            continue
        low = stops[before] - (curve.period if before > k else 0.0)
        high = stops[after] + (curve.period if after < k else 0.0)
        roots = bracketed(f, f.derivative(), np.array([low, stops[k]]), np.array([stops[k], high]))
        tips = curve.point(curve.wrapped(roots))
        result[k] = float(np.linalg.norm(tips[1] - tips[0])) > apart
    return result


def is_tangent(curve: Curve, carrier: Carrier, t: Array, tolerance: float) -> Bools:
    """Whether the curve's direction at t lies in the carrier, to what `tolerance` can tell.

    A curve that keeps within `tolerance` over a length h of a surface of size s has a slope of
    about sqrt(tolerance / s).
    """
    d = curve.derivative(t)
    slope = np.abs(dot(carrier.normal(curve.point(t)), d)) / np.sqrt(dot(d, d))
    return np.asarray(slope <= np.sqrt(tolerance / max(curve.bounding_ball()[1], tolerance)))


def bracketed(f: Series, slope: Series, low: Array, high: Array) -> Array:
    """The root in each interval with a change of sign: Newton's method, safe by bisection."""
    low, high = low.copy(), high.copy()
    falling = f.value(low) > 0
    t = (low + high) / 2
    for _ in range(80):
        value = f.value(t)
        right = (value < 0) != falling
        low, high = np.where(right, t, low), np.where(right, high, t)
        d = slope.value(t)
        new = t - value / np.where(d == 0, 1.0, d)
        new = np.where((new > low) & (new < high) & (d != 0), new, (low + high) / 2)
        done = np.abs(new - t) <= LAST_DIGIT * (np.abs(low) + np.abs(high))
        t = new
        if done.all():
            break
    return t


def on_carrier(curve: Curve, carrier: Carrier, t: Array) -> Array:
    """Two Newton steps on the signed distance, where they are small."""
    for _ in range(2):
        p = curve.point(t)
        d = dot(carrier.normal(p), curve.derivative(t))
        step = carrier.signed_distance(p) / np.where(d == 0, 1.0, d)
        t = np.where((np.abs(step) < POLISHING_STEP * curve.period) & (d != 0), t - step, t)
    return t
