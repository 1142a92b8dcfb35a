"""Half-space form of a model: merged carriers and one Boolean program over them."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from decomp.carriers import Carrier, CarrierTable
from decomp.csg.counting import refuse_too_many
from decomp.csg.expander import Expander
from decomp.csg.extents import BOX_SLACK, extents
from decomp.csg.merging import doubt, merged
from decomp.csg.model import Model
from decomp.csg.options import Options
from decomp.csg.placing import AT_ORIGIN, Placing
from decomp.csg.primitives import Primitive
from decomp.csg.program import Program, ProgramBuilder
from decomp.csg.solid import (
    walk,
)
from decomp.errors import InputError
from decomp.magnitude import FARTHEST
from decomp.tolerance import TOLERANCE
from decomp.vectors import Array, Bools, norm


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
        offset: (3,), where its own origin is in the model's coordinates: everything here is told
            from there.
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
    offset: Array
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


def half_space_form(
    model: Model, scale: float | None = None, placing: Placing = AT_ORIGIN
) -> HalfSpaceForm:
    """Bring a model into half-space form, merging coincident carriers.

    Args:
        model: the model.
        scale: its diagonal, if known; by default estimated from its primitives.
        placing: about what the model is told; by default about its own origin.

    Raises:
        InputError: it has too many primitives when its copies are made, or they are too large, too
            small or too far away to compute with.
    """
    refuse_too_many(model)
    expander = Expander(_automatic_names(model), placing)
    roots = [expander.expand(region.solid) for region in model.regions]
    centre, estimate = _extent(expander)
    _refuse_far(placing.offset + centre, estimate)
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
        surfaces,
        program,
        names,
        placed,
        used,
        placing.offset,
        centre,
        size,
        region_boxes,
        carrier_boxes,
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


def _refuse_far(centre: Array, size: float) -> None:
    away = float(norm(centre))
    if away > FARTHEST * size:
        raise InputError(
            f"the model's size is {size:.3g}, but it is {away:.3g} away from the origin, where "
            "coordinates have not the digits to tell its points apart: move it nearer"
        )


def _extent(expander: Expander) -> tuple[Array, float]:
    """Middle and diagonal of a box around the primitives, of infinite ones around their points."""
    points = list(expander.bounds.values())
    for carrier in expander.carriers:
        point, width = carrier.packed()[:3], carrier.width
        points.append(np.array([point - width, point + width]))
    if not points:
        return np.zeros(3), 1.0
    cloud = np.concatenate(points)
    low, high = cloud.min(axis=0), cloud.max(axis=0)
    return (low + high) / 2, float(np.linalg.norm(high - low)) or 1.0
