"""Random solids: trees over all primitives, placed anywhere, of two kinds.

`generic` numbers avoid special positions; `round_numbers` seek them: coincident faces, tangent
contacts, equal radii, shared axes.
"""

from __future__ import annotations

from math import sqrt

import numpy as np
from hypothesis import strategies as st
from hypothesis.strategies import SearchStrategy

from decomp.csg.primitives import (
    Block,
    Cone,
    Cylinder,
    HalfSpace,
    InfiniteCone,
    InfiniteCylinder,
    InfiniteEllipticCylinder,
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
from decomp.vectors import cross, norm, perpendicular

Point = tuple[float, float, float]
Numbers = SearchStrategy[float]
AXES = [(1, 0, 0), (0, 1, 0), (0, 0, 1), (-1, 0, 0), (0, 0, -1)]
HALF_SIZE = 3.0


def generic(low: float, high: float) -> Numbers:
    """Numbers between two bounds, none of them round."""
    return st.integers(0, 5003).map(lambda k: low + (high - low) * (k + 1 / sqrt(5)) / 5004)


def round_numbers(low: float, high: float) -> Numbers:
    """Multiples of one half between two bounds."""
    return st.integers(int(2 * low), int(2 * high)).map(lambda k: k / 2)


def points(numbers: Numbers) -> SearchStrategy[Point]:
    return st.tuples(numbers, numbers, numbers)


def directions(special: bool) -> SearchStrategy[Point]:
    """Vectors of some length: along an axis, or anywhere."""
    if special:
        return st.sampled_from(AXES)
    return points(generic(-1, 1)).filter(lambda v: max(map(abs, v)) > 0.2)


PRIMITIVES = (
    "block",
    "sphere",
    "cylinder",
    "cone",
    "torus",
    "plane",
    "bore",
    "funnel",
    "oval",
)


@st.composite
def primitives(draw: st.DrawFn, special: bool = False) -> Solid:
    """One primitive of any kind, about the origin."""
    number = round_numbers if special else generic
    where, size = points(number(-1, 1)), number(0.5, 1.5)
    kind = draw(st.sampled_from(PRIMITIVES))
    at = draw(where)
    if kind == "block":
        return Block(at, draw(st.tuples(size, size, size)))
    if kind == "sphere":
        return Sphere(at, draw(size))
    way = draw(directions(special))
    if kind == "cylinder":
        length = draw(size) * 2 / sqrt(sum(c * c for c in way))
        top = tuple(a + length * w for a, w in zip(at, way, strict=True))
        return Cylinder(at, top, draw(size) / 2)
    if kind == "cone":
        length = draw(size) * 2 / sqrt(sum(c * c for c in way))
        top = tuple(a + length * w for a, w in zip(at, way, strict=True))
        wide = draw(size)
        return Cone(at, wide, top, draw(st.sampled_from([0.0, wide / 3, 1.5 * wide])))
    if kind == "torus":
        minor = draw(size) / 2
        return Torus(at, way, minor + draw(size), minor)
    if kind == "plane":
        return HalfSpace(at, way)
    if kind == "oval":
        axis = np.array(way) / norm(np.array(way))
        one, two = draw(size) * perpendicular(axis), draw(size) / 2
        return InfiniteEllipticCylinder(at, one, two * cross(axis, perpendicular(axis)))
    if kind == "bore":
        return InfiniteCylinder(at, way, draw(size) / 2)
    return InfiniteCone(at, way, draw(st.sampled_from([20.0, 30.0, 45.0])))


@st.composite
def moved(draw: st.DrawFn, part: SearchStrategy[Solid], special: bool) -> Solid:
    """A solid turned, mirrored, scaled, moved or copied."""
    solid, number = draw(part), round_numbers if special else generic
    how = draw(st.sampled_from(["turn", "mirror", "scale", "move", "copy"]))
    if how == "turn":
        angle = draw(st.sampled_from([90.0, 180.0, 45.0]) if special else generic(10, 350))
        return solid.rotate(draw(directions(special)), angle, draw(points(number(-1, 1))))
    if how == "mirror":
        return solid.mirror(draw(directions(special)), draw(points(number(-1, 1))))
    if how == "scale":
        return solid.scale(draw(st.sampled_from([0.5, 1.5]) if special else generic(0.6, 1.4)))
    step = draw(points(number(-1, 1)))
    return solid.translate(step) if how == "move" else solid.linear_copies(step, 2)


def trees(special: bool = False, leaves: int = 4) -> SearchStrategy[Solid]:
    """Trees with at most `leaves` primitives."""

    def grown(part: SearchStrategy[Solid]) -> SearchStrategy[Solid]:
        return st.one_of(
            st.builds(lambda a, b: a | b, part, part),
            st.builds(lambda a, b: a & b, part, part),
            st.builds(lambda a, b: a - b, part, part),
            st.builds(lambda a: ~a, part),
            moved(part, special),
        )

    return st.recursive(primitives(special), grown, max_leaves=leaves)


def bounded(solid: Solid) -> Solid:
    """The solid itself, cut off by a block if it may be infinite."""
    if _is_bounded(solid):
        return solid
    h = HALF_SIZE + 0.21875
    return solid & Block((-h, -h + 0.125, -h - 0.0625), (2 * h, 2 * h, 2 * h), name="frame")


def solids(special: bool = False, leaves: int = 4) -> SearchStrategy[Solid]:
    """Bounded solids."""
    return trees(special, leaves).map(bounded)


def _is_bounded(solid: Solid) -> bool:
    match solid:
        case HalfSpace() | InfiniteCylinder() | InfiniteEllipticCylinder() | InfiniteCone():
            return False
        case Complement():
            return False
        case Union(parts=parts):
            return all(_is_bounded(p) for p in parts)
        case Intersection(parts=parts):
            return any(_is_bounded(p) for p in parts)
        case Difference(base=base):
            return _is_bounded(base)
        case Transformed(part=part) | Copies(part=part) | Labelled(part=part):
            return _is_bounded(part)
    return True


def text(solid: Solid) -> str:
    """An expression that makes the solid again, for reports of failures."""
    match solid:
        case Union(parts=parts):
            return "(" + " | ".join(map(text, parts)) + ")"
        case Intersection(parts=parts):
            return "(" + " & ".join(map(text, parts)) + ")"
        case Difference(base=base, tool=tool):
            return f"({text(base)} - {text(tool)})"
        case Complement(part=part):
            return f"~{text(part)}"
        case Transformed(part=part, by=by):
            matrix = np.column_stack([by.scale * by.rotation, by.offset]).tolist()
            return f"{text(part)}.transform({matrix})"
        case Copies(part=part, by=by):
            return f"{text(part)}.linear_copies({by[1].offset.tolist()}, {len(by)})"
        case Labelled(part=part):
            return text(part)
    values = [f"{k}={v.tolist() if hasattr(v, 'tolist') else v!r}" for k, v in vars(solid).items()]
    return f"{type(solid).__name__}({', '.join(values)})"
