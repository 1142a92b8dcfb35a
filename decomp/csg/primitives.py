"""The primitives, each an intersection of half-spaces (carriers with a side)."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Iterator
from dataclasses import dataclass
from math import atan2, degrees, radians
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from decomp import carriers
from decomp.carriers import Carrier
from decomp.csg.solid import Solid, checked_name
from decomp.errors import InputError
from decomp.magnitude import check_length
from decomp.vectors import Array, direction, frozen, norm, number, place, positive, vector

HalfSpaces = Iterator[tuple[str, Carrier]]


@dataclass(frozen=True, eq=False, repr=False)
class Primitive(Solid):
    """A named intersection of half-spaces."""

    kind: ClassVar[str]
    name: str | None

    @abstractmethod
    def half_spaces(self) -> HalfSpaces:
        """Yield (face name, carrier) pairs; the primitive is what is inside all of them.

        The face name is empty where the primitive has only one face and needs no other word.
        """

    def bounds(self) -> Array | None:
        """Return the corners (2, 3) of a box around the primitive, None if it is unbounded."""
        return None

    def __repr__(self) -> str:
        values = [f"{k}={_show(v)}" for k, v in vars(self).items() if v is not None]
        return f"{type(self).__name__}({', '.join(values)})"


@dataclass(frozen=True, eq=False, repr=False, init=False)
class Block(Primitive):
    """The axis-parallel block between two opposite corners.

    Faces: `xmin`, `xmax`, `ymin`, `ymax`, `zmin`, `zmax`.

    Raises:
        InputError: a corner is not three finite numbers, or the block has no volume.
    """

    kind = "block"
    corner: Array
    size: Array

    def __init__(self, corner: ArrayLike, size: ArrayLike, name: str | None = None) -> None:
        low, extent = vector(corner, "block corner"), vector(size, "block size")
        if (extent <= 0).any():
            raise InputError(f"block size must be positive along each axis, got {place(extent)}")
        check_length(float(extent.min()), "block size")
        _set(self, name, corner=low, size=extent)

    @classmethod
    def between(cls, corner: ArrayLike, opposite: ArrayLike, name: str | None = None) -> Block:
        """The block with two opposite corners given, in any order."""
        a, b = vector(corner, "block corner"), vector(opposite, "block corner")
        return cls(np.minimum(a, b), np.abs(b - a), name)

    def half_spaces(self) -> HalfSpaces:
        for k, axis in enumerate("xyz"):
            unit = np.eye(3)[k]
            yield f"{axis}min", carriers.Plane(self.corner, frozen(-unit))
            yield f"{axis}max", carriers.Plane(frozen(self.corner + self.size), frozen(unit))

    def bounds(self) -> Array:
        return np.array([self.corner, self.corner + self.size])


@dataclass(frozen=True, eq=False, repr=False, init=False)
class Sphere(Primitive):
    """The ball about `centre`. Face: `surface`."""

    kind = "sphere"
    centre: Array
    radius: float

    def __init__(self, centre: ArrayLike, radius: float, name: str | None = None) -> None:
        _set(
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
    """

    kind = "cylinder"
    base: Array
    top: Array
    radius: float

    def __init__(
        self, base: ArrayLike, top: ArrayLike, radius: float, name: str | None = None
    ) -> None:
        _set(
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
        return _around([self.base, self.top], [reach, reach])


@dataclass(frozen=True, eq=False, repr=False, init=False)
class Cone(Primitive):
    """The circular cone or frustum between `base` and `top`, the ends of its axis.

    One of the two radii may be zero (a pointed cone). Faces: `side`, `base`, `top`.

    Raises:
        InputError: equal radii (that is a cylinder), a negative radius, both zero, a zero axis.
    """

    kind = "cone"
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
        _set(
            self,
            name,
            base=vector(base, "cone base"),
            base_radius=_radius(base_radius, "cone base radius"),
            top=vector(top, "cone top"),
            top_radius=_radius(top_radius, "cone top radius"),
        )
        direction(self.top - self.base, "cone axis (top - base)")
        _refuse_equal_radii(self.base_radius, self.top_radius)

    def half_spaces(self) -> HalfSpaces:
        axis = direction(self.top - self.base, "cone axis")
        yield "side", _cone_through(self.base, self.base_radius, self.top, self.top_radius)
        if self.base_radius > 0:
            yield "base", carriers.Plane(self.base, frozen(-axis))
        if self.top_radius > 0:
            yield "top", carriers.Plane(self.top, axis)

    def bounds(self) -> Array:
        axis = direction(self.top - self.base, "cone axis")
        side = np.sqrt(np.maximum(0.0, 1 - axis**2))
        return _around([self.base, self.top], [self.base_radius * side, self.top_radius * side])


@dataclass(frozen=True, eq=False, repr=False, init=False)
class Torus(Primitive):
    """The ring torus: a circle of radius `minor` turned about `axis` at distance `major`.

    Face: `surface`.

    Raises:
        InputError: a horn torus (minor = major) or a spindle torus (minor > major), whose
            surface touches or crosses itself.
    """

    kind = "torus"
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
        _set(
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


@dataclass(frozen=True, eq=False, repr=False, init=False)
class HalfSpace(Primitive):
    """All points behind the plane through `point` with the given outward normal.

    Its one face bears the primitive's own name.
    """

    kind = "plane"
    point: Array
    normal: Array

    def __init__(self, point: ArrayLike, normal: ArrayLike, name: str | None = None) -> None:
        _set(
            self,
            name,
            point=vector(point, "plane point"),
            normal=direction(normal, "plane normal"),
        )

    def half_spaces(self) -> HalfSpaces:
        yield "", carriers.Plane(self.point, self.normal)


@dataclass(frozen=True, eq=False, repr=False, init=False)
class InfiniteCylinder(Primitive):
    """All points within `radius` of the line through `point` along `axis`. Face: `side`."""

    kind = "cylinder"
    point: Array
    axis: Array
    radius: float

    def __init__(
        self, point: ArrayLike, axis: ArrayLike, radius: float, name: str | None = None
    ) -> None:
        _set(
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
    """One nappe of a cone, from `apex` along `axis`, half-angle in degrees. Face: `side`."""

    kind = "cone"
    apex: Array
    axis: Array
    half_angle: float

    def __init__(
        self, apex: ArrayLike, axis: ArrayLike, half_angle: float, name: str | None = None
    ) -> None:
        _set(
            self,
            name,
            apex=vector(apex, "cone apex"),
            axis=direction(axis, "cone axis"),
            half_angle=number(half_angle, "cone half-angle"),
        )
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

        Raises:
            InputError: equal radii, a negative radius, equal points.
        """
        a, b = vector(point, "cone point"), vector(point2, "cone point")
        ra, rb = _radius(radius, "cone radius"), _radius(radius2, "cone radius")
        direction(b - a, "cone axis")
        _refuse_equal_radii(ra, rb)
        cone = _cone_through(a, ra, b, rb)
        return cls(cone.apex, cone.axis, degrees(cone.angle), name)

    def half_spaces(self) -> HalfSpaces:
        yield "side", carriers.Cone(self.apex, self.axis, radians(self.half_angle))


def _set(primitive: Primitive, name: str | None, **fields: Array | float) -> None:
    object.__setattr__(primitive, "name", None if name is None else checked_name(name))
    for key, value in fields.items():
        object.__setattr__(primitive, key, value)


def _cone_through(a: Array, ra: float, b: Array, rb: float) -> carriers.Cone:
    """The nappe through circles of radius ra about a and rb about b, across the line a b."""
    if ra > rb:
        a, ra, b, rb = b, rb, a, ra
    axis = direction(b - a, "cone axis")
    length = float(norm(b - a))
    slope = (rb - ra) / length
    return carriers.Cone(frozen(a - ra / slope * axis), axis, atan2(rb - ra, length))


def _radius(value: float, what: str) -> float:
    result = number(value, what)
    if result < 0:
        raise InputError(f"{what} must not be negative, got {result:g}")
    if result > 0:
        check_length(result, what)
    return result


def _refuse_equal_radii(a: float, b: float) -> None:
    if a == b:
        hint = "both are zero" if a == 0 else f"both are {a:g}; that is a cylinder"
        raise InputError(f"a cone needs two different radii, but {hint}")


def _around(points: list[Array], reaches: list[Array]) -> Array:
    low = np.min([p - r for p, r in zip(points, reaches, strict=True)], axis=0)
    high = np.max([p + r for p, r in zip(points, reaches, strict=True)], axis=0)
    return np.array([low, high])


def _show(value: object) -> str:
    if isinstance(value, np.ndarray):
        return place(value)
    return f"{value:g}" if isinstance(value, float) else repr(value)
