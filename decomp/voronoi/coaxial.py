"""Sites of revolution about one axis: their Voronoi surface is one, too.

Its profile is a Voronoi curve of lines and circles in the half-plane of rho and z: the paper's
Theorems 4.6 (ii), (v), 4.7, 4.8 (ii), (iii), 4.9 and 4.10.
"""

from __future__ import annotations

from fractions import Fraction
from math import atan, atan2

import numpy as np
from flint import fmpq

from decomp.voronoi.exact import inner
from decomp.voronoi.found import Found
from decomp.voronoi.kinds import Kind
from decomp.voronoi.polynomial import (
    RING,
    Polynomial,
    Raw,
    height,
    rational,
    squared_distance,
    squared_distance_from_line,
)
from decomp.voronoi.position import Axis
from decomp.voronoi.profile import (
    CurveKind,
    Profile,
    ProfileCircle,
    ProfileCurve,
    ProfileLine,
    voronoi_curve,
)
from decomp.voronoi.shape import Shape, shape
from decomp.voronoi.sites import (
    CarrierSite,
    ConeSite,
    CylinderSite,
    PlaneSite,
    SphereSite,
    TorusSite,
)

ZERO, ONE = Fraction(0), Fraction(1)


def coaxial_surface(
    f: CarrierSite, g: CarrierSite, e: int, axis: Axis, tolerance: float, angle: float
) -> Found:
    """The Voronoi surface s_f = e s_g of two sites of revolution about `axis`.

    Raises:
        InputError: the sites coincide.
    """
    curve = voronoi_curve(profile_of(f, axis), profile_of(g, axis), e, tolerance, angle)
    found = revolved(curve, axis, tolerance, angle)
    if found.kind is Kind.EMPTY:
        return found, None
    if found.kind in (Kind.LINE, Kind.POINT):
        raw = squared_distance_from_line(axis.point, axis.direction)
    elif isinstance(f, SphereSite) and isinstance(g, SphereSite):
        raw = _spheres(f, g, e, curve)
    else:
        assert curve.equation is not None
        raw = revolved_equation(curve.equation, axis)
    return found, Polynomial.of(raw, axis.point)


def profile_of(site: CarrierSite, axis: Axis) -> Profile:
    """The section of a site of revolution with a half-plane through its axis."""
    z = axis.height(site.reference)
    if isinstance(site, PlaneSite):
        sense = ONE if inner(site.normal, axis.direction) > 0 else -ONE
        return ProfileLine(ZERO, sense, sense * z)
    if isinstance(site, SphereSite):
        return ProfileCircle(ZERO, z, site.radius)
    if isinstance(site, CylinderSite):
        return ProfileLine(ONE, ZERO, site.radius)
    if isinstance(site, ConeSite):
        sine = site.sine if inner(site.axis, axis.direction) > 0 else -site.sine
        return ProfileLine(site.cosine, -sine, -sine * z)
    assert isinstance(site, TorusSite)
    return ProfileCircle(site.major, z, site.minor)


def revolved(curve: ProfileCurve, axis: Axis, tolerance: float, angle: float) -> Shape:
    """What a profile curve sweeps when it turns about the axis."""
    z, origin = axis.unit, axis.origin
    rho, high = float(curve.centre[0]), float(curve.centre[1])
    along = float(curve.direction[1])
    tilt = atan2(along, float(curve.direction[0]))
    on_axis = abs(rho) <= tolerance
    upright = on_axis and abs(float(curve.direction[0])) <= angle
    centre = origin + high * z
    forward = z if along > 0 else -z
    place = {"centre_rho": rho, "centre_z": high, "tilt": tilt}
    if curve.kind is CurveKind.EMPTY:
        return shape(Kind.EMPTY, origin, z)
    if curve.kind in (CurveKind.LINE, CurveKind.RAY, CurveKind.SEGMENT):
        return _revolved_line(curve, axis, tolerance, angle)
    if curve.kind is CurveKind.CIRCLE:
        if on_axis:
            return shape(Kind.SPHERE, centre, z, radius=curve.a)
        return shape(Kind.TORUS, centre, z, major=rho, minor=curve.a)
    if curve.kind is CurveKind.PARABOLA:
        if upright:
            return shape(Kind.PARABOLOID, centre, forward, focal_length=curve.focal_length)
        place["tilt"] = tilt - np.pi / 2
        values = {"focal_length": curve.focal_length, **place}
        return shape(Kind.REVOLVED_PARABOLA, origin, z, **values)
    ellipse = curve.kind is CurveKind.ELLIPSE
    if upright:
        kind = Kind.PROLATE_SPHEROID if ellipse else Kind.TWO_SHEETED_HYPERBOLOID
        return shape(kind, centre, forward, a=curve.a, b=curve.b)
    kind = Kind.REVOLVED_ELLIPSE if ellipse else Kind.REVOLVED_HYPERBOLA
    return shape(kind, origin, z, a=curve.a, b=curve.b, **place)


def _revolved_line(curve: ProfileCurve, axis: Axis, tolerance: float, angle: float) -> Shape:
    z = axis.unit
    (rho, high), (across, along) = curve.centre, curve.direction
    if abs(float(along)) <= angle:
        return shape(Kind.PLANE, axis.origin + high * z, z)
    if abs(float(across)) <= angle:
        if abs(float(rho)) <= tolerance:
            return shape(Kind.LINE, axis.origin, z)
        if rho < 0:
            return shape(Kind.EMPTY, axis.origin, z)
        return shape(Kind.CIRCULAR_CYLINDER, axis.origin, z, radius=float(rho))
    apex = axis.origin + (high - rho * along / across) * z
    opening = z if across * along > 0 else -z
    return shape(Kind.CIRCULAR_CONE, apex, opening, half_angle=atan(abs(float(across / along))))


def revolved_equation(equation: Raw, axis: Axis) -> Raw:
    """The polynomial of the surface that a profile's equation sweeps.

    With E(rho, z) = A + B rho, A and B even in rho, it is A if B vanishes, else E(rho) E(-rho) =
    A^2 - B^2 rho^2.
    """
    square = squared_distance_from_line(axis.point, axis.direction)
    z = height(axis.point, axis.direction) / rational(axis.length)
    even, odd = RING.from_dict({}), RING.from_dict({})
    for exponents, coefficient in equation.to_dict().items():
        i, j = int(exponents[0]), int(exponents[2])
        term = fmpq(coefficient.p, coefficient.q) * square ** (i // 2) * z**j
        if i % 2:
            odd = odd + term
        else:
            even = even + term
    return even if not len(odd) else even**2 - odd**2 * square


def _spheres(f: SphereSite, g: SphereSite, e: int, curve: ProfileCurve) -> Raw:
    """Of two spheres, without the length of the line between their centres."""
    u, v = squared_distance(f.centre), squared_distance(g.centre)
    if curve.kind is CurveKind.CIRCLE:
        return u - rational((f.radius + g.radius) / 2) ** 2
    if curve.kind is CurveKind.LINE:
        return u - v
    k2 = rational(f.radius - e * g.radius) ** 2
    return (u - v - k2) ** 2 - 4 * k2 * v
