"""Surfaces rho = L(p): the distance from an axis equals a linear function of the point.

Where L changes along the axis the surface is a cone: the paper's Theorem 4.6 (iii) and (iv) for a
plane with a cylinder or cone. Where it does not, each section across the axis is a conic with its
focus on the axis and the directrix L = 0, and the surface is a cylinder over it.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from math import atan, atan2, cos, sin, sqrt

import numpy as np

from decomp.vectors import Array
from decomp.voronoi.exact import Vector, cross, floats, inner, length, minus, moved
from decomp.voronoi.found import Found
from decomp.voronoi.kinds import Kind
from decomp.voronoi.polynomial import Polynomial, linear, squared_distance_from_line
from decomp.voronoi.position import Axis
from decomp.voronoi.shape import Shape, plane_pair, shape
from decomp.voronoi.sites import (
    CarrierSite,
    ConeSite,
    CylinderSite,
    PlaneSite,
    SphereSite,
    TorusSite,
)

ORIGIN: Vector = (Fraction(0), Fraction(0), Fraction(0))


@dataclass(frozen=True, eq=False)
class FocalForm:
    """rho = gradient . p + constant, with rho the distance from the axis."""

    axis: Axis
    gradient: Vector
    constant: Fraction

    def polynomial(self) -> Polynomial:
        """(gradient . p + constant)^2 - rho^2."""
        square = squared_distance_from_line(self.axis.point, self.axis.direction)
        raw = linear(self.gradient, self.constant) ** 2 - square
        return Polynomial.of(raw, self.axis.point)


def focal_form(f: CarrierSite, g: CarrierSite, e: int, tolerance: float) -> FocalForm | None:
    """The Voronoi surface s_f = e s_g in the form rho = L, where it has one."""
    for one, two in ((f, g), (g, f)):
        if isinstance(one, PlaneSite) and isinstance(two, (CylinderSite, ConeSite)):
            return _with_plane(one, two, e)
        if isinstance(one, TorusSite) and isinstance(two, SphereSite):
            equal = abs(float(one.minor - e * two.radius)) <= tolerance
            return _ring_and_ball(one, two) if equal else None
    return None


def _signed_distance(plane: PlaneSite) -> tuple[Vector, Fraction]:
    """Gradient and constant of the signed distance from a plane."""
    size = length(plane.normal)
    gradient = moved(ORIGIN, 1 / size, plane.normal)
    return gradient, -inner(gradient, plane.point)


def _with_plane(plane: PlaneSite, other: CylinderSite | ConeSite, e: int) -> FocalForm:
    """rho - r = e s, or rho cos - z sin = e s."""
    gradient, constant = _signed_distance(plane)
    gradient, constant = moved(ORIGIN, Fraction(e), gradient), e * constant
    if isinstance(other, CylinderSite):
        return FocalForm(Axis(other.point, other.axis), gradient, constant + other.radius)
    climb = other.sine / length(other.axis)
    gradient = moved(gradient, climb, other.axis)
    constant -= climb * inner(other.axis, other.apex)
    scaled = moved(ORIGIN, 1 / other.cosine, gradient)
    return FocalForm(Axis(other.apex, other.axis), scaled, constant / other.cosine)


def _ring_and_ball(ring: TorusSite, ball: SphereSite) -> FocalForm:
    """(rho - R)^2 + z^2 = |p - q|^2, so that 2 R rho = 2 (q - c).p + c.c + R^2 - q.q."""
    c, q, major = ring.centre, ball.centre, ring.major
    gradient = moved(ORIGIN, 1 / major, minus(q, c))
    constant = (inner(c, c) + major**2 - inner(q, q)) / (2 * major)
    return FocalForm(Axis(c, ring.axis), gradient, constant)


def focal_surface(form: FocalForm, tolerance: float, angle: float) -> Found:
    """What surface it is, and its polynomial."""
    z, origin = form.axis.unit, form.axis.origin
    gradient = floats(form.gradient)
    constant = float(inner(form.gradient, form.axis.point) + form.constant)
    climb = float(gradient @ z)
    across = gradient - climb * z
    slope = float(np.linalg.norm(across))
    x = across / slope if slope > angle else None
    if abs(climb) > angle:
        found = _cone(origin - constant / climb * z, z, x, slope, climb)
    elif abs(constant) <= tolerance:
        found = _degenerate(origin, z, x, slope, angle)
    else:
        found = _cylinder(origin, z, x, slope, constant, angle)
    if found.kind is Kind.EMPTY:
        return found, None
    if found.kind is Kind.PLANE:
        normal = form.axis.direction, form.gradient
        raw = linear(cross(*normal), -inner(cross(*normal), form.axis.point))
        return found, Polynomial.of(raw, form.axis.point)
    return found, form.polynomial()


def _cone(apex: Array, z: Array, x: Array | None, slope: float, climb: float) -> Shape:
    """rho = climb z + slope x about the apex."""
    if x is None:
        opening = z if climb > 0 else -z
        return shape(Kind.CIRCULAR_CONE, apex, opening, half_angle=atan(abs(climb)))
    # (1 - m^2) x^2 - 2 m c x z - c^2 z^2 + y^2: turned by t in the plane of x and z
    turn = atan2(2 * slope * climb, climb**2 + 1 - slope**2) / 2
    form = np.array([[1 - slope**2, -slope * climb], [-slope * climb, -(climb**2)]])
    w = np.array([sin(turn), cos(turn)])
    u = np.array([cos(turn), -sin(turn)])
    negative, positive = float(w @ form @ w), float(u @ form @ u)
    axis = w[0] * x + w[1] * z
    if climb * w[1] + slope * w[0] < 0:
        axis = -axis
    side = u[0] * x + u[1] * z
    angles = {
        "half_angle_x": atan(sqrt(-negative / positive)),
        "half_angle_y": atan(sqrt(-negative)),
    }
    return shape(Kind.ELLIPTIC_CONE, apex, axis, side, **angles)


def _cylinder(
    origin: Array, z: Array, x: Array | None, slope: float, constant: float, angle: float
) -> Shape:
    """rho = slope x + constant: a conic of eccentricity `slope` with its focus on the axis."""
    if x is None:
        if constant < 0:
            return shape(Kind.EMPTY, origin, z)
        return shape(Kind.CIRCULAR_CYLINDER, origin, z, radius=constant)
    if slope < 1 + angle and constant < 0:
        return shape(Kind.EMPTY, origin, z, x)
    if abs(slope - 1) <= angle:
        vertex = origin - constant / 2 * x
        return shape(Kind.PARABOLIC_CYLINDER, vertex, z, x, focal_length=constant / 2)
    centre = origin + slope * constant / (1 - slope**2) * x
    a, b = abs(constant / (1 - slope**2)), abs(constant) / sqrt(abs(1 - slope**2))
    kind = Kind.ELLIPTIC_CYLINDER if slope < 1 else Kind.HYPERBOLIC_CYLINDER
    return shape(kind, centre, z, x, a=a, b=b)


def _degenerate(origin: Array, z: Array, x: Array | None, slope: float, angle: float) -> Shape:
    """rho = slope x: nothing but the axis, a half-plane, or two half-planes from the axis."""
    if x is None or slope < 1 - angle:
        return shape(Kind.LINE, origin, z)
    if slope <= 1 + angle:
        return shape(Kind.PLANE, origin, np.cross(z, x), x)
    return plane_pair(origin, z, x, atan(sqrt(slope**2 - 1)))
