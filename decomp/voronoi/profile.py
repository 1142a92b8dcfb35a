"""Voronoi curves of lines and circles in a plane: the paper's Propositions 4.1 to 4.4.

The plane has coordinates q = (rho, z). Signed distances: n.q - c from a line with unit normal n,
|q - centre| - r from a circle (a point if r = 0). Parameters are exact, curves are floats.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from fractions import Fraction
from math import hypot, sqrt

import numpy as np

from decomp.errors import InputError
from decomp.vectors import Array
from decomp.voronoi.polynomial import Raw, X, Z, rational


@dataclass(frozen=True)
class ProfileLine:
    """The line normal_rho rho + normal_z z = constant, outside where the left side is larger."""

    normal_rho: Fraction
    normal_z: Fraction
    constant: Fraction


@dataclass(frozen=True)
class ProfileCircle:
    """A circle, or a point if the radius is zero."""

    rho: Fraction
    z: Fraction
    radius: Fraction


class CurveKind(Enum):
    """Plane curves whose points have equal distance from lines and circles."""

    LINE = "straight line"
    RAY = "half line"
    SEGMENT = "segment"
    PARABOLA = "parabola"
    ELLIPSE = "ellipse"
    HYPERBOLA = "branch of a hyperbola"
    CIRCLE = "circle"
    EMPTY = "empty"


@dataclass(frozen=True, eq=False)
class ProfileCurve:
    """A Voronoi curve.

    Args:
        kind: what it is.
        centre: of ellipse, hyperbola, circle; a parabola's vertex; a point of a line, the end of a
            half line, the middle of a segment (2,).
        direction: of the line or half line; from the centre to the focus of a parabola or of the
            hyperbola's branch; an ellipse's major axis (2,).
        a: major or transverse semi-axis, a circle's radius, half a segment's length.
        b: minor or conjugate semi-axis.
        focal_length: of a parabola.
        equation: the polynomial with rho in place of x, for true conics and lines squarefree.
    """

    kind: CurveKind
    centre: Array
    direction: Array
    a: float = 0.0
    b: float = 0.0
    focal_length: float = 0.0
    equation: Raw | None = None


Profile = ProfileLine | ProfileCircle
NO_CENTRE = np.zeros(2)
EMPTY = ProfileCurve(CurveKind.EMPTY, NO_CENTRE, NO_CENTRE)


def voronoi_curve(f: Profile, g: Profile, e: int, tolerance: float, angle: float) -> ProfileCurve:
    """The curve s_f = e s_g.

    Args:
        f, g: the sites.
        e: +1 for the even curve, -1 for the odd one.
        tolerance: lengths below it count as zero.
        angle: angles (radians) below it count as zero.

    Raises:
        InputError: the sites coincide, and everything is equidistant.
    """
    if isinstance(f, ProfileLine) and isinstance(g, ProfileLine):
        return _two_lines(f, g, e, tolerance, angle)
    if isinstance(f, ProfileLine) and isinstance(g, ProfileCircle):
        return _line_and_circle(f, g, e, tolerance)
    if isinstance(f, ProfileCircle) and isinstance(g, ProfileLine):
        return _line_and_circle(g, f, e, tolerance)
    assert isinstance(f, ProfileCircle) and isinstance(g, ProfileCircle)
    return _two_circles(f, g, e, tolerance)


def _line(n_rho: Fraction, n_z: Fraction, c: Fraction, kind: CurveKind, at: Array) -> ProfileCurve:
    """The part of n.q = c that begins at (or contains) `at`, going along the turned normal."""
    size = hypot(float(n_rho), float(n_z))
    direction = np.array([-float(n_z), float(n_rho)]) / size
    equation = rational(n_rho) * X + rational(n_z) * Z - rational(c)
    return ProfileCurve(kind, at, direction, equation=equation)


def _two_lines(
    f: ProfileLine, g: ProfileLine, e: int, tolerance: float, angle: float
) -> ProfileCurve:
    n_rho = f.normal_rho - e * g.normal_rho
    n_z = f.normal_z - e * g.normal_z
    c = f.constant - e * g.constant
    n_rho, n_z = (Fraction(0) if abs(float(n)) <= angle else n for n in (n_rho, n_z))
    if not n_rho and not n_z:
        if abs(float(c)) <= tolerance:
            raise InputError("the two sites coincide: every point is equidistant from them")
        return EMPTY
    normal = np.array([float(n_rho), float(n_z)])
    return _line(n_rho, n_z, c, CurveKind.LINE, float(c) * normal / float(normal @ normal))


def _line_and_circle(f: ProfileLine, g: ProfileCircle, e: int, tolerance: float) -> ProfileCurve:
    """|q - centre| = L(q) = r + e (n.q - c): Proposition 4.2; 4.1 if r = 0.

    The centre is the focus and L = 0 the directrix. If the centre is on it (the line touches the
    circle, or holds the point), the parabola degenerates into a half line, for a point into
    the whole perpendicular if both sides of the line are taken together.
    """
    n = e * np.array([float(f.normal_rho), float(f.normal_z)])
    centre = np.array([float(g.rho), float(g.z)])
    depth = g.radius + e * (f.normal_rho * g.rho + f.normal_z * g.z - f.constant)
    if abs(float(depth)) <= tolerance:
        # across the line: its normal is the direction turned back
        across = f.normal_rho * g.z - f.normal_z * g.rho
        line = _line(-f.normal_z, f.normal_rho, across, CurveKind.RAY, centre)
        return ProfileCurve(CurveKind.RAY, centre, n, equation=line.equation)
    if depth < 0:
        return EMPTY
    along = rational(f.normal_rho) * X + rational(f.normal_z) * Z - rational(f.constant)
    directrix = rational(g.radius) + e * along
    equation = (X - rational(g.rho)) ** 2 + (Z - rational(g.z)) ** 2 - directrix**2
    focal = float(depth) / 2
    return ProfileCurve(
        CurveKind.PARABOLA, centre - focal * n, n, focal_length=focal, equation=equation
    )


def _two_circles(f: ProfileCircle, g: ProfileCircle, e: int, tolerance: float) -> ProfileCurve:
    """|q - centre_f| = k + e |q - centre_g|, k = r_f - e r_g: Propositions 4.3 and 4.4."""
    one, two = (np.array([float(c.rho), float(c.z)]) for c in (f, g))
    between = two - one
    gap = float(np.hypot(*between))
    k = f.radius - e * g.radius
    a = abs(float(k)) / 2
    middle = (one + two) / 2
    if gap <= tolerance:
        return _concentric(f, g, e, tolerance, middle)
    u = (X - rational(f.rho)) ** 2 + (Z - rational(f.z)) ** 2
    v = (X - rational(g.rho)) ** 2 + (Z - rational(g.z)) ** 2
    if 2 * a <= tolerance and e > 0:
        turned = np.array([-between[1], between[0]]) / gap
        return ProfileCurve(CurveKind.LINE, middle, turned, equation=u - v)
    equation = (u - v - rational(k) ** 2) ** 2 - 4 * rational(k) ** 2 * v
    way = between / gap
    if abs(2 * a - gap) <= tolerance:
        n_rho, n_z = f.z - g.z, g.rho - f.rho
        through = n_rho * f.rho + n_z * f.z
        equation = rational(n_rho) * X + rational(n_z) * Z - rational(through)
        if e < 0:
            return ProfileCurve(CurveKind.SEGMENT, middle, way, a=a, equation=equation)
        end, outward = (two, way) if k > 0 else (one, -way)
        return ProfileCurve(CurveKind.RAY, end, outward, equation=equation)
    if (2 * a > gap) != (e < 0):
        return EMPTY
    b = sqrt(abs((2 * a - gap) * (2 * a + gap))) / 2
    kind = CurveKind.HYPERBOLA if e > 0 else CurveKind.ELLIPSE
    towards = way if k > 0 else -way
    return ProfileCurve(kind, middle, towards, a=a, b=b, equation=equation)


def _concentric(
    f: ProfileCircle, g: ProfileCircle, e: int, tolerance: float, centre: Array
) -> ProfileCurve:
    if e > 0 or (not f.radius and not g.radius):
        if abs(float(f.radius - g.radius)) <= tolerance:
            raise InputError("the two sites coincide: every point is equidistant from them")
        return EMPTY
    radius = (f.radius + g.radius) / 2
    equation = (X - rational(f.rho)) ** 2 + (Z - rational(f.z)) ** 2 - rational(radius) ** 2
    return ProfileCurve(
        CurveKind.CIRCLE, centre, np.array([1.0, 0.0]), a=float(radius), equation=equation
    )
