"""Lengths along an ellipse (a cos t, b sin t), a >= b, by elliptic integrals of the second kind."""

from __future__ import annotations

from math import pi

import numpy as np

from decomp.vectors import Array

KNOWN = 257
"""Lengths at so many angles of a turn are where Newton's method begins."""
MOST_STEPS = 20


def perimeter(a: float, b: float) -> float:
    """Length of the ellipse."""
    # scipy takes long to load, which models without ellipses need not wait for
    from scipy.special import ellipe  # type: ignore[import-untyped]

    return float(4 * a * ellipe(1 - (b / a) ** 2))


def arc_length(angle: Array, a: float, b: float) -> Array:
    """Length (...) from angle 0 to angles t (...), negative for negative ones."""
    from scipy.special import ellipe, ellipeinc

    # the integrals count from the minor semi-axis
    m = 1 - (b / a) ** 2
    return np.asarray(a * (ellipeinc(np.asarray(angle) + pi / 2, m) - ellipe(m)))


def arc_angle(length: Array, a: float, b: float) -> Array:
    """Angles t (...) at lengths (...) from angle 0."""
    whole = perimeter(a, b)
    turns = np.round(np.asarray(length) / whole)
    rest = np.asarray(length) - turns * whole
    angles = np.linspace(-pi, pi, KNOWN)
    known = arc_length(angles, a, b)
    row = np.clip(np.searchsorted(known, rest) - 1, 0, KNOWN - 2)
    low, high = angles[row], angles[row + 1]
    angle = np.asarray(np.interp(rest, known, angles))
    for _ in range(MOST_STEPS):
        slope = np.hypot(a * np.sin(angle), b * np.cos(angle))
        step = (rest - arc_length(angle, a, b)) / slope
        angle = np.clip(angle + step, low, high)
        if float(np.abs(step).max(initial=0.0)) <= 1e-15:
            break
    return np.asarray(angle + 2 * pi * turns)
