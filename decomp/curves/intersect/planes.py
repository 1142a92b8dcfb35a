"""A plane with a plane, a cylinder or a cone: lines and conics."""

from __future__ import annotations

from math import acosh, asinh, cos, sin, sqrt

import numpy as np

from decomp.carriers import Cone, Cylinder, Plane
from decomp.curves.base import Curve
from decomp.curves.circle import Circle
from decomp.curves.ellipse import Ellipse
from decomp.curves.hyperbola import Hyperbola
from decomp.curves.intersect.result import (
    Intersection,
    PairCurve,
    Window,
    clipped_line,
    inside,
    points,
    ray,
)
from decomp.curves.parabola import Parabola
from decomp.tolerance import EXACTLY_PARALLEL
from decomp.vectors import Array, dot, frame, norm

LARGE = 30.0
"""Conics with an axis beyond this many window radii are traced inside the window instead."""
ROUND = 1e-14
"""Half-axes are equal if they differ by less than this part: the ellipse is a circle."""


def plane_plane(a: Plane, b: Plane, window: Window) -> Intersection:
    """The line across both normals."""
    cross = np.cross(a.normal_vector, b.normal_vector)
    size = float(norm(cross))
    if size * window.radius <= window.tolerance:
        return Intersection()
    d = cross / size
    p = window.centre
    for _ in range(3):
        fa, fb = a.signed_distance(p), b.signed_distance(p)
        step = np.cross(fa * b.normal_vector - fb * a.normal_vector, d) / size
        p = p - step
    line = clipped_line(p, d, window)
    return Intersection((PairCurve(line),)) if line else Intersection()


def plane_cylinder(plane: Plane, cylinder: Cylinder, window: Window) -> Intersection | None:
    """Lines, a circle or an ellipse; None if the ellipse is too long for the window."""
    n, k, r = plane.normal_vector, cylinder.axis, cylinder.radius
    c = float(dot(n, k))
    middle = cylinder.point + dot(window.centre - cylinder.point, k) * k
    d = float(plane.signed_distance(middle))
    if abs(c) * window.radius <= window.tolerance:
        across = n - c * k
        across = across / norm(across)
        touch = abs(abs(d) - r) <= window.tolerance
        slanted = abs(c) * window.radius > window.exact
        if abs(d) > r and not touch:
            return None if slanted else Intersection()
        h = 0.0 if touch else sqrt((r - d) * (r + d))
        # the long ellipse leaves its tangents by (c R r)^2 / 2 h^3
        if not touch and slanted and (c * window.radius * r) ** 2 > window.exact * h**3:
            return None
        x = -np.copysign(r, d) if touch else -d
        side = np.cross(k, across)
        radial = [x * across + e * h * side for e in ((1,) if touch else (1, -1))]
        ways = [
            k if touch else np.cross(n, way) * np.sign(dot(np.cross(n, way), k)) for way in radial
        ]
        lines = [
            clipped_line(middle + out, way / norm(way), window)
            for out, way in zip(radial, ways, strict=True)
        ]
        return Intersection(tuple(PairCurve(one, touch) for one in lines if one))
    a = r / abs(c)
    if a > LARGE * window.radius:
        return None
    centre = middle - d / c * k
    if float(norm(centre - window.centre)) > a + window.radius:
        return Intersection()
    x, y = _axes(k - c * n, n)
    curve = ellipse(centre, x, y, a, r)
    return Intersection((PairCurve(curve),)) if inside(curve, window) else Intersection()


def ellipse(centre: Array, x: Array, y: Array, a: float, b: float) -> Curve:
    """An ellipse, or a circle if the axes are equal."""
    if abs(a - b) <= ROUND * max(a, b):
        return Circle(centre, x, y, (a + b) / 2)
    return Ellipse(centre, x, y, a, b)


def plane_cone(plane: Plane, cone: Cone, window: Window) -> Intersection | None:
    """Rulings or a conic of the nappe; None if the conic is too long for the window.

    In the plane through the axis across the given plane, the rulings
    cos(angle) k +- sin(angle) m meet the plane at distances s1, s2 from the apex. The conic has
    its vertices there; its minor semi-axis squared is |s1 s2| sin^2(angle), the product of the
    cone's radii at the vertices; the parabola is the limit s2 -> infinity.
    """
    n, k = plane.normal_vector, cone.axis
    ca, sa = cos(cone.angle), sin(cone.angle)
    c = float(dot(n, k))
    m = n - c * k
    s = float(norm(m))
    m = m / s if s > EXACTLY_PARALLEL else frame(k)[0]
    d = float(plane.signed_distance(cone.apex))
    e1, e2 = c * ca + s * sa, c * ca - s * sa
    reach = window.reach(cone.apex)
    if abs(d) <= window.tolerance:
        found = _through_apex(plane, cone, (m, s, c), min(abs(e1), abs(e2)) * reach, window)
        if abs(d) <= window.exact or not found.curves or found.curves[0].tangent:
            return found
    rulings = [ca * k + sa * m, ca * k - sa * m]
    first = rulings[0]
    if abs(e1) < abs(e2):
        e1, e2, rulings = e2, e1, rulings[::-1]
    s1 = -d / e1
    vertex = cone.apex + s1 * rulings[0]
    y = np.cross(k, m)
    if abs(e2) * reach <= window.exact:
        if s1 <= 0:
            return Intersection()
        t = window.reach(vertex)
        parabola = Parabola(vertex, rulings[1], y, s1 * sa**2, domain=(-t, t))
        return _single(parabola, window)
    s2 = -d / e2
    if s1 < 0 and s2 < 0:
        return Intersection()
    sign = 1.0 if rulings[0] is first else -1.0
    across, up = sign * sa / 2 * m, ca / 2 * k
    centre = cone.apex + (s1 + s2) * up + (s1 - s2) * across
    a = float(norm((s1 - s2) * up + (s1 + s2) * across))
    b = sqrt(abs(s1 * s2)) * sa
    if a > LARGE * window.radius:
        return None
    x = s * k - c * m  # the axis seen in the plane
    if s1 * s2 > 0:
        return _single(ellipse(centre, x, y, a, b), window)
    far = window.reach(centre + a * x)
    t = min(asinh(far / b), acosh(1 + far / a))
    return _single(Hyperbola(centre, x, y, a, b, domain=(-t, t)), window)


def _single(curve: Curve, window: Window) -> Intersection:
    return Intersection((PairCurve(curve),)) if inside(curve, window) else Intersection()


def _through_apex(
    plane: Plane, cone: Cone, split: tuple[Array, float, float], defect: float, window: Window
) -> Intersection:
    """The plane holds the apex: only the apex, one ruling where it touches, or two rulings."""
    m, s, c = split
    if not window.reach(cone.apex) >= 0:
        return Intersection()
    apex = cone.apex
    down = s * cone.axis - c * m  # the axis seen in the plane; its slope against it has cosine s
    side = np.cross(plane.normal_vector, down)
    ratio = cos(cone.angle) / s if s > 0 else np.inf
    if defect <= window.tolerance:
        sign = -np.sign(c)
        d = cos(cone.angle) * cone.axis + sign * sin(cone.angle) * m
        line = ray(apex, d, window)
        return Intersection((PairCurve(line, True),) if line else ())
    if ratio > 1:
        near = float(norm(apex - window.centre)) <= window.radius
        return Intersection(contacts=points([apex] if near else []))
    h = sqrt((1 - ratio) * (1 + ratio))
    rays = [ray(apex, ratio * down + e * h * side, window) for e in (1, -1)]
    curves = tuple(PairCurve(one) for one in rays if one)
    return Intersection(curves, nodes=points([apex] if curves else []))


def _axes(direction: Array, n: Array) -> tuple[Array, Array]:
    """Unit vectors across n, the first along `direction` as far as it has one."""
    size = float(norm(direction))
    x = direction / size if size > EXACTLY_PARALLEL else frame(n)[0]
    x = x - dot(x, n) * n
    x = x / norm(x)
    return x, np.cross(n, x)
