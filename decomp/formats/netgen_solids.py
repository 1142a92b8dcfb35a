"""Primitives, moves and copies of Netgen's `.geo` files, made of the numbers in parentheses."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from decomp import similarity
from decomp.csg.primitives import (
    Block,
    HalfSpace,
    InfiniteCone,
    InfiniteCylinder,
    InfiniteEllipticCylinder,
    Primitive,
    Sphere,
    Torus,
)
from decomp.similarity import Similarity
from decomp.vectors import vector

Vector = list[float]

# what a primitive is made from: how it is written, the count of numbers in each of its lists
WRITTEN: dict[str, tuple[str, tuple[int, ...]]] = {
    "plane": ("plane (x, y, z of a point; normal)", (3, 3)),
    "sphere": ("sphere (centre; radius)", (3, 1)),
    "cylinder": ("cylinder (point of the axis; second point; radius)", (3, 3, 1)),
    "ellipticcylinder": ("ellipticcylinder (centre; semi-axis; other semi-axis)", (3, 3, 3)),
    "cone": ("cone (point of the axis; radius; second point; radius)", (3, 1, 3, 1)),
    "orthobrick": ("orthobrick (corner; opposite corner)", (3, 3)),
    "torus": ("torus (centre; axis; major radius; minor radius)", (3, 3, 1, 1)),
    "translate": ("translate (vector; solid)", (3,)),
    "rotate": ("rotate (centre; three Euler angles; solid)", (3, 3)),
    "multitranslate": ("multitranslate (vector; number of copies; solid)", (3, 1)),
    "multirotate": ("multirotate (centre; three Euler angles; number; solid)", (3, 3, 1)),
}


def _cone(a: Vector, ra: Vector, b: Vector, rb: Vector) -> Primitive:
    if ra == rb and ra[0] > 0:
        return _cylinder(a, b, ra)
    return InfiniteCone.through(a, ra[0], b, rb[0])


def _cylinder(a: Vector, b: Vector, radius: Vector) -> Primitive:
    axis = vector(b, "cylinder point") - vector(a, "cylinder point")
    return InfiniteCylinder(a, axis, radius[0])


PRIMITIVES: dict[str, Callable[..., Primitive]] = {
    "plane": HalfSpace,
    "sphere": lambda centre, radius: Sphere(centre, radius[0]),
    "cylinder": _cylinder,
    "ellipticcylinder": InfiniteEllipticCylinder,
    "cone": _cone,
    "orthobrick": lambda a, b: Block.between(np.minimum(a, b), np.maximum(a, b)),
    "torus": lambda centre, axis, major, minor: Torus(centre, axis, major[0], minor[0]),
}


def _rotation(centre: Vector, angles: Vector) -> Similarity:
    """Netgen's rotation: Euler angles z, x, z in radians, each turning clockwise.

    Source: Netgen, libsrc/gprim/transform3d.hpp, `Transformation` and `SetAxisRotation`.
    """
    radians, pivot = vector(angles, "rotation angles"), vector(centre, "rotation centre")
    turns = [
        similarity.rotation(axis, -float(np.degrees(angle)), centre)
        for axis, angle in zip(((0, 0, 1), (1, 0, 0), (0, 0, 1)), radians, strict=True)
    ]
    return replace(turns[2].after(turns[1]).after(turns[0]), fixed=pivot)


def _translations(step: Vector, count: int) -> tuple[Similarity, ...]:
    """The solid itself and `count` copies (Netgen, libsrc/csg/csgparser.cpp)."""
    move = vector(step, "translation")
    return tuple(similarity.translation(k * move) for k in range(count + 1))


def _rotations(centre: Vector, angles: Vector, count: int) -> tuple[Similarity, ...]:
    """The solid itself and `count` - 1 copies, as Netgen's first copy lies on the solid itself."""
    step = _rotation(centre, angles)
    result = [similarity.translation((0, 0, 0))]
    for _ in range(count - 1):
        result.append(replace(step.after(result[-1]), fixed=step.fixed))
    return tuple(result)


STEPS: dict[str, Callable[..., Similarity]] = {
    "translate": similarity.translation,
    "rotate": _rotation,
}
COPIES: dict[str, Callable[..., tuple[Similarity, ...]]] = {
    "multitranslate": _translations,
    "multirotate": _rotations,
}
