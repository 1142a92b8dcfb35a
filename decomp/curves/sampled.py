"""Roots of a signed distance along a traced curve.

The signed distance is 1-Lipschitz, so an interval of length h can hold a root only if the
distances at its ends add up to h at most. What remains is subdivided until the carrier's
curvature no longer matters; then changes of sign are roots, and minima of the distance touches.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from decomp.carriers import Carrier
from decomp.curves.algebraic import is_tangent
from decomp.curves.base import Curve
from decomp.curves.flat_touches import flat_touches
from decomp.curves.touching import CROSSINGS_APART, Touching
from decomp.tolerance import LAST_DIGIT
from decomp.vectors import Array, Bools, dot, norm

SPLIT = 4
MOST_LEVELS = 8
FASTEST = 1.2
"""Bound of the speed |x'(t)| of a traced curve, whose samples turn by a few degrees."""

ROOT_AT_REST = 1e-10
"""Steps of Newton's method below this part of a curve's length have come to rest."""

Function = Callable[[Array], Array]


def traced_roots(
    curve: Curve, carrier: Carrier, tolerance: float, touches: Touching
) -> tuple[Array, Bools]:
    """Parameters where the curve is on the carrier, and whether it only touches it there."""

    def distance(t: Array) -> Array:
        return carrier.signed_distance(curve.point(t))

    def slope(t: Array) -> Array:
        return dot(carrier.normal(curve.point(t)), curve.derivative(t))

    low, high, f0, f1 = _intervals(curve, carrier, distance, tolerance)
    if len(low) == 0:
        return np.empty(0), np.empty(0, dtype=bool)
    sign0 = np.where(np.abs(f0) <= tolerance, 0.0, np.sign(f0))
    sign1 = np.where(np.abs(f1) <= tolerance, 0.0, np.sign(f1))
    cross = sign0 * sign1 < 0
    # a dip towards the carrier and back; an end within tolerance counts with either sign
    side = np.where(sign0 != 0, sign0, np.where(sign1 != 0, sign1, 1.0))
    d0, d1 = slope(low), slope(high)
    dip = ~cross & (side * d0 < 0) & (side * d1 > 0)
    bottom = _bracketed(slope, low[dip], high[dip])
    depth = distance(bottom)
    touch = np.abs(depth) <= tolerance
    deep = np.flatnonzero(touch & (depth * side[dip] < 0) & (sign0 * sign1 != 0)[dip])
    if len(deep):
        start = _bracketed(distance, low[dip][deep], bottom[deep])
        stop = _bracketed(distance, bottom[deep], high[dip][deep])
        apart = norm(curve.point(stop) - curve.point(start)) > CROSSINGS_APART * tolerance
        touch[deep] = ~apart | touches(curve.point(bottom[deep]))
    through = ~touch & (depth * side[dip] < 0)
    start = np.concatenate([low[cross], low[dip][through], bottom[through]])
    stop = np.concatenate([high[cross], bottom[through], high[dip][through]])
    roots = _bracketed(distance, start, stop)
    ends = np.unique(np.concatenate([low[sign0 == 0], high[sign1 == 0]]))
    ends, tangent = _settled(curve, carrier, ends, slope, tolerance)
    ends, tangent = _apart(ends, tangent, bottom[touch], float((high - low).max()))
    touching = np.concatenate([bottom[touch], ends[tangent]])
    touching = flat_touches(curve, distance, touching, tolerance)
    t = np.concatenate([roots, ends[~tangent], touching])
    return t, np.arange(len(t)) >= len(t) - len(touching)


def _intervals(
    curve: Curve, carrier: Carrier, distance: Function, tolerance: float
) -> tuple[Array, Array, Array, Array]:
    """Intervals that may hold roots, with the signed distances at their ends."""
    knots = np.asarray(getattr(curve, "knots", np.linspace(*curve.domain, 65)))
    low, high = knots[:-1], knots[1:]
    f = distance(knots)
    f0, f1 = f[:-1], f[1:]
    fine = 0.1 * _least_radius(carrier, curve)
    for level in range(MOST_LEVELS):
        near = np.abs(f0) + np.abs(f1) <= FASTEST * (high - low) + 2 * tolerance
        low, high, f0, f1 = low[near], high[near], f0[near], f1[near]
        if len(low) == 0 or (level >= 2 and float((high - low).max()) < fine):
            break
        if len(low) > 2000:
            break
        cuts = low[:, None] + (high - low)[:, None] * np.arange(SPLIT + 1) / SPLIT
        cuts[:, -1] = high
        values = np.concatenate([f0[:, None], distance(cuts[:, 1:-1]), f1[:, None]], axis=1)
        low, high = cuts[:, :-1].ravel(), cuts[:, 1:].ravel()
        f0, f1 = values[:, :-1].ravel(), values[:, 1:].ravel()
    return low, high, f0, f1


def _least_radius(carrier: Carrier, curve: Curve) -> float:
    return min(carrier.least_radius, curve.bounding_ball()[1])


def _bracketed(f: Function, low: Array, high: Array) -> Array:
    """Root in each interval with a change of sign.

    Regula falsi with halved weights (M. Dowell and P. Jarratt, A modified regula falsi method,
    BIT 11 (1971), "Illinois"), with a bisection now and then.
    """
    if len(low) == 0:
        return low
    a, b, fa, fb = low, high, f(low), f(high)
    wa, wb = fa, fb
    root = np.where(fa == 0, a, b)
    done = (fa == 0) | (fb == 0)
    before = np.zeros(low.shape)
    small = LAST_DIGIT * (np.abs(low) + np.abs(high))
    for step in range(80):
        if done.all():
            break
        slope = np.where(wb == wa, 1.0, wb - wa)
        t = b - wb * (b - a) / slope
        inside = (t > a) & (t < b) & (step % 6 != 5)
        t = np.where(inside, t, (a + b) / 2)
        ft = f(t)
        done_now = (ft == 0) | (b - a <= small) | (np.abs(t - root) <= small / 4)
        root = np.where(done, root, t)
        left = np.sign(ft) == np.sign(fa)
        repeated = before == np.where(left, 1.0, -1.0)
        before = np.where(left, 1.0, -1.0)
        other = np.where(repeated, 0.5, 1.0)
        wa, wb = np.where(left, ft, wa * other), np.where(left, wb * other, ft)
        a, b, fa = np.where(left, t, a), np.where(left, b, t), np.where(left, ft, fa)
        done = done | done_now
    return root


def _settled(
    curve: Curve, carrier: Carrier, t: Array, slope: Function, tolerance: float
) -> tuple[Array, Bools]:
    """Polish parameters within tolerance of the carrier by Newton, unless it is a touch.

    At a crossing Newton's method is at rest at once; beside a touch it halves the way.
    """
    tangent = is_tangent(curve, carrier, t, tolerance)
    crossing, step = t, np.zeros(t.shape)
    for _ in range(4):
        d = slope(crossing)
        step = carrier.signed_distance(curve.point(crossing)) / np.where(d == 0, 1.0, d)
        crossing = np.where(tangent, t, crossing - step)
    tangent = tangent | (np.abs(step) > ROOT_AT_REST * curve.period)
    return curve.wrapped(np.where(tangent, t, crossing)), tangent


def _apart(t: Array, flags: Bools, others: Array, width: float) -> tuple[Array, Bools]:
    """Drop touches that are already among `others`, and repeats nearer than `width`."""
    keep: list[int] = []
    taken = list(others)
    for i in range(len(t)):
        if flags[i] and any(abs(t[i] - s) <= 1.5 * width for s in taken):
            continue
        keep.append(i)
        if flags[i]:
            taken.append(float(t[i]))
    return t[keep], flags[keep]
