"""Volumes by adaptive stratified sampling of membership.

Boxes in which the expression is certain (three-valued logic: a half-space is decided in a box when
its surface is further from the middle than the box reaches) count as a whole. The others are
halved down to a fine size, where each gets a few random points. Strata are cut along all planes
square to an axis, so that solids of such planes come out exactly.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tests.corpus.geo_text import Floats, Node, Surface

Bools = NDArray[np.bool_]
SAMPLES = 4
FEW = 6
ENOUGH = 100
ALWAYS, NEVER = Node("and"), Node("or")


@dataclass(frozen=True)
class Estimate:
    """A volume and its standard error.

    Args:
        volume, error: the estimate and its standard error.
        boxes: how many boxes were sampled.
        mixed: in how many of them samples fell on both sides; the error is trusted if many.
    """

    volume: float
    error: float
    boxes: int
    mixed: int


@dataclass(frozen=True, eq=False)
class Boxes:
    """Axis-parallel boxes: middles and half-extents (n, 3)."""

    middle: Floats
    half: Floats

    def __getitem__(self, which: Bools) -> Boxes:
        return Boxes(self.middle[which], self.half[which])

    @property
    def volumes(self) -> Floats:
        return np.asarray(8 * self.half.prod(axis=1))

    def halved(self) -> Boxes:
        """Two boxes for each one, cut across its longest side."""
        longest = np.eye(3, dtype=np.bool_)[self.half.argmax(axis=1)]
        half = np.where(longest, self.half / 2, self.half)
        step = np.where(longest, half, 0)
        return Boxes(
            np.concatenate([self.middle - step, self.middle + step]), np.concatenate([half, half])
        )


def volume(node: Node, accuracy: float, seed: int = 20240229) -> Estimate:
    """The volume of a bounded solid to a relative standard error of about `accuracy`."""
    rng = np.random.default_rng(seed)
    groups = pruned(node, start(node))
    size = float(max(boxes.volumes.max() for boxes, _ in groups)) / 500
    for _ in range(20):
        found = refined(groups, size, rng)
        if found.error <= accuracy * found.volume and (found.mixed >= ENOUGH or not found.boxes):
            return found
        if found.mixed < ENOUGH:
            size /= 10
        else:
            # the error goes with the square of the length, so with the volume to the power 2/3
            wanted = (accuracy * found.volume / found.error) ** 1.5
            size *= float(np.clip(wanted, 0.001, 0.5))
    raise AssertionError(f"no convergence: {found}")


def start(node: Node) -> Boxes:
    """A box around the solid, cut along its planes."""
    box = extent(node)
    reach = 3 * max(np.abs(s.numbers).max() for s in node.surfaces())
    box = np.clip(box, -reach, reach)
    cuts = [[box[0, k], box[1, k]] for k in range(3)]
    for surface in node.surfaces():
        axis = surface.axis()
        if surface.kind == "plane" and np.count_nonzero(axis) == 1:
            k = int(np.argmax(np.abs(axis)))
            cuts[k].append(surface.numbers[k])
    ticks = [np.unique(np.clip(c, box[0, k], box[1, k])) for k, c in enumerate(cuts)]
    low = np.stack(np.meshgrid(*[t[:-1] for t in ticks], indexing="ij"), axis=-1).reshape(-1, 3)
    high = np.stack(np.meshgrid(*[t[1:] for t in ticks], indexing="ij"), axis=-1).reshape(-1, 3)
    return Boxes((low + high) / 2, (high - low) / 2)


def extent(node: Node) -> Floats:
    """A box (2, 3) around a solid, infinite where none is seen."""
    if node.surface:
        return node.surface.box()
    boxes = np.array([extent(p) for p in node.parts])
    if node.kind == "and":
        return np.array([boxes[:, 0].max(axis=0), boxes[:, 1].min(axis=0)])
    if node.kind == "or":
        return np.array([boxes[:, 0].min(axis=0), boxes[:, 1].max(axis=0)])
    return np.array([[-np.inf] * 3, [np.inf] * 3])


def pruned(node: Node, boxes: Boxes, depth: int = 12) -> list[tuple[Boxes, Node]]:
    """Halve boxes until few half-spaces matter in each, and leave the others out of the node.

    Returns:
        Groups of boxes that share a simplified node; certain ones outside are left out.
    """
    groups: list[tuple[Boxes, Node]] = []
    stack = [
        (Boxes(boxes.middle[k : k + 1], boxes.half[k : k + 1]), node, depth)
        for k in range(len(boxes.middle))
    ]
    while stack:
        box, expression, left = stack.pop()
        expression = simplified(expression, box)
        if expression is NEVER:
            continue
        if left == 0 or len(expression.surfaces()) <= FEW:
            groups.append((box, expression))
            continue
        parts = box.halved()
        for k in range(2):
            part = Boxes(parts.middle[k : k + 1], parts.half[k : k + 1])
            stack.append((part, expression, left - 1))
    return groups


def simplified(node: Node, box: Boxes) -> Node:
    """The node with everything folded that is certain in one box."""
    if node.surface:
        inside, outside = decided(node.surface, box)
        return ALWAYS if inside[0] else NEVER if outside[0] else node
    parts = [simplified(p, box) for p in node.parts]
    if node.kind == "not":
        return {id(ALWAYS): NEVER, id(NEVER): ALWAYS}.get(id(parts[0]), Node("not", (parts[0],)))
    neutral, final = (ALWAYS, NEVER) if node.kind == "and" else (NEVER, ALWAYS)
    if any(p is final for p in parts):
        return final
    parts = [p for p in parts if p is not neutral]
    return neutral if not parts else parts[0] if len(parts) == 1 else Node(node.kind, tuple(parts))


def refined(groups: list[tuple[Boxes, Node]], size: float, rng: np.random.Generator) -> Estimate:
    """Sum over groups: boxes halved to volume `size`, then sampled."""
    total: list[float] = []
    variance, sampled, mixed = 0.0, 0, 0
    for first, node in groups:
        boxes = first
        while len(boxes.middle):
            inside, outside = certain(node, boxes)
            total.append(float(boxes.volumes[inside].sum()))
            boxes = boxes[~(inside | outside)]
            large = boxes.volumes > size
            share = shares(node, boxes[~large], rng)
            volumes = boxes.volumes[~large]
            total.append(float((share * volumes).sum()))
            variance += float((volumes**2 * share * (1 - share)).sum()) / (SAMPLES - 1)
            sampled += len(share)
            mixed += int(((share > 0) & (share < 1)).sum())
            boxes = boxes[large].halved()
    return Estimate(float(np.sum(total)), float(np.sqrt(variance)), sampled, mixed)


def shares(node: Node, boxes: Boxes, rng: np.random.Generator) -> Floats:
    """The share of random points in each box (n,) that lie in the solid."""
    hits = np.zeros(len(boxes.middle))
    for _ in range(SAMPLES):
        points = boxes.middle + boxes.half * rng.uniform(-1, 1, boxes.middle.shape)
        hits += contains(node, points)
    return hits / SAMPLES


def contains(node: Node, points: Floats) -> Bools:
    """Which points (n, 3) are in the solid."""
    if node.surface:
        return np.asarray(node.surface.distance(points) < 0)
    parts = [contains(p, points) for p in node.parts]
    if node.kind == "not":
        return ~parts[0]
    none = np.zeros(len(points), dtype=np.bool_)
    return np.all([~none, *parts], axis=0) if node.kind == "and" else np.any([none, *parts], axis=0)


def certain(node: Node, boxes: Boxes) -> tuple[Bools, Bools]:
    """Which boxes are certainly inside the solid, and which certainly outside."""
    if node.surface:
        return decided(node.surface, boxes)
    parts = [certain(p, boxes) for p in node.parts]
    if node.kind == "not":
        return parts[0][1], parts[0][0]
    none = np.zeros(len(boxes.middle), dtype=np.bool_)
    insides, outsides = [p[0] for p in parts], [p[1] for p in parts]
    if node.kind == "and":
        return np.all([~none, *insides], axis=0), np.any([none, *outsides], axis=0)
    return np.any([none, *insides], axis=0), np.all([~none, *outsides], axis=0)


def decided(surface: Surface, boxes: Boxes) -> tuple[Bools, Bools]:
    """Which boxes lie inside a half-space, and which outside, touching allowed."""
    distance = surface.distance(boxes.middle)
    reach = surface.reach(boxes.half) * (1 - 1e-12)
    return distance <= -reach, distance >= reach
