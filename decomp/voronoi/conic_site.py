"""Ellipses, parabolas and hyperbolas as sites, with the equation of their offsets.

The points at distance d from a conic in space are the centres of spheres of radius d that touch it.
In its plane such a sphere cuts a circle S, and that touches the conic C where the pencil t C + S
has a double root: the discriminant of the cubic det(t C + S) vanishes. Its degree in x, y, z, d is
8 for ellipse and hyperbola, 6 for the parabola.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property

from decomp.curves.base import Curve
from decomp.curves.ellipse import Ellipse
from decomp.curves.hyperbola import Hyperbola
from decomp.curves.parabola import Parabola
from decomp.tolerance import TOLERANCE
from decomp.vectors import Array, cross
from decomp.voronoi.curve_site import CurveSite
from decomp.voronoi.exact import Vector, exact, exact_vector, length
from decomp.voronoi.polynomial import D, Raw, height, rational, squared_distance
from decomp.voronoi.sites import TorusSite


@dataclass(frozen=True, eq=False)
class ConicSite(CurveSite):
    """a X^2 + b Y^2 + 2 c X + k = 0 in the plane through `centre` along `x` and `y`.

    The whole conic bears the equation, the curve's own arc the distances.
    """

    centre: Vector
    x: Vector
    y: Vector
    a: Fraction
    b: Fraction
    c: Fraction
    k: Fraction

    def offset(self, e: int) -> Raw:
        """The polynomial of the points at distance |d| from the conic; e does not matter."""
        return self._offset

    @cached_property
    def _offset(self) -> Raw:
        a, b, c, k = (rational(value) for value in (self.a, self.b, self.c, self.k))
        x = height(self.centre, self.x) / rational(length(self.x))
        y = height(self.centre, self.y) / rational(length(self.y))
        w = squared_distance(self.centre) - D**2
        # det(t C + S) = p t^3 + q t^2 + r t + s
        p = a * b * k - b * c**2
        q = a * b * w + a * k + b * k - c**2 + 2 * b * c * x
        r = (a + b) * w + k - a * y**2 - b * x**2 + 2 * c * x
        s = w - x**2 - y**2
        return 18 * p * q * r * s - 4 * q**3 * s + q**2 * r**2 - 4 * p * r**3 - 27 * p**2 * s**2


def of_conic(curve: Curve) -> ConicSite | TorusSite | None:
    """The site of an ellipse, parabola or hyperbola, None for another curve.

    An ellipse with equal axes is a circle.
    """
    zero, one = Fraction(0), Fraction(1)
    if isinstance(curve, Ellipse) and abs(curve.a - curve.b) <= TOLERANCE * curve.a:
        axis = exact_vector(cross(curve.x, curve.y), "a conic's axis")
        centre = exact_vector(curve.centre, "a conic's centre")
        return TorusSite(centre, axis, exact(curve.a), zero)
    if isinstance(curve, Ellipse):
        a, b = 1 / exact(curve.a) ** 2, 1 / exact(curve.b) ** 2
        return _placed(curve, curve.centre, curve.x, curve.y, (a, b, zero, -one))
    if isinstance(curve, Hyperbola):
        a, b = 1 / exact(curve.a) ** 2, -1 / exact(curve.b) ** 2
        return _placed(curve, curve.centre, curve.x, curve.y, (a, b, zero, -one))
    if isinstance(curve, Parabola):
        c = -2 * exact(curve.focal)
        return _placed(curve, curve.vertex, curve.x, curve.y, (zero, one, c, zero))
    return None


def _placed(
    curve: Curve,
    centre: Array,
    x: Array,
    y: Array,
    equation: tuple[Fraction, Fraction, Fraction, Fraction],
) -> ConicSite:
    origin, along, across = (exact_vector(v, "a conic's parameter") for v in (centre, x, y))
    return ConicSite(curve, origin, along, across, *equation)
