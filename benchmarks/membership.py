"""Which points a solid holds, asked primitive by primitive: it shares nothing with boundaries.

Volumes are compared with it. A point on a face goes to either side.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import reduce
from math import radians, tan

import numpy as np
from scipy.stats import qmc  # type: ignore[import-untyped]

from decomp.csg.primitives import (
    Block,
    Cone,
    Cylinder,
    EllipticCylinder,
    HalfSpace,
    InfiniteCone,
    InfiniteCylinder,
    InfiniteEllipticCylinder,
    Primitive,
    Sphere,
    Torus,
)
from decomp.csg.solid import (
    Complement,
    Copies,
    Difference,
    Intersection,
    Labelled,
    Solid,
    Transformed,
    Union,
)
from decomp.similarity import Similarity
from decomp.vectors import Array, Bools

POINTS = 1 << 16


def volume(solid: Solid, bounds: Array) -> tuple[float, float]:
    """A solid's volume in a box between two corners (2, 3), and its standard error."""
    low, high = bounds
    found = held(solid, low + (high - low) * qmc.Sobol(3, seed=0).random(POINTS))
    share, box = float(found.mean()), float(np.prod(high - low))
    return share * box, box * float(np.sqrt(max(share * (1 - share), 1 / POINTS) / POINTS))


def held(
    solid: Solid, points: Array, primitive: Callable[[Primitive, Array], Bools] | None = None
) -> Bools:
    """Which of points (n, 3) a solid holds; recursive, so for shallow trees only.

    Args:
        solid: the solid.
        points: the points.
        primitive: what answers for primitives, by default their own numbers.
    """

    def any_of(answers: Iterator[Bools]) -> Bools:
        return reduce(np.logical_or, answers, np.zeros(len(points), dtype=np.bool_))

    match solid:
        case Union(parts=parts):
            return any_of(held(part, points, primitive) for part in parts)
        case Intersection(parts=parts):
            inside = (held(part, points, primitive) for part in parts)
            return reduce(np.logical_and, inside, np.ones(len(points), dtype=np.bool_))
        case Difference(base=base, tool=tool):
            return held(base, points, primitive) & ~held(tool, points, primitive)
        case Complement(part=part):
            return ~held(part, points, primitive)
        case Transformed(part=part, by=by):
            return held(part, preimages(by, points), primitive)
        case Copies(part=part, by=several):
            return any_of(held(part, preimages(by, points), primitive) for by in several)
        case Labelled(part=part):
            return held(part, points, primitive)
        case Primitive():
            return (primitive or by_numbers)(solid, points)
    raise AssertionError(solid)


def preimages(by: Similarity, points: Array) -> Array:
    """The points (n, 3) that a similarity takes to given ones."""
    return (points - by.offset) @ by.rotation / by.scale


def by_numbers(solid: Primitive, points: Array) -> Bools:
    """Which of points (n, 3) a primitive holds, by its own numbers."""
    match solid:
        case Block(corner=corner, size=size):
            return np.asarray(((points > corner) & (points < corner + size)).all(axis=1))
        case Sphere(centre=centre, radius=radius):
            return np.asarray(((points - centre) ** 2).sum(axis=1) < radius**2)
        case Cylinder(base=base, top=top, radius=radius):
            along, away = _about(points, base, top - base)
            return (along > 0) & (along < 1) & (away < radius)
        case Cone(base=base, base_radius=first, top=top, top_radius=last):
            along, away = _about(points, base, top - base)
            return (along > 0) & (along < 1) & (away < first + along * (last - first))
        case Torus(centre=centre, axis=axis, major=major, minor=minor):
            along, away = _about(points, centre, axis)
            return np.asarray(np.hypot(along, away - major) < minor)
        case HalfSpace(point=point, normal=normal):
            return np.asarray((points - point) @ normal < 0)
        case EllipticCylinder(base=base, top=top, first=first, second=second):
            along, _ = _about(points, base, top - base)
            other = np.cross(top - base, first)
            other *= second / np.linalg.norm(other)
            return (along > 0) & (along < 1) & _in_ellipse(points - base, first, other)
        case InfiniteEllipticCylinder(point=point, first=first, second=other):
            return _in_ellipse(points - point, first, other)
        case InfiniteCylinder(point=point, axis=axis, radius=radius):
            return np.asarray(_about(points, point, axis)[1] < radius)
        case InfiniteCone(apex=apex, axis=axis, half_angle=angle):
            along, away = _about(points, apex, axis)
            return np.asarray(away < along * tan(radians(angle)))
    raise TypeError(f"no membership for a {type(solid).__name__}")


def _about(points: Array, start: Array, axis: Array) -> tuple[Array, Array]:
    """Ways (n,) along an axis, in parts of its length, and distances from it."""
    along = (points - start) @ axis / (axis @ axis)
    return along, np.linalg.norm(points - start - along[:, None] * axis, axis=1)


def _in_ellipse(away: Array, first: Array, other: Array) -> Bools:
    """Whether points, seen from the axis, are inside the cylinder with two semi-axes."""
    along, across = away @ first / (first @ first), away @ other / (other @ other)
    return np.asarray(along**2 + across**2 < 1)
