"""A second reader of Netgen's .geo text, which shares nothing with the package's own.

The text becomes Python expressions over `Node`: `not`, `and`, `or` turn into `~`, `&`, `|`,
whose precedence is the same, and `;` between numbers into `,`.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


class UnreadableError(Exception):
    """The text has a solid that this reader does not know."""


@dataclass(frozen=True, eq=False)
class Surface:
    """A half-space: inside where the signed distance is negative."""

    kind: str
    numbers: tuple[float, ...]

    def moved(self, offset: Floats) -> Surface:
        """The same half-space elsewhere."""
        places = {"plane": 1, "sphere": 1, "cylinder": 2, "torus": 1, "cone": 2}[self.kind]
        points = np.reshape(self.numbers[: 3 * places], (-1, 3)) + offset
        return Surface(self.kind, (*points.ravel().tolist(), *self.numbers[3 * places :]))

    def distance(self, points: Floats) -> Floats:
        """Signed distance of points (n, 3); exact for all kinds."""
        v = np.array(self.numbers)
        rest = points - v[:3]
        if self.kind == "plane":
            return rest @ (v[3:6] / np.linalg.norm(v[3:6]))
        if self.kind == "sphere":
            return np.linalg.norm(rest, axis=1) - v[3]
        if self.kind == "torus":
            along, across = _axial(rest, v[3:6])
            return np.hypot(along, across - v[6]) - v[7]
        along, across = _axial(rest, v[3:6] - v[:3])
        if self.kind == "cylinder":
            return across - v[6]
        return _cone_distance(along, across, v[6], v[7], float(np.linalg.norm(v[3:6] - v[:3])))

    def reach(self, half: Floats) -> Floats:
        """How much the distance can change from the middle to any point of boxes (n, 3)."""
        axis = self.axis()
        if self.kind == "plane":
            return half @ np.abs(axis)
        if self.kind == "cylinder" and np.count_nonzero(axis) == 1:
            return np.linalg.norm(half * (axis == 0), axis=1)
        return np.linalg.norm(half, axis=1)

    def axis(self) -> Floats:
        """Unit normal of a plane, unit axis of a cylinder, else zero."""
        v = np.array(self.numbers)
        if self.kind not in ("plane", "cylinder"):
            return np.zeros(3)
        way = v[3:6] if self.kind == "plane" else v[3:6] - v[:3]
        return way / np.linalg.norm(way)

    def box(self) -> Floats:
        """A box (2, 3) around the half-space, infinite where it has no simple end."""
        v, box = np.array(self.numbers), np.array([[-np.inf] * 3, [np.inf] * 3])
        axis = self.axis()
        if self.kind == "sphere":
            return np.array([v[:3] - v[3], v[:3] + v[3]])
        if self.kind == "torus":
            return np.array([v[:3] - v[6] - v[7], v[:3] + v[6] + v[7]])
        if self.kind == "plane" and np.count_nonzero(axis) == 1:
            k = int(np.argmax(np.abs(axis)))
            box[1 if axis[k] > 0 else 0, k] = v[k]
        if self.kind == "cylinder" and np.count_nonzero(axis) == 1:
            across = axis == 0
            box[:, across] = np.array([v[:3] - v[6], v[:3] + v[6]])[:, across]
        return box


@dataclass(frozen=True, eq=False)
class Node:
    """A Boolean expression: `leaf` with a surface, `not`, `and` or `or` of parts."""

    kind: str
    parts: tuple[Node, ...] = ()
    surface: Surface | None = None

    def __and__(self, other: Node) -> Node:
        return Node("and", (self, other))

    def __or__(self, other: Node) -> Node:
        return Node("or", (self, other))

    def __invert__(self) -> Node:
        return Node("not", (self,))

    def moved(self, offset: Floats) -> Node:
        """The same solid elsewhere."""
        surface = self.surface.moved(offset) if self.surface else None
        return Node(self.kind, tuple(p.moved(offset) for p in self.parts), surface)

    def surfaces(self) -> list[Surface]:
        """All half-spaces, one for each time that they are used."""
        if self.surface:
            return [self.surface]
        return [s for part in self.parts for s in part.surfaces()]


def read(path: Path) -> dict[str, Node]:
    """The solids that become regions (`tlo`), by name.

    Raises:
        UnreadableError: a solid of another kind, or text that is no Python after the changes.
    """
    text = re.sub(r"#[^\n]*", "", path.read_text(encoding="latin-1"))
    text = re.sub(r"-\s*[A-Za-z_]\w*(\s*=\s*(\[[^\]]*\]|[\w.+-]+))?", " ", text)
    text = text.split("algebraic3d", 1)[1]
    solids: dict[str, Node] = {}
    regions: dict[str, Node] = {}
    for statement in _statements(text):
        word, _, rest = statement.partition(" ")
        if word == "solid":
            name, _, expression = rest.partition("=")
            solids[name.strip()] = _value(expression, solids)
        elif word == "tlo" and len(rest.split()) == 1:
            regions[rest.strip()] = solids[rest.strip()]
        elif word not in ("tlo", "identify", "singular", "point", "boundingbox") and (
            word != "boundarycondition"
        ):
            raise UnreadableError(statement[:40])
    return regions


def _statements(text: str) -> list[str]:
    """Split at the semicolons outside brackets; those inside become commas."""
    depth, pieces = 0, [""]
    for c in text:
        depth += (c == "(") - (c == ")")
        if c == ";" and depth == 0:
            pieces.append("")
        else:
            pieces[-1] += "," if c == ";" else c
    return [" ".join(p.split()) for p in pieces if p.strip()]


def _value(expression: str, solids: dict[str, Node]) -> Node:
    for word, sign in (("not", "~"), ("and", "&"), ("or", "|")):
        expression = re.sub(rf"\b{word}\b", sign, expression)
    names: dict[str, object] = {"__builtins__": {}, **MAKERS, **solids}
    try:
        value = eval(expression, names)
    except (NameError, SyntaxError, TypeError) as e:
        raise UnreadableError(str(e)) from None
    if not isinstance(value, Node):
        raise UnreadableError(expression)
    return value


def _leaf(kind: str) -> Callable[..., Node]:
    return lambda *numbers: Node("leaf", (), Surface(kind, tuple(map(float, numbers))))


def _brick(*corners: float) -> Node:
    ends = np.sort(np.reshape(corners, (2, 3)), axis=0)
    planes = [
        _leaf("plane")(*ends[side], *((2 * side - 1) * np.eye(3)[k]))
        for k in range(3)
        for side in (0, 1)
    ]
    return Node("and", tuple(planes))


def _cone(*numbers: float) -> Node:
    a, ra, b, rb = numbers[:3], numbers[3], numbers[4:7], numbers[7]
    return _leaf("cone")(*a, *b, ra, rb)


def _copies(x: float, y: float, z: float, count: float, part: Node) -> Node:
    return Node("or", tuple(part.moved(k * np.array([x, y, z])) for k in range(int(count) + 1)))


MAKERS: dict[str, object] = {
    "plane": _leaf("plane"),
    "sphere": _leaf("sphere"),
    "cylinder": _leaf("cylinder"),
    "torus": _leaf("torus"),
    "cone": _cone,
    "orthobrick": _brick,
    "multitranslate": _copies,
    "translate": lambda x, y, z, part: part.moved(np.array([x, y, z])),
}


def _axial(rest: Floats, way: Floats) -> tuple[Floats, Floats]:
    """Coordinates along a direction and across it."""
    axis = way / np.linalg.norm(way)
    along = rest @ axis
    return along, np.linalg.norm(rest - along[:, None] * axis, axis=1)


def _cone_distance(along: Floats, across: Floats, ra: float, rb: float, length: float) -> Floats:
    """Signed distance to one nappe: to its ruling in the half-plane, or to its apex."""
    slope = (rb - ra) / length
    height = (along + ra / slope) * np.sign(slope)
    cosine = 1 / np.hypot(1, slope)
    to_ruling = (across - abs(slope) * height) * cosine
    beyond = height + abs(slope) * across < 0
    return np.where(beyond, np.hypot(height, across), to_ruling)
