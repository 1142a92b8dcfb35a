"""Where two contacts are equally near along a curve of normals: they cross, or touch.

Where a contact's distance reaches another's to second order, its own site ends there: the
difference has a double root, which the secant method finds to half the digits only.
"""

from __future__ import annotations

from collections.abc import Callable
from math import isfinite

STEPS = (1e-3, 1e-4, 1e-5)
"""Steps, as parts of the curve, by which it is seen whether a root is a double one, and placed."""
ZERO = 1e-10
"""The least difference at a double root, as a part of the size."""
AT_REST = 1e-16
"""Steps below this, relative to the parameter, are the last ones."""


def change(gap: Callable[[float], float], a: float, b: float, span: float, size: float) -> float:
    """A root of a difference of distances close to [a, b], which is narrow already.

    Args:
        gap: the difference at a parameter, nan where there is none.
        a, b: parameters.
        span: of the curve, in units of the parameter.
        size: of the region.
    """
    root = _secant(gap, a, b)
    at = root
    for part in STEPS:
        step = part * span
        before, here, after = gap(at - step), gap(at), gap(at + step)
        bend = before - 2 * here + after
        if not before * after > 0 or not abs(before - after) < 2 * abs(bend):
            return root
        at += step * (before - after) / (2 * bend)
    least = gap(at)
    return at if isfinite(least) and abs(least) <= ZERO * size else root


def _secant(f: Callable[[float], float], a: float, b: float) -> float:
    fa, fb = f(a), f(b)
    for _ in range(20):
        if fa == fb:
            break
        c = b - fb * (b - a) / (fb - fa)
        if abs(c - b) <= AT_REST * (1 + abs(c)):
            return c
        a, fa, b, fb = b, fb, c, f(c)
    return b
