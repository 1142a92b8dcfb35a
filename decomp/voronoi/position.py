"""How two sites lie to each other: parallel, on one axis, meeting, skew, concentric."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

import numpy as np

from decomp.vectors import Array, norm
from decomp.voronoi.exact import Vector, floats, inner, length, minus, moved, unit
from decomp.voronoi.sites import (
    CarrierSite,
    ConeSite,
    CylinderSite,
    PlaneSite,
    SphereSite,
    TorusSite,
)


@dataclass(frozen=True, eq=False)
class Axis:
    """A line with a sense.

    Args:
        point: on it.
        direction: along it, of any length.
    """

    point: Vector
    direction: Vector

    @property
    def length(self) -> Fraction:
        """Of the direction."""
        return length(self.direction)

    @property
    def unit(self) -> Array:
        """The direction in floating point (3,)."""
        return unit(self.direction)

    @property
    def origin(self) -> Array:
        """The point in floating point (3,)."""
        return floats(self.point)

    def height(self, p: Vector) -> Fraction:
        """Of a point above the axis's own point."""
        return inner(minus(p, self.point), self.direction) / self.length

    def foot(self, p: Vector) -> Vector:
        """The point of the axis nearest to p, exactly."""
        square = inner(self.direction, self.direction)
        return moved(
            self.point, inner(minus(p, self.point), self.direction) / square, self.direction
        )

    def gap(self, p: Vector) -> float:
        """Distance of a point from the axis."""
        return float(norm(floats(minus(p, self.foot(p)))))


def axis_of(site: CarrierSite) -> Axis | None:
    """The axis of a cylinder, cone or torus."""
    if isinstance(site, CylinderSite):
        return Axis(site.point, site.axis)
    if isinstance(site, ConeSite):
        return Axis(site.apex, site.axis)
    if isinstance(site, TorusSite):
        return Axis(site.centre, site.axis)
    return None


def aligned(a: Vector, b: Vector, angle: float) -> int:
    """+1 or -1 if two directions agree or oppose each other within an angle, else 0."""
    one, two = unit(a), unit(b)
    if float(norm(np.cross(one, two))) > angle:
        return 0
    return 1 if float(one @ two) > 0 else -1


def common_axis(f: CarrierSite, g: CarrierSite, tolerance: float, angle: float) -> Axis | None:
    """The axis about which both sites are surfaces of revolution, if there is one.

    Args:
        tolerance: lengths below it count as zero.
        angle: angles (radians) below it count as zero.
    """
    first, second = axis_of(f), axis_of(g)
    if first is None and second is not None:
        return common_axis(g, f, tolerance, angle)
    if first is None:
        if isinstance(f, PlaneSite) and isinstance(g, PlaneSite):
            parallel = aligned(f.normal, g.normal, angle)
            return Axis(f.point, f.normal) if parallel else None
        if isinstance(f, PlaneSite):
            return Axis(g.reference, f.normal)
        if isinstance(g, PlaneSite):
            return Axis(f.reference, g.normal)
        between = minus(g.reference, f.reference)
        apart = float(norm(floats(between))) > tolerance
        return Axis(f.reference, between if apart else (Fraction(0), Fraction(0), Fraction(1)))
    if isinstance(g, PlaneSite):
        return first if aligned(first.direction, g.normal, angle) else None
    if isinstance(g, SphereSite):
        return first if first.gap(g.centre) <= tolerance else None
    assert second is not None
    if not aligned(first.direction, second.direction, angle):
        return None
    return first if first.gap(second.point) <= tolerance else None
