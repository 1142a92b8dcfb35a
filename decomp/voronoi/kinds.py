"""The kinds of Voronoi surfaces, in the field's words, and their canonical equations."""

from __future__ import annotations

from enum import Enum


class Kind(Enum):
    """What a Voronoi surface is.

    The equations below are those in a shape's own frame (`Shape.local`); rho is the distance from
    its z axis. All surfaces of revolution turn about that axis.
    """

    PLANE = "plane"
    """z = 0"""
    PLANE_PAIR = "pair of planes"
    """|y| cos(half_angle) = |x| sin(half_angle)"""
    SPHERE = "sphere"
    """x^2 + y^2 + z^2 = radius^2"""
    TORUS = "torus"
    """(rho - major)^2 + z^2 = minor^2"""
    CIRCULAR_CONE = "right circular cone"
    """rho cos(half_angle) = |z| sin(half_angle)"""
    ELLIPTIC_CONE = "elliptic cone"
    """x^2 / tan(half_angle_x)^2 + y^2 / tan(half_angle_y)^2 = z^2"""
    CIRCULAR_CYLINDER = "circular cylinder"
    """rho = radius"""
    ELLIPTIC_CYLINDER = "elliptic cylinder"
    """x^2 / a^2 + y^2 / b^2 = 1"""
    PARABOLIC_CYLINDER = "parabolic cylinder"
    """y^2 = 4 focal_length x"""
    HYPERBOLIC_CYLINDER = "hyperbolic cylinder"
    """x^2 / a^2 - y^2 / b^2 = 1"""
    PARABOLOID = "paraboloid of revolution"
    """rho^2 = 4 focal_length z"""
    PROLATE_SPHEROID = "prolate spheroid"
    """z^2 / a^2 + rho^2 / b^2 = 1, a > b"""
    ONE_SHEETED_HYPERBOLOID = "one-sheeted hyperboloid of revolution"
    """rho^2 / a^2 - z^2 / b^2 = 1"""
    TWO_SHEETED_HYPERBOLOID = "two-sheeted hyperboloid of revolution"
    """z^2 / a^2 - rho^2 / b^2 = 1"""
    HYPERBOLIC_PARABOLOID = "hyperbolic paraboloid"
    """x^2 / (4 focal_length_x) - y^2 / (4 focal_length_y) = z"""
    REVOLVED_PARABOLA = "surface of revolution of a parabola"
    """u^2 = 4 focal_length v; u and v: see `Profile`"""
    REVOLVED_ELLIPSE = "surface of revolution of an ellipse"
    """u^2 / a^2 + v^2 / b^2 = 1, a >= b"""
    REVOLVED_HYPERBOLA = "surface of revolution of a hyperbola"
    """u^2 / a^2 - v^2 / b^2 = 1"""
    TWO_SURFACES = "two surfaces"
    """each by its own equation: see `Shape.parts`"""
    GENERAL = "general algebraic surface"
    """known by its polynomial, or by its sites alone"""
    LINE = "line"
    """x = y = 0: the sites touch, and what is equidistant has no area"""
    POINT = "point"
    """x = y = z = 0"""
    EMPTY = "empty"
    """no real point is equidistant with this parity"""

    @property
    def dimension(self) -> int:
        """2 for surfaces, 1 for a line, 0 for a point, -1 for nothing."""
        return {Kind.LINE: 1, Kind.POINT: 0, Kind.EMPTY: -1}.get(self, 2)
