"""Planes and elliptic cylinders: lines or an ellipse."""

from __future__ import annotations

from math import acos, atan2, cos, hypot, sin, sqrt

import numpy as np

from decomp.carriers import EllipticCylinder, Plane
from decomp.curves.intersect.planes import LARGE, ellipse
from decomp.curves.intersect.result import Intersection, PairCurve, Window, clipped_line, inside
from decomp.vectors import Array, dot, norm


def plane_elliptic_cylinder(
    plane: Plane, cylinder: EllipticCylinder, window: Window
) -> Intersection | None:
    """Lines or an ellipse; None if it is too long for the window.

    At angle t of the section and height z the plane is d + p cos t + q sin t + c z = 0.
    """
    n, k = plane.normal_vector, cylinder.axis
    c, p = float(dot(n, k)), cylinder.a * float(dot(n, cylinder.x))
    q = cylinder.b * float(dot(n, cylinder.y))
    middle = cylinder.point + dot(window.centre - cylinder.point, k) * k
    d = float(plane.signed_distance(middle))
    if abs(c) * window.radius <= window.tolerance:
        return _lines(plane, cylinder, middle, (c, p, q, d), window)
    centre = middle - d / c * k
    one, two = cylinder.a * cylinder.x - p / c * k, cylinder.b * cylinder.y - q / c * k
    turn = atan2(2 * float(dot(one, two)), float(dot(one, one) - dot(two, two))) / 2
    major, minor = cos(turn) * one + sin(turn) * two, cos(turn) * two - sin(turn) * one
    long, short = float(norm(major)), float(norm(minor))
    if long > LARGE * window.radius:
        return None
    if float(norm(centre - window.centre)) > long + window.radius:
        return Intersection()
    x = major / long
    y = minor - dot(minor, x) * x
    curve = ellipse(centre, x, y / norm(y), long, short)
    return Intersection((PairCurve(curve),)) if inside(curve, window) else Intersection()


def _lines(
    plane: Plane,
    cylinder: EllipticCylinder,
    middle: Array,
    terms: tuple[float, float, float, float],
    window: Window,
) -> Intersection | None:
    """The plane is along the axis: two rulings, one where it touches, or none."""
    c, p, q, d = terms
    reach, towards = hypot(p, q), atan2(q, p)
    touch = abs(abs(d) - reach) <= window.tolerance
    slanted = abs(c) * window.radius > window.exact
    if abs(d) > reach and not touch:
        return None if slanted else Intersection()
    half = 0.0 if touch else sqrt((reach - d) * (reach + d))
    # as of a circle: the long ellipse leaves its tangents by (c R a)^2 / 2 h^3
    if not touch and slanted and (c * window.radius * cylinder.a) ** 2 > window.exact * half**3:
        return None
    turn = acos(float(np.clip(-d / reach, -1.0, 1.0))) if not touch else (0.0 if d < 0 else np.pi)
    lines = []
    for angle in (towards + turn,) if touch else (towards + turn, towards - turn):
        out = cos(angle) * cylinder.a * cylinder.x + sin(angle) * cylinder.b * cylinder.y
        way = cylinder.axis
        if not touch:
            way = np.cross(plane.normal_vector, cylinder.normal(middle + out))
            way = way / norm(way) * np.sign(dot(way, cylinder.axis))
        lines.append(clipped_line(middle + out, way, window))
    return Intersection(tuple(PairCurve(line, touch) for line in lines if line))
