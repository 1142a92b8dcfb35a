"""Elliptic cylinders, between flat ends and infinite."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from decomp import carriers
from decomp.carriers import Carrier
from decomp.csg.primitive import HalfSpaces, Primitive, around, set_fields
from decomp.errors import InputError
from decomp.places import triple
from decomp.vectors import Array, cross, direction, frozen, norm, positive, vector

ACROSS = 1e-5
"""Cosine of an angle that is right to five digits, as files write them."""
ROUND = 1e-12
"""Semi-axes that differ by no more than this part of them are a radius."""


@dataclass(frozen=True, eq=False, repr=False, init=False)
class EllipticCylinder(Primitive):
    """The elliptic cylinder with flat ends at `base` and `top`, the ends of its axis.

    Faces: `side`, `base`, `top`.

    Args:
        base: centre of one end, (3,).
        top: centre of the other, in any direction from it.
        first: one semi-axis of the ellipse, (3,), with its length, across the axis.
        second: length of the other one, above zero; it may be the longer.

    Raises:
        InputError: not three finite numbers, both ends are one point, a length is not above zero,
            or `first` is not across the axis.
    """

    kind = "ellipticcylinder"
    places = ("base", "top")
    base: Array
    top: Array
    first: Array
    second: float

    def __init__(
        self,
        base: ArrayLike,
        top: ArrayLike,
        first: ArrayLike,
        second: float,
        name: str | None = None,
    ) -> None:
        set_fields(
            self,
            name,
            base=vector(base, "elliptic cylinder base"),
            top=vector(top, "elliptic cylinder top"),
            first=vector(first, "elliptic cylinder first semi-axis"),
            second=positive(second, "elliptic cylinder second semi-axis"),
        )
        axis = direction(self.top - self.base, "elliptic cylinder axis (top - base)")
        _refuse_slanted(self.first, axis, "the axis")

    def half_spaces(self) -> HalfSpaces:
        axis = direction(self.top - self.base, "elliptic cylinder axis")
        yield "side", elliptic_carrier(self.base, axis, self.first, self.second)
        yield "base", carriers.Plane(self.base, frozen(-axis))
        yield "top", carriers.Plane(self.top, axis)

    def bounds(self) -> Array:
        axis = direction(self.top - self.base, "elliptic cylinder axis")
        other = self.second * cross(axis, direction(self.first, "elliptic cylinder semi-axis"))
        reach = np.hypot(self.first, other)
        return around([self.base, self.top], [reach, reach])


@dataclass(frozen=True, eq=False, repr=False, init=False)
class InfiniteEllipticCylinder(Primitive):
    """All points inside the elliptic cylinder about a line, which is across both its semi-axes.

    Face: `side`.

    Args:
        point: of the line, (3,).
        first: one semi-axis, (3,), with its length.
        second: the other one, (3,), at right angles to it.

    Raises:
        InputError: not three finite numbers, a zero semi-axis, or semi-axes that are not at right
            angles.
    """

    kind = "ellipticcylinder"
    places = ("point",)
    point: Array
    first: Array
    second: Array

    def __init__(
        self, point: ArrayLike, first: ArrayLike, second: ArrayLike, name: str | None = None
    ) -> None:
        set_fields(
            self,
            name,
            point=vector(point, "elliptic cylinder point"),
            first=vector(first, "elliptic cylinder first semi-axis"),
            second=vector(second, "elliptic cylinder second semi-axis"),
        )
        other = direction(self.second, "elliptic cylinder second semi-axis")
        _refuse_slanted(self.first, other, f"the other, {triple(self.second)}")

    def half_spaces(self) -> HalfSpaces:
        axis = cross(self.first / norm(self.first), self.second / norm(self.second))
        axis = frozen(axis / norm(axis))
        yield "side", elliptic_carrier(self.point, axis, self.first, float(norm(self.second)))


def elliptic_carrier(point: Array, axis: Array, first: Array, second: float) -> Carrier:
    """The carrier with one semi-axis given and the length of the other; a cylinder if it is round.

    What `first` (3,) has along the unit vector `axis` is left out, but counts for its length.
    """
    length = float(norm(first))
    x = first - (first @ axis) * axis
    x = x / norm(x)
    if abs(length - second) <= ROUND * max(length, second):
        return carriers.Cylinder(point, axis, length)
    if length > second:
        return carriers.EllipticCylinder(point, axis, frozen(x), length, second)
    return carriers.EllipticCylinder(point, axis, frozen(cross(axis, x)), second, length)


def _refuse_slanted(first: Array, other: Array, what: str) -> None:
    """Raise InputError if a semi-axis is not at right angles to a unit vector, or zero."""
    cosine = float(direction(first, "elliptic cylinder first semi-axis") @ other)
    if abs(cosine) > ACROSS:
        angle = np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0)))
        raise InputError(
            f"elliptic cylinder first semi-axis {triple(first)} must be at right angles to {what}, "
            f"but the angle is {angle:.6g} degrees"
        )
