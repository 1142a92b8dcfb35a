"""A tree of boxes over all sites of a region, for points that no leaf of the octree holds."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, sqrt

import numpy as np

from decomp.kernels.compiled import inner
from decomp.kernels.records import Record
from decomp.sites.measure import NONE, Hit, better, no_hit
from decomp.sites.occupancy import OccupancyTree
from decomp.sites.site_boxes import box_distance
from decomp.sites.site_table import SiteTable
from decomp.vectors import Array, Ints


@dataclass(frozen=True, eq=False)
class BoxTree(Record):
    """A binary tree in depth-first order.

    Args:
        boxes: of the nodes (n, 6), lower corner first.
        after: the first node (n,) behind a node's descendants. Its children are the next node and
            the one after that child.
        candidates: (n,), NONE for a node with children.
    """

    boxes: Array
    after: Ints
    candidates: Ints


def box_tree(sites: SiteTable) -> BoxTree:
    """Halve the candidates again and again across the longest side of their boxes."""
    boxes = np.concatenate([sites.boxes, np.tile(sites.vertices, 2)])
    centres = (boxes[:, :3] + boxes[:, 3:]) / 2
    rows: list[Array] = []
    after: list[int] = []
    candidates: list[int] = []
    stack = [np.arange(len(boxes))] if len(boxes) else []
    while stack:
        part = stack.pop()
        low, high = boxes[part, :3].min(axis=0), boxes[part, 3:].max(axis=0)
        rows.append(np.concatenate([low, high]))
        # a binary tree over k candidates has 2 k - 1 nodes
        after.append(len(after) + 2 * len(part) - 1)
        candidates.append(int(part[0]) if len(part) == 1 else NONE)
        if len(part) > 1:
            axis = int(np.argmax(np.ptp(centres[part], axis=0)))
            part = part[np.argsort(centres[part, axis], kind="stable")]
            stack += [part[len(part) // 2 :], part[: len(part) // 2]]
    return BoxTree(
        np.array(rows).reshape(-1, 6),
        np.array(after, dtype=np.int64),
        np.array(candidates, dtype=np.int64),
    )


@inner
def farthest(boxes: Array, k: int, x: float, y: float, z: float) -> float:
    """Distance to the farthest corner of a box."""
    dx = max(x - boxes[k, 0], boxes[k, 3] - x)
    dy = max(y - boxes[k, 1], boxes[k, 4] - y)
    dz = max(z - boxes[k, 2], boxes[k, 5] - z)
    return sqrt(dx * dx + dy * dy + dz * dz)


@inner
def nearest_in_boxes(
    occupancy: OccupancyTree,
    sites: SiteTable,
    tree: BoxTree,
    label: int,
    x: float,
    y: float,
    z: float,
) -> Hit:
    """The nearest candidate of all; a first descent gives a bound that prunes the rest."""
    hit, count = no_hit(), len(tree.after)
    if count == 0:
        return hit
    node, bound = 0, inf
    while tree.candidates[node] == NONE:
        # each box holds a piece of the boundary, so its farthest corner bounds the distance
        one, other = node + 1, tree.after[node + 1]
        reach = farthest(tree.boxes, one, x, y, z)
        node = one
        if farthest(tree.boxes, other, x, y, z) < reach:
            reach = farthest(tree.boxes, other, x, y, z)
            node = other
        bound = min(bound, reach)
    hit = better(occupancy, sites, label, tree.candidates[node], x, y, z, hit)
    node = 0
    while node < count:
        limit = min(bound, hit.least) + occupancy.rounding
        if box_distance(tree.boxes, node, x, y, z) > limit:
            node = tree.after[node]
            continue
        if tree.candidates[node] != NONE:
            hit = better(occupancy, sites, label, tree.candidates[node], x, y, z, hit)
        node += 1
    return hit
