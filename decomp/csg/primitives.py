"""The primitives, each an intersection of half-spaces (carriers with a side).

Here are the bounded ones; those that reach infinity come from `unbounded`.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from decomp import carriers
from decomp.csg.elliptic import EllipticCylinder as EllipticCylinder
from decomp.csg.elliptic import InfiniteEllipticCylinder as InfiniteEllipticCylinder
from decomp.csg.primitive import (
    HalfSpaces,
    around,
    cone_through,
    radius_at_end,
    refuse_equal_radii,
    set_fields,
)
from decomp.csg.primitive import Primitive as Primitive
from decomp.csg.unbounded import HalfSpace as HalfSpace
from decomp.csg.unbounded import InfiniteCone as InfiniteCone
from decomp.csg.unbounded import InfiniteCylinder as InfiniteCylinder
from decomp.errors import InputError
from decomp.exact import careful_difference
from decomp.magnitude import check_length
from decomp.places import triple
from decomp.vectors import Array, direction, frozen, positive, vector


@dataclass(frozen=True, eq=False, repr=False, init=False)
class Block(Primitive):
    """The axis-parallel block from `corner` to `corner + size`.

    `Block.between` takes its two corners instead. Faces: `xmin`, `xmax`, `ymin`, `ymax`, `zmin`,
    `zmax`.

    Args:
        corner: that of the least coordinates, (3,).
        size: the block's lengths along x, y and z, (3,), each above zero.
        name: put before the names of its faces, as in `name.xmin`; by default its kind and a
            number, as in `block1.xmin`. It is the same for all primitives.

    Raises:
        InputError: `corner` or `size` is not three finite numbers, or a length is not above zero.
    """

    kind = "block"
    places = ("corner",)
    corner: Array
    size: Array

    def __init__(self, corner: ArrayLike, size: ArrayLike, name: str | None = None) -> None:
        low, extent = vector(corner, "block corner"), vector(size, "block size")
        if (extent <= 0).any():
            raise InputError(f"block size must be positive along each axis, got {triple(extent)}")
        check_length(float(extent.min()), "block size")
        set_fields(self, name, corner=low, size=extent)

    @classmethod
    def between(cls, low: ArrayLike, high: ArrayLike, name: str | None = None) -> Block:
        """The axis-parallel block from `low` to `high`, two opposite corners.

        Args:
            low: the corner of the least coordinates, (3,).
            high: the opposite corner, (3,), greater along each axis.

        Raises:
            InputError: a corner is not three finite numbers, or `high` is not above `low` along
                an axis; says which.
        """
        first, last = vector(low, "block's low corner"), vector(high, "block's high corner")
        wrong = [axis for axis, a, b in zip("xyz", first, last, strict=True) if b <= a]
        if wrong:
            raise InputError(
                f"block between {triple(first)} and {triple(last)}: the second corner must be "
                f"above the first along each axis, but is not along {', '.join(wrong)}"
            )
        return cls(first, careful_difference(last, first), name)

    def half_spaces(self) -> HalfSpaces:
        for k, axis in enumerate("xyz"):
            unit = np.eye(3)[k]
            yield f"{axis}min", carriers.Plane(self.corner, frozen(-unit))
            yield f"{axis}max", carriers.Plane(frozen(self.corner + self.size), frozen(unit))

    def bounds(self) -> Array:
        return np.array([self.corner, self.corner + self.size])


@dataclass(frozen=True, eq=False, repr=False, init=False)
class Sphere(Primitive):
    """The ball about `centre`.

    Face: `surface`.

    Args:
        centre: (3,).
        radius: above zero.

    Raises:
        InputError: `centre` is not three finite numbers, or the radius is not above zero.
    """

    kind = "sphere"
    places = ("centre",)
    centre: Array
    radius: float

    def __init__(self, centre: ArrayLike, radius: float, name: str | None = None) -> None:
        set_fields(
            self,
            name,
            centre=vector(centre, "sphere centre"),
            radius=positive(radius, "sphere radius"),
        )

    def half_spaces(self) -> HalfSpaces:
        yield "surface", carriers.Sphere(self.centre, self.radius)

    def bounds(self) -> Array:
        return np.array([self.centre - self.radius, self.centre + self.radius])


@dataclass(frozen=True, eq=False, repr=False, init=False)
class Cylinder(Primitive):
    """The circular cylinder with flat ends at `base` and `top`, the ends of its axis.

    Faces: `side`, `base`, `top`.

    Args:
        base: centre of one end, (3,).
        top: centre of the other, in any direction from it.
        radius: above zero.

    Raises:
        InputError: an end is not three finite numbers, both are one point, or the radius is not
            above zero.
    """

    kind = "cylinder"
    places = ("base", "top")
    base: Array
    top: Array
    radius: float

    def __init__(
        self, base: ArrayLike, top: ArrayLike, radius: float, name: str | None = None
    ) -> None:
        set_fields(
            self,
            name,
            base=vector(base, "cylinder base"),
            top=vector(top, "cylinder top"),
            radius=positive(radius, "cylinder radius"),
        )
        direction(self.top - self.base, "cylinder axis (top - base)")

    def half_spaces(self) -> HalfSpaces:
        axis = direction(self.top - self.base, "cylinder axis")
        yield "side", carriers.Cylinder(self.base, axis, self.radius)
        yield "base", carriers.Plane(self.base, frozen(-axis))
        yield "top", carriers.Plane(self.top, axis)

    def bounds(self) -> Array:
        axis = direction(self.top - self.base, "cylinder axis")
        reach = self.radius * np.sqrt(np.maximum(0.0, 1 - axis**2))
        return around([self.base, self.top], [reach, reach])


@dataclass(frozen=True, eq=False, repr=False, init=False)
class Cone(Primitive):
    """The circular cone or frustum between `base` and `top`, the ends of its axis.

    One of the two radii may be zero: a pointed cone, which has no face at that end. Faces: `side`,
    `base`, `top`.

    Args:
        base: centre of one end, (3,).
        top: centre of the other, in any direction from it.
        base_radius: at `base`, not negative.
        top_radius: at `top`, not negative, and another than at `base`.

    Raises:
        InputError: an end is not three finite numbers, both are one point, the radii are equal
            (that is a cylinder) or one is negative.
    """

    kind = "cone"
    places = ("base", "top")
    base: Array
    base_radius: float
    top: Array
    top_radius: float

    def __init__(
        self,
        base: ArrayLike,
        base_radius: float,
        top: ArrayLike,
        top_radius: float = 0.0,
        name: str | None = None,
    ) -> None:
        set_fields(
            self,
            name,
            base=vector(base, "cone base"),
            base_radius=radius_at_end(base_radius, "cone base radius"),
            top=vector(top, "cone top"),
            top_radius=radius_at_end(top_radius, "cone top radius"),
        )
        direction(self.top - self.base, "cone axis (top - base)")
        refuse_equal_radii(self.base_radius, self.top_radius)

    def half_spaces(self) -> HalfSpaces:
        axis = direction(self.top - self.base, "cone axis")
        yield "side", cone_through(self.base, self.base_radius, self.top, self.top_radius)
        if self.base_radius > 0:
            yield "base", carriers.Plane(self.base, frozen(-axis))
        if self.top_radius > 0:
            yield "top", carriers.Plane(self.top, axis)

    def bounds(self) -> Array:
        axis = direction(self.top - self.base, "cone axis")
        side = np.sqrt(np.maximum(0.0, 1 - axis**2))
        return around([self.base, self.top], [self.base_radius * side, self.top_radius * side])


@dataclass(frozen=True, eq=False, repr=False, init=False)
class Torus(Primitive):
    """The ring torus: a disc of radius `minor` turned about an axis at distance `major`.

    Face: `surface`.

    Args:
        centre: (3,), where the axis meets the plane of the ring.
        axis: direction of the axis (3,), of any length.
        major: distance of the disc's centre from the axis.
        minor: radius of the disc, above zero and below `major`.

    Raises:
        InputError: not three finite numbers, a zero axis, a radius that is not above zero; a horn
            torus (minor = major) or a spindle torus (minor > major), whose surface touches or
            crosses itself.
    """

    kind = "torus"
    places = ("centre",)
    centre: Array
    axis: Array
    major: float
    minor: float

    def __init__(
        self,
        centre: ArrayLike,
        axis: ArrayLike,
        major: float,
        minor: float,
        name: str | None = None,
    ) -> None:
        set_fields(
            self,
            name,
            centre=vector(centre, "torus centre"),
            axis=direction(axis, "torus axis"),
            major=positive(major, "torus major radius"),
            minor=positive(minor, "torus minor radius"),
        )
        if self.minor >= self.major:
            form = "horn" if self.minor == self.major else "spindle"
            raise InputError(
                f"a {form} torus (minor radius {self.minor:g}, major radius {self.major:g}) is not "
                "supported: its surface meets itself; make the minor radius the smaller one"
            )

    def half_spaces(self) -> HalfSpaces:
        yield "surface", carriers.Torus(self.centre, self.axis, self.major, self.minor)

    def bounds(self) -> Array:
        reach = self.major * np.sqrt(np.maximum(0.0, 1 - self.axis**2)) + self.minor
        return np.array([self.centre - reach, self.centre + reach])
