"""Half-space form of a model: merged carriers and one Boolean program over them."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, replace
from functools import cached_property
from types import MappingProxyType

import numpy as np

from decomp.carriers import Carrier, CarrierTable, Sphere, Torus
from decomp.csg.extents import BOX_SLACK, extents
from decomp.csg.merging import doubt, merged
from decomp.csg.model import Model
from decomp.csg.primitives import Primitive
from decomp.csg.program import FALSE, TRUE, Program, ProgramBuilder, inverted
from decomp.csg.solid import (
    Complement,
    Copies,
    Difference,
    Intersection,
    Labelled,
    Options,
    Solid,
    Transformed,
    Union,
    no_options,
    walk,
)
from decomp.similarity import IDENTITY, Similarity
from decomp.tolerance import TOLERANCE
from decomp.vectors import Array, Bools


@dataclass(frozen=True, eq=False)
class Side:
    """A carrier with a side: a face that a primitive has before any Boolean operation.

    Args:
        name: `hole.side`.
        carrier: index into `HalfSpaceForm.carriers`.
        inside: whether the primitive lies inside the carrier (it may face the other way when the
            carrier was merged with one of opposite orientation).
    """

    name: str
    carrier: int
    inside: bool


@dataclass(frozen=True, eq=False)
class Placed:
    """A primitive as placed in space: what it is called, its sides and its options."""

    name: str
    sides: tuple[Side, ...]
    options: Options


@dataclass(frozen=True, eq=False)
class HalfSpaceForm:
    """A model as carriers and a program over them.

    Args:
        carriers: pairwise different surfaces.
        program: one root per region.
        names: of the regions.
        placed: every primitive, in the order of the model.
        used: for each region the indices into `placed` that it is made of, in order.
        centre: (3,), the middle of the primitives' reference points.
        scale: the length to which the tolerance is relative.
        region_boxes: (n_regions, 2, 3), corners of a box around each region, maybe infinite.
        carrier_boxes: (n_carriers, 2, 3), corners of a box outside which a carrier does not matter.
    """

    carriers: tuple[Carrier, ...]
    program: Program
    names: tuple[str, ...]
    placed: tuple[Placed, ...]
    used: tuple[tuple[int, ...], ...]
    centre: Array
    scale: float
    region_boxes: Array
    carrier_boxes: Array

    @property
    def tolerance(self) -> float:
        """Lengths below this count as zero."""
        return TOLERANCE * self.scale

    @cached_property
    def table(self) -> CarrierTable:
        """The carriers packed for work on all of them at once."""
        return CarrierTable(self.carriers)

    def carrier_name(self, carrier: int) -> str:
        """How messages call a carrier: by the first primitive that it is a side of."""
        for placed in self.placed:
            for side in placed.sides:
                if side.carrier == carrier:
                    return side.name
        raise KeyError(carrier)

    def signed_distances(self, points: Array) -> Array:
        """Signed distances (..., n_carriers) of points (..., 3) to every carrier."""
        flat = points.reshape(-1, 3)
        distances = self.table.distances(flat)
        return np.ascontiguousarray(distances.T).reshape(*points.shape[:-1], len(self.carriers))

    def regions_at(self, points: Array) -> Bools:
        """Which regions (..., n_regions) hold the points (..., 3); brute force over carriers."""
        return self.program.evaluate(self.signed_distances(points) < 0)


@dataclass(frozen=True, eq=False)
class _Context:
    """What a node inherits from those above it.

    `inexact` are the moves that are known to few digits, the outermost first.
    """

    transform: Similarity
    prefix: str
    suffix: str
    options: Options
    inexact: tuple[Similarity, ...] = ()


def half_space_form(model: Model, scale: float | None = None) -> HalfSpaceForm:
    """Bring a model into half-space form, merging coincident carriers.

    Args:
        model: the model.
        scale: its diagonal, if known; by default estimated from its primitives.
    """
    expander = _Expander(_automatic_names(model))
    roots = [expander.expand(region.solid) for region in model.regions]
    centre, estimate = _extent(expander)
    size = estimate if scale is None else scale
    index, sign, carriers = merged(expander.carriers, size, expander.steps)

    # a carrier may have been merged with one that lies so far off
    widest = 2 * max((doubt(steps, size) for steps in expander.steps), default=0.0)
    room = np.array([[-widest], [widest]])
    builder = ProgramBuilder()
    reference: list[int] = []
    for kind, content in expander.nodes:
        if kind == "literal":
            reference.append(builder.literal(index[content[0]], sign[content[0]] > 0))
        else:
            parts = [reference[ref >> 1] ^ (ref & 1) for ref in content]
            reference.append(builder.conjunction(parts))
            if len(reference) - 1 in expander.bounds:
                builder.bound(reference[-1], expander.bounds[len(reference) - 1] + room)
    program = builder.finish([reference[r >> 1] ^ (r & 1) for r in roots])

    placed = tuple(
        Placed(
            name,
            tuple(Side(face, index[raw], sign[raw] > 0) for face, raw in sides),
            options,
        )
        for name, sides, options in expander.placed
    )
    used = tuple(tuple(sorted(expander.placed_below(root))) for root in roots)
    names = tuple(region.name for region in model.regions)
    surfaces = tuple(carriers)
    region_boxes, carrier_boxes = extents(program, surfaces, BOX_SLACK * size)
    return HalfSpaceForm(
        surfaces, program, names, placed, used, centre, size, region_boxes, carrier_boxes
    )


def _automatic_names(model: Model) -> dict[int, str]:
    """Names for all primitives by identity: their own, else the kind with a running number."""
    counts: Counter[str] = Counter()
    names: dict[int, str] = {}
    for node in walk([region.solid for region in model.regions]):
        if isinstance(node, Primitive):
            counts[node.kind] += 1
            names[id(node)] = node.name or f"{node.kind}{counts[node.kind]}"
    return names


class _Expander:
    """Expands the tree into placed primitives and a graph of ANDs over raw carriers.

    A subtree that is met again in the same context is expanded once.
    """

    def __init__(self, names: dict[int, str]) -> None:
        self.carriers: list[Carrier] = []
        self.steps: list[tuple[Similarity, ...]] = []
        self.bounds: dict[int, Array] = {}
        self.nodes: list[tuple[str, tuple[int, ...]]] = [("and", ())]
        self.placed: list[tuple[str, list[tuple[str, int]], Options]] = []
        self._names = names
        self._done: dict[tuple[int, int], int] = {}
        self._placed_at: dict[int, int] = {}
        self._contexts: dict[tuple[int, int, int], _Context] = {}
        self._root = _Context(IDENTITY, "", "", no_options())

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
        for face, carrier in primitive.half_spaces():
            sides.append((f"{name}.{face}" if face else name, len(self.carriers)))
            self.nodes.append(("literal", (len(self.carriers),)))
            literals.append(2 * (len(self.nodes) - 1))
            self.carriers.append(carrier.transformed(context.transform))
            self.steps.append(context.inexact)
        box = primitive.bounds()
        if box is not None:
            corners = np.array([[box[(k >> j) & 1, j] for j in range(3)] for k in range(8)])
            corners = context.transform.points(corners)
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
            return _moved(outer, by[copy], f"#{copy + 1}{outer.suffix}")
        case Labelled(name=name, options=options):
            prefix = outer.prefix if name is None else f"{outer.prefix}{name}."
            both = MappingProxyType({**outer.options, **options})
            return replace(outer, prefix=prefix, options=both)
    raise TypeError(f"{type(node).__name__} gives no context")


def _moved(outer: _Context, by: Similarity, suffix: str) -> _Context:
    inexact = (*outer.inexact, by) if by.doubt or by.shift else outer.inexact
    inner = outer.transform.after(by)
    return replace(outer, transform=inner, suffix=suffix, inexact=inexact)


def _extent(expander: _Expander) -> tuple[Array, float]:
    """Middle and diagonal of a box around the primitives, of infinite ones around their points."""
    points = list(expander.bounds.values())
    for carrier in expander.carriers:
        data = carrier.packed()
        reach = data[6] if carrier.kind == "cylinder" else 0.0
        if isinstance(carrier, Sphere):
            reach = carrier.radius
        if isinstance(carrier, Torus):
            reach = carrier.major + carrier.minor
        points.append(np.array([data[:3] - reach, data[:3] + reach]))
    if not points:
        return np.zeros(3), 1.0
    cloud = np.concatenate(points)
    low, high = cloud.min(axis=0), cloud.max(axis=0)
    return (low + high) / 2, float(np.linalg.norm(high - low)) or 1.0
