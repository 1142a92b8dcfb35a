"""What Voronoi surfaces lie between: carriers, points, lines, circles, with exact parameters.

Points, lines and circles are spheres, cylinders and tori of radius zero: the same offsets hold.
Notation: s is the signed distance, positive outside; e is +1 or -1; d the offset.
"""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from math import atan2
from typing import Any, ClassVar

import numpy as np

from decomp.carriers import Carrier, Cone, Cylinder, Plane, Sphere, Torus
from decomp.errors import InputError
from decomp.vectors import Array, dot, norm
from decomp.voronoi.exact import Vector, exact, exact_vector, floats, length, unit
from decomp.voronoi.polynomial import (
    D,
    Raw,
    height,
    rational,
    squared_distance,
    squared_distance_from_line,
)
from decomp.voronoi.site_base import CarrierSite, VoronoiSite

__all__ = [
    "CarrierSite",
    "ConeSite",
    "CylinderSite",
    "PlaneSite",
    "SphereSite",
    "TorusSite",
    "VoronoiSite",
    "of_carrier",
]
NO_ANGLE = 1e-14
"""Squares of sine and cosine add to 1 but for less."""


@dataclass(frozen=True, eq=False)
class PlaneSite(CarrierSite):
    """The plane through `point`, outside where `normal` (any length) points."""

    point: Vector
    normal: Vector
    kind: ClassVar[str] = "plane"

    @property
    def reference(self) -> Vector:
        return self.point

    @property
    def size(self) -> float:
        return 0.0

    @cached_property
    def carrier(self) -> Plane:
        return Plane(floats(self.point), unit(self.normal))

    @cached_property
    def distance(self) -> Raw:
        """s, linear in x, y, z."""
        return height(self.point, self.normal) / rational(length(self.normal))

    def offset(self, e: int) -> Raw:
        return self.distance - e * D


class RoundSite(CarrierSite):
    """All points at a distance, `radius`, from a point or a line, which it is if that is zero."""

    radius: Fraction
    core: ClassVar[str]
    """What it is if the radius is zero."""

    @property
    def name(self) -> str:
        return self.kind if self.radius else self.core

    @property
    def size(self) -> float:
        return float(self.radius)

    @property
    def two_sided(self) -> bool:
        return self.radius > 0

    @property
    @abstractmethod
    def square(self) -> Raw:
        """(s + radius)^2: the squared distance from the point or line."""

    def offset(self, e: int) -> Raw:
        return self.square - (rational(self.radius) + e * D) ** 2


@dataclass(frozen=True, eq=False)
class SphereSite(RoundSite):
    """The sphere about `centre`; a point if the radius is zero."""

    centre: Vector
    radius: Fraction
    kind: ClassVar[str] = "sphere"
    core: ClassVar[str] = "point"

    @property
    def reference(self) -> Vector:
        return self.centre

    @cached_property
    def carrier(self) -> Sphere:
        return Sphere(floats(self.centre), float(self.radius))

    @cached_property
    def square(self) -> Raw:
        return squared_distance(self.centre)


@dataclass(frozen=True, eq=False)
class CylinderSite(RoundSite):
    """The cylinder about the line through `point` along `axis`; a line if the radius is zero."""

    point: Vector
    axis: Vector
    radius: Fraction
    kind: ClassVar[str] = "cylinder"
    core: ClassVar[str] = "line"

    @property
    def reference(self) -> Vector:
        return self.point

    @cached_property
    def carrier(self) -> Cylinder:
        return Cylinder(floats(self.point), unit(self.axis), float(self.radius))

    @cached_property
    def square(self) -> Raw:
        return squared_distance_from_line(self.point, self.axis)


@dataclass(frozen=True, eq=False)
class ConeSite(CarrierSite):
    """The nappe from `apex` along `axis`; `sine` and `cosine` are those of the half-angle."""

    apex: Vector
    axis: Vector
    sine: Fraction
    cosine: Fraction
    kind: ClassVar[str] = "cone"

    def __post_init__(self) -> None:
        super().__post_init__()
        off = abs(float(self.sine**2 + self.cosine**2) - 1)
        if self.sine <= 0 or self.cosine <= 0 or off > NO_ANGLE:
            raise InputError(
                "sine and cosine of a cone must be those of an angle between 0 and 90 degrees, "
                f"got {float(self.sine):g} and {float(self.cosine):g}"
            )

    @property
    def reference(self) -> Vector:
        return self.apex

    @property
    def size(self) -> float:
        return 0.0

    @cached_property
    def carrier(self) -> Cone:
        angle = atan2(float(self.sine), float(self.cosine))
        return Cone(floats(self.apex), unit(self.axis), angle)

    @cached_property
    def along(self) -> Raw:
        """Height above the apex."""
        return height(self.apex, self.axis) / rational(length(self.axis))

    @cached_property
    def square(self) -> Raw:
        """Squared distance from the axis."""
        return squared_distance_from_line(self.apex, self.axis)

    def offset(self, e: int) -> Raw:
        sine, cosine = rational(self.sine), rational(self.cosine)
        return cosine**2 * self.square - (sine * self.along + e * D) ** 2

    def gradient(self, p: Array) -> Array:
        """Beyond the apex it is the direction from the apex."""
        cone = self.carrier
        away = p - cone.apex
        z = dot(away, cone.axis)
        rho = np.sqrt(np.maximum(dot(away, away) - z**2, 0.0))
        beyond = z * float(self.cosine) + rho * float(self.sine) <= 0
        far = norm(away)[..., None]
        radial = away / np.where(far > 0, far, 1.0)
        return np.where(beyond[..., None], radial, cone.normal(p))


@dataclass(frozen=True, eq=False)
class TorusSite(CarrierSite):
    """The torus about a spine of radius `major` across `axis`; a circle if `minor` is zero."""

    centre: Vector
    axis: Vector
    major: Fraction
    minor: Fraction
    kind: ClassVar[str] = "torus"

    def __post_init__(self) -> None:
        super().__post_init__()
        if not self.major > self.minor:
            raise InputError(
                "the major radius of a torus must exceed its minor radius, got "
                f"{float(self.major):g} and {float(self.minor):g}"
            )

    @property
    def name(self) -> str:
        return "torus" if self.minor else "circle"

    @property
    def reference(self) -> Vector:
        return self.centre

    @property
    def size(self) -> float:
        return float(self.major)

    @property
    def two_sided(self) -> bool:
        return self.minor > 0

    @cached_property
    def carrier(self) -> Torus:
        return Torus(floats(self.centre), unit(self.axis), float(self.major), float(self.minor))

    @cached_property
    def square(self) -> Raw:
        """Squared distance from the axis."""
        return squared_distance_from_line(self.centre, self.axis)

    def offset(self, e: int) -> Raw:
        tube = (rational(self.minor) + e * D) ** 2
        major2 = rational(self.major) ** 2
        return (squared_distance(self.centre) + major2 - tube) ** 2 - 4 * major2 * self.square


def of_carrier(carrier: Carrier) -> CarrierSite:
    """The site with a carrier's parameters, which are taken exactly."""
    values: tuple[Any, ...]
    if isinstance(carrier, Plane):
        return PlaneSite(_given(carrier.point), _given(carrier.normal_vector))
    if isinstance(carrier, Sphere):
        return SphereSite(_given(carrier.centre), exact(carrier.radius))
    if isinstance(carrier, Cylinder):
        values = _given(carrier.point), _given(carrier.axis), exact(carrier.radius)
        return CylinderSite(*values)
    if isinstance(carrier, Cone):
        sine, cosine = np.sin(carrier.angle), np.cos(carrier.angle)
        return ConeSite(_given(carrier.apex), _given(carrier.axis), exact(sine), exact(cosine))
    if isinstance(carrier, Torus):
        values = exact(carrier.major), exact(carrier.minor)
        return TorusSite(_given(carrier.centre), _given(carrier.axis), *values)
    raise InputError(
        f"{carrier.kind}: Voronoi surfaces of such a face are not known; sheets beside it are "
        "found by sampling ('--method sampled'), and '--cells none' makes a mesh without them"
    )


def _given(values: Array) -> Vector:
    return exact_vector(values, "a carrier's parameter")
