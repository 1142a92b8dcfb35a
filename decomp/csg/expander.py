"""A model expanded: every primitive in its places, and a graph of ANDs over their carriers."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from decomp.carriers import Carrier
from decomp.csg.options import Options
from decomp.csg.placing import Placing
from decomp.csg.primitives import Primitive
from decomp.csg.program import FALSE, TRUE, inverted
from decomp.csg.solid import (
    LONGEST_NAME,
    Complement,
    Copies,
    Difference,
    Intersection,
    Labelled,
    Solid,
    Transformed,
    Union,
)
from decomp.errors import InputError
from decomp.magnitude import RESOLUTION, check_length, check_magnitude
from decomp.similarity import Similarity
from decomp.vectors import Array


@dataclass(frozen=True, eq=False)
class _Context:
    """What a node inherits from those above it.

    `inexact` are the moves that are known to few digits, the outermost first.
    """

    placing: Placing
    prefix: str
    suffix: str
    options: Options
    inexact: tuple[Similarity, ...] = ()


class Expander:
    """Expands the tree into placed primitives and a graph of ANDs over raw carriers.

    A subtree that is met again in the same context is expanded once.

    Args:
        names: of primitives by identity.
        placing: of the whole model.
    """

    def __init__(self, names: dict[int, str], placing: Placing) -> None:
        self.carriers: list[Carrier] = []
        self.steps: list[tuple[Similarity, ...]] = []
        self.bounds: dict[int, Array] = {}
        self.nodes: list[tuple[str, tuple[int, ...]]] = [("and", ())]
        self.placed: list[tuple[str, list[tuple[str, int]], Options]] = []
        self._names = names
        self._done: dict[tuple[int, int], int] = {}
        self._placed_at: dict[int, int] = {}
        self._contexts: dict[tuple[int, int, int], _Context] = {}
        self._root = _Context(placing, "", "", Options())

    def expand(self, root: Solid) -> int:
        """Reference to the node that stands for `root`."""
        stack = [(root, self._root)]
        while stack:
            node, context = stack[-1]
            if (id(node), id(context)) in self._done:
                stack.pop()
                continue
            parts = self._parts(node, context)
            missing = [p for p in parts if (id(p[0]), id(p[1])) not in self._done]
            if missing:
                stack.extend(reversed(missing))
                continue
            stack.pop()
            references = [self._done[id(n), id(c)] for n, c in parts]
            self._done[id(node), id(context)] = self._combine(node, context, references)
        return self._done[id(root), id(self._root)]

    def placed_below(self, reference: int) -> set[int]:
        """Indices of the placed primitives that a node is made of."""
        found: set[int] = set()
        seen: set[int] = set()
        stack = [reference >> 1]
        while stack:
            node = stack.pop()
            if node in seen:
                continue
            seen.add(node)
            if node in self._placed_at:
                found.add(self._placed_at[node])
            elif self.nodes[node][0] == "and":
                stack.extend(ref >> 1 for ref in self.nodes[node][1])
        return found

    def _parts(self, node: Solid, context: _Context) -> list[tuple[Solid, _Context]]:
        match node:
            case Transformed(part=part):
                return [(part, self._context(context, node, 0))]
            case Copies(part=part, by=by):
                return [(part, self._context(context, node, k)) for k in range(len(by))]
            case Labelled(part=part):
                return [(part, self._context(context, node, 0))]
            case _:
                return [(child, context) for child in node.children()]

    def _context(self, outer: _Context, node: Solid, copy: int) -> _Context:
        key = (id(outer), id(node), copy)
        if key not in self._contexts:
            self._contexts[key] = _inner_context(outer, node, copy)
        return self._contexts[key]

    def _combine(self, node: Solid, context: _Context, references: list[int]) -> int:
        match node:
            case Primitive():
                return self._place(node, context)
            case Union() | Copies():
                return inverted(self._conjunction([inverted(r) for r in references]))
            case Intersection():
                return self._conjunction(references)
            case Difference():
                return self._conjunction([references[0], inverted(references[1])])
            case Complement():
                return inverted(references[0])
            case _:
                return references[0]

    def _place(self, primitive: Primitive, context: _Context) -> int:
        name = context.prefix + self._names[id(primitive)] + context.suffix
        sides: list[tuple[str, int]] = []
        literals = []
        pivot, transform = context.placing.pivot, context.placing.by
        local = primitive if pivot is None else primitive.about(pivot)
        for face, carrier in local.half_spaces():
            sides.append((f"{name}.{face}" if face else name, len(self.carriers)))
            self.nodes.append(("literal", (len(self.carriers),)))
            literals.append(2 * (len(self.nodes) - 1))
            self.carriers.append(_checked(carrier.transformed(transform), name))
            self.steps.append(context.inexact)
        box = local.bounds()
        if box is not None:
            corners = np.array([[box[(k >> j) & 1, j] for j in range(3)] for k in range(8)])
            corners = transform.points(corners)
            check_length(float(np.ptp(corners, axis=0).max()), f"the size of {name}")
            self.bounds[len(self.nodes)] = np.array([corners.min(axis=0), corners.max(axis=0)])
        # A node of its own even for a single half-space, so that the primitive can be found again.
        self.nodes.append(("and", tuple(literals)))
        self._placed_at[len(self.nodes) - 1] = len(self.placed)
        self.placed.append((name, sides, context.options))
        return 2 * (len(self.nodes) - 1)

    def _conjunction(self, references: list[int]) -> int:
        parts = tuple(dict.fromkeys(references))
        if len(parts) == 1:
            return parts[0]
        if FALSE in parts:
            return FALSE
        self.nodes.append(("and", tuple(p for p in parts if p != TRUE)))
        return 2 * (len(self.nodes) - 1)


def _inner_context(outer: _Context, node: Solid, copy: int) -> _Context:
    """The context below a `Transformed`, `Copies` or `Labelled` node."""
    match node:
        case Transformed(by=by):
            return _moved(outer, by, outer.suffix)
        case Copies(by=by):
            suffix = _short_enough(f"#{copy + 1}{outer.suffix}")
            return _moved(outer, by[copy], suffix)
        case Labelled(name=name, options=options):
            prefix = outer.prefix if name is None else _short_enough(f"{outer.prefix}{name}.")
            merged = Options({**outer.options, **options})
            return replace(outer, prefix=prefix, options=merged)
    raise TypeError(f"{type(node).__name__} gives no context")


def _moved(outer: _Context, by: Similarity, suffix: str) -> _Context:
    inexact = (*outer.inexact, by) if by.doubt or by.shift else outer.inexact
    return replace(outer, placing=_composed(outer, by), suffix=suffix, inexact=inexact)


def _composed(outer: _Context, by: Similarity) -> Placing:
    """A move inside another one, refused where moves that are each in range add up too far."""
    result = outer.placing.after(by)
    check_length(result.by.scale, "the scale of a solid inside scaled ones")
    check_magnitude(result.by.offset, "the move of a solid inside moved ones")
    return result


def _short_enough(name: str) -> str:
    """A part of faces' names; each level of labels and copies makes it longer."""
    if len(name) > LONGEST_NAME:
        raise InputError(
            f"labels and copies are nested so deep that faces' names pass {LONGEST_NAME:,} "
            f"characters: {name[:40]}..."
        )
    return name


def _checked(carrier: Carrier, name: str) -> Carrier:
    """A placed carrier, refused where its place or its radii are out of range."""
    check_magnitude(carrier.packed(), f"the place of {name}")
    least, reach = carrier.least_radius, carrier.remoteness
    if np.isinf(least):
        return carrier
    check_length(least, f"the radius of {name}")
    if least < RESOLUTION * reach:
        raise InputError(
            f"{name} has a radius of {least:g}, which is lost in the digits of its coordinates "
            f"({reach:.3g}): make it larger, or leave it out"
        )
    return carrier
