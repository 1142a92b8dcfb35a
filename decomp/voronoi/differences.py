"""Pairs whose offsets subtract to an equation without d: equal radii about points, lines, circles.

Also cylinders with parallel axes: the Voronoi curves of two circles (Propositions 4.3, 4.4), along
the axes.
"""

from __future__ import annotations

from fractions import Fraction
from math import pi, sqrt

import numpy as np

from decomp.vectors import Array, norm
from decomp.voronoi.exact import cross, floats, inner, minus
from decomp.voronoi.found import Found, both_of
from decomp.voronoi.kinds import Kind
from decomp.voronoi.polynomial import Polynomial, linear, rational
from decomp.voronoi.position import Axis, aligned
from decomp.voronoi.profile import CurveKind, ProfileCircle, voronoi_curve
from decomp.voronoi.shape import Shape, plane_pair, shape
from decomp.voronoi.sites import ConeSite, CylinderSite, PlaneSite, SphereSite, TorusSite


def two_planes(f: PlaneSite, g: PlaneSite, e: int) -> Found:
    """Planes that meet: Theorem 4.6 (i)."""
    a, b = f.carrier, g.carrier
    n = a.normal_vector - e * b.normal_vector
    size = float(norm(n))
    c = float(a.normal_vector @ a.point) - e * float(b.normal_vector @ b.point)
    # the point of the plane nearest to f's own
    origin = a.point - (float(n @ a.point) - c) / size**2 * n
    raw = f.distance - e * g.distance
    return shape(Kind.PLANE, origin, n / size), Polynomial.of(raw, f.point)


def ball_and_tube(ball: SphereSite, tube: CylinderSite) -> Found:
    """Sphere and cylinder (point and line) of equal radius: |p - q|^2 = rho^2.

    With x from the line to the point at distance h and z along the line: z^2 = 2 h x - h^2.
    """
    axis = Axis(tube.point, tube.axis)
    foot = floats(axis.foot(ball.centre))
    away = floats(ball.centre) - foot
    h = float(norm(away))
    x = away / h
    found = shape(
        Kind.PARABOLIC_CYLINDER, foot + away / 2, np.cross(x, axis.unit), x, focal_length=h / 2
    )
    return found, Polynomial.of(ball.square - tube.square, ball.centre)


def equal_tubes(f: CylinderSite, g: CylinderSite, tolerance: float) -> Found:
    """Cylinders (or lines) of equal radius whose axes are not parallel: Theorem 4.8 (i).

    With f's axis along u at height -h and g's along v at height h, x and y bisecting their
    directions at angle 2 a: rho_f^2 - rho_g^2 = 4 h z + 2 x y sin 2 a.
    """
    u, v = Axis(f.point, f.axis).unit, Axis(g.point, g.axis).unit
    p, q = floats(f.point), floats(g.point)
    sine, cosine = float(norm(np.cross(u, v))), float(u @ v)
    z = np.cross(u, v) / sine
    between = q - p
    # p + s u and q + t v are nearest to each other
    s = (float(between @ u) - cosine * float(between @ v)) / sine**2
    t = (cosine * float(between @ u) - float(between @ v)) / sine**2
    middle = (p + s * u + q + t * v) / 2
    h = float(between @ z) / 2
    polynomial = Polynomial.of(f.square - g.square, f.point)
    if 2 * abs(h) <= tolerance:
        return _bisectors(middle, u, v), polynomial
    bisector = (u + v) / norm(u + v)
    x = (bisector + np.cross(z, bisector)) / sqrt(2)
    focal = abs(h) / sine
    up = -z if h > 0 else z
    found = shape(
        Kind.HYPERBOLIC_PARABOLOID, middle, up, x, focal_length_x=focal, focal_length_y=focal
    )
    return found, polynomial


def _bisectors(middle: Array, u: Array, v: Array) -> Shape:
    """The planes at right angles to u and v together, through their two bisectors."""
    normal = np.cross(u, v)
    z = normal / norm(normal)
    bisector = (u + v) / norm(u + v)
    x = (bisector + np.cross(z, bisector)) / sqrt(2)
    return plane_pair(middle, z, x, pi / 4)


def parallel_tubes(
    f: CylinderSite, g: CylinderSite, e: int, tolerance: float, angle: float
) -> Found:
    """Cylinders (or lines) with parallel axes apart: Theorem 4.8 (i)."""
    axis = Axis(f.point, f.axis)
    z, origin = axis.unit, axis.origin
    away = floats(minus(g.point, axis.foot(g.point)))
    gap = float(norm(away))
    x = away / gap
    zero = Fraction(0)
    curve = voronoi_curve(
        ProfileCircle(zero, zero, f.radius),
        ProfileCircle(Fraction(gap), zero, g.radius),
        e,
        tolerance,
        angle,
    )
    u, v, k2 = f.square, g.square, rational(f.radius - e * g.radius) ** 2
    centre = origin + float(curve.centre[0]) * x
    if curve.kind is CurveKind.EMPTY:
        return shape(Kind.EMPTY, origin, z), None
    if curve.kind is CurveKind.LINE:
        return shape(Kind.PLANE, centre, x, z), Polynomial.of(u - v, f.point)
    if curve.kind in (CurveKind.RAY, CurveKind.SEGMENT):
        raw = _plane_of_axes(f, g, axis)
        return shape(Kind.PLANE, origin, np.cross(z, x), x), raw
    kind = Kind.HYPERBOLIC_CYLINDER if curve.kind is CurveKind.HYPERBOLA else Kind.ELLIPTIC_CYLINDER
    found = shape(kind, centre, z, x, a=curve.a, b=curve.b)
    return found, Polynomial.of((u - v - k2) ** 2 - 4 * k2 * v, f.point)


def level_rings(f: TorusSite, g: TorusSite, tolerance: float, angle: float) -> Found:
    """Circles or equal tubes whose spines lie in one plane: (rho_f - R_f)^2 = (rho_g - R_g)^2.

    The even and the odd surface of the cylinders through the spines, together.
    """
    tubes = CylinderSite(f.centre, f.axis, f.major), CylinderSite(g.centre, g.axis, g.major)
    found = [parallel_tubes(*tubes, e, tolerance, angle) for e in (1, -1)]
    return both_of(found, f.centre)


def tubes_for_cones(
    f: ConeSite, g: ConeSite, e: int, angle: float
) -> tuple[CylinderSite, CylinderSite] | None:
    """Cylinders that have the same Voronoi surface as cones of equal angle and parallel axes.

    With g's apex h above f's, rho_f - rho_g = -h tan (even) if both open upwards, rho_f + rho_g =
    h tan (odd) if g opens downwards: the equations of cylinders with these differences of radii.
    """
    sense = aligned(f.axis, g.axis, angle)
    if sense != e or abs(float(f.sine - g.sine)) > angle:
        return None
    k = -e * Axis(f.apex, f.axis).height(g.apex) * f.sine / f.cosine
    zero = Fraction(0)
    if e > 0:
        one, two = max(k, zero), max(-k, zero)
    else:
        # without a common point the sum of two distances would have to be negative
        one, two = max(k, zero), zero
    return CylinderSite(f.apex, f.axis, one), CylinderSite(g.apex, f.axis, two)


def _plane_of_axes(f: CylinderSite, g: CylinderSite, axis: Axis) -> Polynomial:
    a, b = f.axis, minus(g.point, axis.foot(g.point))
    normal = cross(a, b)
    return Polynomial.of(linear(normal, -inner(normal, f.point)), f.point)
