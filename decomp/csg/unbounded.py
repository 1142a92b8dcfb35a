"""The primitives that reach infinity: half-space, infinite cylinder, one nappe of a cone."""

from __future__ import annotations

from dataclasses import dataclass
from math import degrees, radians

import numpy as np
from numpy.typing import ArrayLike

from decomp import carriers
from decomp.csg.primitive import (
    HalfSpaces,
    Primitive,
    cone_through,
    radius_at_end,
    refuse_equal_radii,
    set_fields,
)
from decomp.errors import InputError
from decomp.exact import careful_difference, seen_about
from decomp.vectors import Array, direction, number, positive, vector


@dataclass(frozen=True, eq=False, repr=False, init=False)
class HalfSpace(Primitive):
    """All points behind the plane through `point`, away from where its normal points.

    Its one face bears the primitive's own name.

    Args:
        point: of the plane, (3,).
        normal: out of the half-space (3,), of any length.
        name: of its face; by default its kind and a number, as in `plane1`.

    Raises:
        InputError: not three finite numbers, or a zero normal.
    """

    kind = "plane"
    places = ("point",)
    point: Array
    normal: Array

    def __init__(self, point: ArrayLike, normal: ArrayLike, name: str | None = None) -> None:
        set_fields(
            self,
            name,
            point=vector(point, "plane point"),
            normal=direction(normal, "plane normal"),
        )

    def half_spaces(self) -> HalfSpaces:
        yield "", carriers.Plane(self.point, self.normal)


@dataclass(frozen=True, eq=False, repr=False, init=False)
class InfiniteCylinder(Primitive):
    """All points within `radius` of the line through `point` along `axis`.

    Face: `side`.

    Args:
        point: of the line, (3,).
        axis: its direction (3,), of any length.
        radius: above zero.

    Raises:
        InputError: not three finite numbers, a zero axis, or a radius that is not above zero.
    """

    kind = "cylinder"
    places = ("point",)
    point: Array
    axis: Array
    radius: float

    def __init__(
        self, point: ArrayLike, axis: ArrayLike, radius: float, name: str | None = None
    ) -> None:
        set_fields(
            self,
            name,
            point=vector(point, "cylinder point"),
            axis=direction(axis, "cylinder axis"),
            radius=positive(radius, "cylinder radius"),
        )

    def half_spaces(self) -> HalfSpaces:
        yield "side", carriers.Cylinder(self.point, self.axis, self.radius)


@dataclass(frozen=True, eq=False, repr=False, init=False)
class InfiniteCone(Primitive):
    """One nappe of a cone, from `apex` along `axis` to infinity.

    Face: `side`.

    Args:
        apex: (3,).
        axis: direction into the nappe (3,), of any length.
        half_angle: between axis and side, in degrees, above 0 and below 90.

    Raises:
        InputError: not three finite numbers, a zero axis, or an angle out of its range.
    """

    kind = "cone"
    places = ("apex",)
    apex: Array
    axis: Array
    half_angle: float
    ends: tuple[Array, float, Array, float] | None
    """What it was put `through`, which tells its apex more exactly where coordinates are large."""

    def __init__(
        self, apex: ArrayLike, axis: ArrayLike, half_angle: float, name: str | None = None
    ) -> None:
        set_fields(
            self,
            name,
            apex=vector(apex, "cone apex"),
            axis=direction(axis, "cone axis"),
            half_angle=number(half_angle, "cone half-angle"),
        )
        object.__setattr__(self, "ends", None)
        if not 0 < self.half_angle < 90:
            raise InputError(
                f"cone half-angle must lie between 0 and 90 degrees, got {self.half_angle:g}"
            )

    @classmethod
    def through(
        cls,
        point: ArrayLike,
        radius: float,
        point2: ArrayLike,
        radius2: float,
        name: str | None = None,
    ) -> InfiniteCone:
        """The nappe with given radii at two points of its axis.

        Args:
            point: of the axis, (3,).
            radius: at `point`, not negative.
            point2: another one of the axis.
            radius2: there, not negative, and another; the nappe widens to the greater.

        Raises:
            InputError: equal radii, a negative radius, equal points, or not finite numbers.
        """
        a, b = vector(point, "cone point"), vector(point2, "cone point")
        ra, rb = radius_at_end(radius, "cone radius"), radius_at_end(radius2, "cone radius")
        direction(b - a, "cone axis")
        refuse_equal_radii(ra, rb)
        if ra > rb:
            a, ra, b, rb = b, rb, a, ra
        cone = cone_through(np.zeros(3), ra, careful_difference(b, a), rb)
        result = cls(a + cone.apex, cone.axis, degrees(cone.angle), name)
        object.__setattr__(result, "ends", (a, ra, b, rb))
        return result

    def about(self, origin: Array) -> InfiniteCone:
        if self.ends is None:
            return super().about(origin)
        a, ra, b, rb = self.ends
        near, other = seen_about(a, origin), seen_about(b, origin)
        return InfiniteCone.through(near, ra, other, rb, self.name)

    def half_spaces(self) -> HalfSpaces:
        yield "side", carriers.Cone(self.apex, self.axis, radians(self.half_angle))
