"""What the nodes of OpenSCAD's `.csg` files mean.

Which child a difference starts from, and what empty children do, follows OpenSCAD,
src/geometry/manifold/manifold-applyops.cc.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass
from math import sqrt
from typing import Any, NamedTuple

import numpy as np

from decomp.csg.model import Ignored
from decomp.csg.primitives import Block, Cone, Cylinder, Sphere, Torus
from decomp.csg.solid import Difference, Intersection, Solid, Transformed, Union
from decomp.errors import FileError, InputError
from decomp.formats.source import Source
from decomp.similarity import Similarity, from_matrix
from decomp.vectors import Array, number

# parameters by position, and further ones by name
PARAMETERS: dict[str, tuple[tuple[str, ...], tuple[str, ...]]] = {
    "cube": (("size", "center"), ()),
    "sphere": (("r",), ("d",)),
    "cylinder": (("h", "r1", "r2", "center"), ("r", "d", "d1", "d2")),
    "circle": (("r",), ("d",)),
    "multmatrix": (("m",), ()),
    "rotate_extrude": (("angle", "convexity"), ("start",)),
    "color": (("c", "alpha"), ()),
    "render": (("convexity",), ()),
    "group": ((), ()),
    "union": ((), ()),
    "difference": ((), ()),
    "intersection": ((), ()),
}
ROUND = ("sphere", "cylinder", "circle", "rotate_extrude")
SIMILARITIES = "only moves, rotations, mirrors and uniform scales are supported"

EMPTY = Union(())
"""The empty solid; there is only this one while a file is read."""


@dataclass(frozen=True)
class Circle:
    """A disc in the plane, which only `rotate_extrude` can use."""

    x: float
    y: float
    radius: float
    position: int


@dataclass(frozen=True)
class Fault:
    """An error that counts only if the node is used: it may be below a `*` or `%`."""

    error: FileError


Shape = Solid | Circle | Fault


class Call(NamedTuple):
    """What stands before a node's children."""

    modifiers: str
    name: str
    values: dict[str, Any]
    position: int


class Shapes:
    """Makes shapes of calls, and keeps what is to be reported about them."""

    def __init__(self, source: Source) -> None:
        self.source = source
        self.counts: Counter[str] = Counter()
        self.ignored: dict[str, Ignored] = {}

    def shape(self, call: Call, children: list[Shape]) -> Shape:
        if call.name not in PARAMETERS:
            return self.fault(
                f"{call.name} is not supported: a .csg file may hold cube, sphere, cylinder, "
                "union, difference, intersection, group, color, render, multmatrix and "
                "rotate_extrude of a circle",
                call.position,
            )
        for child in children:
            if isinstance(child, Fault):
                return child
        try:
            action: Callable[[Call, list[Shape]], Shape] = getattr(self, "make_" + call.name)
            self.check_parameters(call)
            return action(call, children)
        except FileError as error:
            return Fault(error)
        except InputError as error:
            return Fault(self.source.wrong(f"{error} (in {call.name})", call.position))

    def check_parameters(self, call: Call) -> None:
        """Refuse what a primitive does not know; note that faceting is not followed."""
        order, more = PARAMETERS[call.name]
        if call.name in ("cube", *ROUND[:3]):
            for key in call.values:
                # special variables ($fn, $fa, $fs, $fe...) may be given to anything
                if key not in (*order, *more, "convexity") and not key.startswith("$"):
                    raise InputError(f"unknown parameter {key!r}; known are {', '.join(order)}")
        facets = call.values.get("$fn")
        if call.name in ROUND and isinstance(facets, float) and facets > 0:
            self.note(f"$fn = {facets:g} (surfaces are exact, not facets)", call.position)

    def make_cube(self, call: Call, children: list[Shape]) -> Shape:
        self.no_children(call, children)
        given = call.values.get("size", 1.0)
        size = np.array(
            [number(v, "size") for v in (given if isinstance(given, list) else [given] * 3)]
        )
        if size.shape != (3,):
            raise InputError(f"size must be one number or three, got {len(size)}")
        if (size == 0).any() and (size >= 0).all():
            return self.nothing(call)
        corner = -size / 2 if _yes(call, "center") else np.zeros(3)
        return Block(corner, size, self.numbered("cube"))

    def make_sphere(self, call: Call, children: list[Shape]) -> Shape:
        self.no_children(call, children)
        radius = self.radius(call)
        if radius == 0:
            return self.nothing(call)
        return Sphere((0, 0, 0), radius, self.numbered("sphere"))

    def make_cylinder(self, call: Call, children: list[Shape]) -> Shape:
        self.no_children(call, children)
        height = number(call.values.get("h", 1.0), "h")
        common = self.radius(call)
        r1, r2 = self.radius(call, "1", common), self.radius(call, "2", common)
        if height < 0:
            raise InputError(f"h must not be negative, got {height:g}")
        if height == 0 or r1 == r2 == 0:
            return self.nothing(call)
        low = -height / 2 if _yes(call, "center") else 0.0
        base, top, name = (0, 0, low), (0, 0, low + height), self.numbered("cylinder")
        return Cylinder(base, top, r1, name) if r1 == r2 else Cone(base, r1, top, r2, name)

    def make_circle(self, call: Call, children: list[Shape]) -> Shape:
        self.no_children(call, children)
        radius = self.radius(call)
        return Circle(0.0, 0.0, radius, call.position) if radius > 0 else self.nothing(call)

    def make_rotate_extrude(self, call: Call, children: list[Shape]) -> Shape:
        shape = self.union(children)
        if shape is EMPTY or isinstance(shape, Fault):
            return shape
        given = call.values.get("angle")
        angle = 360.0 if given is None else number(given, "angle")
        if abs(angle) < 360:
            return self.fault(
                f"rotate_extrude by {angle:g} degrees is not supported, only the full turn",
                call.position,
            )
        if not isinstance(shape, Circle):
            return self.fault("rotate_extrude of anything but a circle", call.position)
        if shape.radius >= abs(shape.x):
            return self.fault(
                f"rotate_extrude of a circle that meets the axis (its centre at x = {shape.x:g}, "
                f"radius {shape.radius:g}) is not supported: the torus would meet itself",
                call.position,
            )
        name = self.numbered("torus")
        return Torus((0, 0, shape.y), (0, 0, 1), abs(shape.x), shape.radius, name)

    def make_multmatrix(self, call: Call, children: list[Shape]) -> Shape:
        shape = self.union(children)
        by = self.similarity(call, isinstance(shape, Circle))
        if isinstance(by, Fault):
            return by
        if isinstance(shape, Circle):
            x, y, _ = by.points(np.array([shape.x, shape.y, 0.0]))
            return Circle(float(x), float(y), shape.radius * by.scale, shape.position)
        if isinstance(shape, Fault) or shape is EMPTY:
            return shape
        return Transformed(shape, by)

    def make_difference(self, call: Call, children: list[Shape]) -> Shape:
        if not children or children[0] is EMPTY:
            return EMPTY
        base, *tools = self.solid(children)
        if isinstance(base, Fault):
            return base
        tools = [tool for tool in tools if tool is not EMPTY]
        if not tools:
            return base
        return Difference(base, tools[0] if len(tools) == 1 else Union(tuple(tools)))

    def make_intersection(self, call: Call, children: list[Shape]) -> Shape:
        if not children or any(child is EMPTY for child in children):
            return EMPTY
        solids = self.solid(children)
        return solids[0] if len(solids) == 1 else Intersection(tuple(solids))

    def make_union(self, call: Call, children: list[Shape]) -> Shape:
        return self.union(children)

    make_group = make_color = make_render = make_union

    def union(self, children: list[Shape]) -> Shape:
        """All children together: the child itself if there is only one that is not empty."""
        for child in children:
            if isinstance(child, Fault):
                return child
        full = [child for child in children if child is not EMPTY]
        if len(full) <= 1:
            return full[0] if full else EMPTY
        try:
            return Union(tuple(self.solid(full)))
        except FileError as error:
            return Fault(error)

    def solid(self, children: list[Shape]) -> list[Solid]:
        """The children, none of which may be flat."""
        for child in children:
            if isinstance(child, Circle):
                raise self.flat(child).error
        return [child for child in children if isinstance(child, Solid)]

    def flat(self, circle: Circle) -> Fault:
        return self.fault("circle is not supported but alone in a rotate_extrude", circle.position)

    def similarity(self, call: Call, flat: bool) -> Similarity | Fault:
        """The transform of a multmatrix; in the plane only x and y count."""
        matrix = self.matrix(call)
        if flat:
            plane = np.eye(4)
            plane[:2, :2], plane[:2, 3] = matrix[:2, :2], matrix[:2, 3]
            plane[2, 2] = sqrt(abs(float(np.linalg.det(matrix[:2, :2]))))
            matrix = plane
        try:
            return from_matrix(matrix)
        except InputError:
            if np.linalg.matrix_rank(matrix[:3, :3]) < 3:
                what = "flattens its children"
            elif len(matrix) == 4 and matrix[3].tolist() != [0, 0, 0, 1]:
                what = "is a perspective projection"
            else:
                what = "has a non-uniform scale or shear"
            return self.fault(f"multmatrix {what}: {SIMILARITIES}", call.position)

    def matrix(self, call: Call) -> Array:
        rows = call.values.get("m")
        if (
            not isinstance(rows, list)
            or len(rows) not in (3, 4)
            or any(not isinstance(row, list) or len(row) != 4 for row in rows)
        ):
            raise InputError("the matrix must have four rows of four numbers")
        return np.array([[number(entry, "a matrix entry") for entry in row] for row in rows])

    def radius(self, call: Call, which: str = "", default: float = 1.0) -> float:
        """A radius by its own name or as a diameter."""
        values = call.values
        if values.get("d" + which) is not None:
            result = number(values["d" + which], "d" + which) / 2
        else:
            given = values.get("r" + which)
            result = number(default if given is None else given, "r" + which)
        if result < 0:
            raise InputError(f"r{which} must not be negative, got {result:g}")
        return result

    def nothing(self, call: Call) -> Solid:
        self.note(f"{call.name} without volume", call.position)
        return EMPTY

    def no_children(self, call: Call, children: list[Shape]) -> None:
        if children:
            raise InputError(f"{call.name} takes no children")

    def numbered(self, kind: str) -> str:
        self.counts[kind] += 1
        return f"{kind}{self.counts[kind]}"

    def note(self, what: str, position: int) -> None:
        """Report something ignored, once."""
        if what not in self.ignored:
            self.ignored[what] = Ignored(what, self.source.line(position))

    def fault(self, message: str, position: int) -> Fault:
        return Fault(self.source.unsupported(message, position))


def _yes(call: Call, key: str) -> bool:
    value = call.values.get(key, False)
    if value is None or isinstance(value, (bool, float)):
        return bool(value)
    raise InputError(f"{key} must be true or false, got {value!r}")
