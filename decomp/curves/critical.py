"""Critical points of a carrier's polynomial along a curve.

Where a curve touches a carrier to higher order, as where an ellipse and a sphere osculate, the
derivative has a multiple zero. Rounding tears it apart into several, as far as its cube root and
more, but leaves their mean where it is.
"""

from __future__ import annotations

import numpy as np

from decomp.curves.series import Series
from decomp.vectors import Array

BOUND_ROUNDING = 1e-14
"""A polynomial is nothing but rounding below this part of its bound."""


def critical_points(f: Series, period: float | None, noise: float = 0.0) -> Array:
    """Critical points of f, increasing; those that rounding alone has made of one are one.

    Args:
        f: a polynomial along a curve.
        period: of the parameter, None if the curve is not closed.
        noise: values of f are no more exact than this.
    """
    slope = f.derivative()
    zeros = slope.zeros()
    if len(zeros) < 2:
        return _polished(slope, slope.derivative(), zeros)
    if period is not None:
        # begin behind the widest gap, so that no cluster is torn apart at the period's end
        first = int(np.argmax(np.diff(zeros, prepend=zeros[-1] - period)))
        zeros = np.concatenate([zeros[first:], zeros[:first] + period])
    between = (zeros[1:] + zeros[:-1]) / 2
    highest = np.abs(f.value(np.stack([zeros[:-1], between, zeros[1:]]))).max(axis=0)
    ends = np.flatnonzero(highest > max(noise, BOUND_ROUNDING * f.bound())) + 1
    clusters = np.split(zeros, ends)
    single = np.array([len(cluster) == 1 for cluster in clusters])
    means = np.array([cluster.mean() for cluster in clusters])
    means[single] = _polished(slope, slope.derivative(), means[single])
    return np.sort(means if period is None else np.mod(means, period))


def _polished(f: Series, slope: Series, t: Array) -> Array:
    """Newton steps for zeros of f, as far as they stay near."""
    for _ in range(3):
        d = slope.value(t)
        step = f.value(t) / np.where(d == 0, 1.0, d)
        t = np.where(np.abs(step) < 1e-3, t - step, t)
    return np.sort(t)
