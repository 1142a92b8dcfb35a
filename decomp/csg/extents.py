"""Where in space each carrier can matter: boxes passed up and down the Boolean program.

Upwards every node gets a box that holds all points where it is true, and one for where it is
false. Downwards every node gets the box in which its value can influence a region: inside an AND a
part matters only where all the other parts may be true. Boxes are (2, 3) corners, infinite where
nothing bounds them; empty boxes have a low corner above the high one.
"""

from __future__ import annotations

import numpy as np

from decomp.carriers import Carrier
from decomp.carriers.base import EVERYWHERE
from decomp.csg.program import Program
from decomp.vectors import Array, Bools

BOX_SLACK = 1e-6
"""Boxes are widened by this part of the model's scale, so that nothing ends on their faces."""

EVERYTHING = np.array(EVERYWHERE)
NOTHING = -EVERYTHING


def extents(program: Program, carriers: tuple[Carrier, ...], slack: float) -> tuple[Array, Array]:
    """Boxes of regions and carriers.

    Args:
        program: the Boolean program.
        carriers: the carriers that its literals speak of.
        slack: all boxes are widened by this length.

    Returns:
        Boxes (n_regions, 2, 3) that hold each region, and (n_carriers, 2, 3) outside which a
        carrier influences no region.
    """
    true_box, false_box = _upwards(program, carriers)
    regions = np.array([_box(true_box, false_box, int(ref)) for ref in program.roots])
    matters = _downwards(program, true_box, false_box)
    widen = np.array([[-slack] * 3, [slack] * 3])
    active = np.repeat(NOTHING[None], len(carriers), axis=0)
    for node, carrier in enumerate(program.literal):
        if carrier >= 0:
            surface = carriers[carrier].box()
            active[carrier] = _intersection(matters[node], surface)
    return regions.reshape(-1, 2, 3) + widen, active + widen


def overlap(a: Array, b: Array) -> Bools:
    """Whether boxes (..., 2, 3) share a point: (...) bool."""
    return np.asarray(
        (a[..., 0, :] <= b[..., 1, :]).all(axis=-1) & (b[..., 0, :] <= a[..., 1, :]).all(axis=-1)
    )


def _upwards(program: Program, carriers: tuple[Carrier, ...]) -> tuple[Array, Array]:
    count = len(program.literal)
    true_box = np.empty((count, 2, 3))
    false_box = np.empty((count, 2, 3))
    for node, carrier in enumerate(program.literal):
        if carrier >= 0:
            true_box[node], false_box[node] = carriers[carrier].half_space_boxes()
            continue
        parts = program.operands[program.start[node] : program.start[node + 1]]
        true_box[node] = program.boxes[node]
        false_box[node] = NOTHING
        for ref in parts:
            true_box[node] = _intersection(true_box[node], _box(true_box, false_box, int(ref)))
            false_box[node] = _hull(false_box[node], _box(true_box, false_box, int(ref) ^ 1))
    return true_box, false_box


def _downwards(program: Program, true_box: Array, false_box: Array) -> Array:
    matters = np.repeat(NOTHING[None], len(program.literal), axis=0)
    for ref in program.roots:
        matters[ref >> 1] = EVERYTHING
    for node in range(len(program.literal) - 1, -1, -1):
        parts = program.operands[program.start[node] : program.start[node + 1]]
        if not len(parts) or _is_empty(matters[node]):
            continue
        boxes = [_box(true_box, false_box, int(ref)) for ref in parts]
        before = [_intersection(matters[node], program.boxes[node])]
        for box in boxes[:-1]:
            before.append(_intersection(before[-1], box))
        after = EVERYTHING
        for k in range(len(parts) - 1, -1, -1):
            here = _intersection(before[k], after)
            target = int(parts[k]) >> 1
            if not _is_empty(here):
                matters[target] = _hull(matters[target], here)
            after = _intersection(after, boxes[k])
    return matters


def _box(true_box: Array, false_box: Array, ref: int) -> Array:
    return np.asarray((false_box if ref & 1 else true_box)[ref >> 1])


def _intersection(a: Array, b: Array) -> Array:
    return np.array([np.maximum(a[0], b[0]), np.minimum(a[1], b[1])])


def _hull(a: Array, b: Array) -> Array:
    return np.array([np.minimum(a[0], b[0]), np.maximum(a[1], b[1])])


def _is_empty(box: Array) -> bool:
    return bool((box[0] > box[1]).any())
