"""Point membership straight from the tree, without the half-space form that it checks."""

from __future__ import annotations

import numpy as np

from decomp.csg.primitives import Primitive
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


def preimages(by: Similarity, points: Array) -> Array:
    return (points - by.offset) @ by.rotation / by.scale


def contains(solid: Solid, points: Array) -> Bools:
    """Whether points (n, 3) are in the solid; recursive, so for shallow trees only."""
    match solid:
        case Primitive():
            inside = np.ones(len(points), dtype=np.bool_)
            for _, carrier in solid.half_spaces():
                inside &= carrier.signed_distance(points) < 0
            return inside
        case Union():
            return np.any(
                [contains(p, points) for p in solid.parts] or [np.zeros(len(points), bool)], axis=0
            )
        case Intersection():
            return np.all(
                [contains(p, points) for p in solid.parts] or [np.ones(len(points), bool)], axis=0
            )
        case Difference():
            return contains(solid.base, points) & ~contains(solid.tool, points)
        case Complement():
            return ~contains(solid.part, points)
        case Transformed():
            return contains(solid.part, preimages(solid.by, points))
        case Copies():
            return np.any([contains(solid.part, preimages(b, points)) for b in solid.by], axis=0)
        case Labelled():
            return contains(solid.part, points)
    raise AssertionError(solid)
