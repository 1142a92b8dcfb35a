"""Two cylinders with parallel axes: lines."""

from __future__ import annotations

from math import sqrt

import numpy as np

from decomp.carriers import Cylinder
from decomp.curves.intersect.result import Intersection, PairCurve, Window, clipped_line
from decomp.vectors import dot, norm


def parallel_cylinders(a: Cylinder, b: Cylinder, window: Window) -> Intersection | None:
    """Lines where the circles of a cross-section meet; None if the axes are not parallel."""
    tilt = float(norm(np.cross(a.axis, b.axis))) * window.radius
    if tilt > window.tolerance:
        return None
    k = a.axis
    base = a.point + dot(window.centre - a.point, k) * k
    other = b.point + dot(window.centre - b.point, b.axis) * b.axis
    away = other - base
    away = away - dot(away, k) * k
    d, r, s = float(norm(away)), a.radius, b.radius
    if d <= window.tolerance:
        return Intersection()
    x = away / d
    y = np.cross(k, x)
    inner = abs(d - abs(r - s)) <= window.tolerance
    if inner or abs(d - r - s) <= window.tolerance:
        side = -r if inner and r < s else r
        line = clipped_line(base + side * x, k, window)
        return Intersection((PairCurve(line, True),) if line else ())
    if tilt > window.exact:
        return None
    if d > r + s or d < abs(r - s):
        return Intersection()
    t = ((d - s) * (d + s) + r * r) / (2 * d)
    h = sqrt((r - t) * (r + t))
    lines = [clipped_line(base + t * x + e * h * y, k, window) for e in (1, -1)]
    return Intersection(tuple(PairCurve(line) for line in lines if line))
