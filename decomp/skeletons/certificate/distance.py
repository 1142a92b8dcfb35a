"""Distance from many points to many triangles, exact, by a tree of boxes.

Segments and single points are triangles whose corners coincide.
"""

from __future__ import annotations

from math import sqrt
from typing import Any, NamedTuple

import numpy as np
from scipy.spatial import cKDTree  # type: ignore[import-untyped]

from decomp.kernels.compiled import inlined, scalar
from decomp.vectors import Array, Ints

LEAF = 8


class TriangleTree(NamedTuple):
    """A binary tree of boxes in depth-first order.

    Args:
        boxes: of the nodes (n, 6), lower corner first.
        after: the first node (n,) behind a node's descendants.
        first, last: range of triangles of a leaf (n,), empty for an inner node.
        corners: of the triangles (m, 9), in the leaves' order.
        seeds: a tree over the corners, for a first bound.
    """

    boxes: Array
    after: Ints
    first: Ints
    last: Ints
    corners: Array
    seeds: Any


def triangle_tree(corners: Array) -> TriangleTree:
    """Halve triangles with corners (m, 3, 3) again and again across the longest side."""
    low, high = corners.min(axis=1), corners.max(axis=1)
    centres = (low + high) / 2
    boxes: list[Array] = []
    ends: list[tuple[int, int]] = []
    order: list[Ints] = []
    placed = 0
    # a node is known by its triangles; None marks where a node's descendants end
    stack: list[Ints | int] = [np.arange(len(corners))] if len(corners) else []
    after: list[int] = []
    while stack:
        part = stack.pop()
        if isinstance(part, int):
            after[part] = len(after)
            continue
        boxes.append(np.concatenate([low[part].min(axis=0), high[part].max(axis=0)]))
        after.append(len(after) + 1)
        if len(part) <= LEAF:
            ends.append((placed, placed + len(part)))
            order.append(part)
            placed += len(part)
            continue
        ends.append((0, 0))
        axis = int(np.argmax(np.ptp(centres[part], axis=0)))
        half = len(part) // 2
        part = part[np.argpartition(centres[part, axis], half)]
        stack += [len(after) - 1, part[half:], part[:half]]
    sequence = np.concatenate([np.empty(0, dtype=np.int64), *order])
    first, last = np.array(ends, dtype=np.int64).reshape(-1, 2).T.copy()
    return TriangleTree(
        np.array(boxes).reshape(-1, 6),
        np.array(after, dtype=np.int64),
        first,
        last,
        np.ascontiguousarray(corners[sequence].reshape(-1, 9)),
        cKDTree(corners.reshape(-1, 3)),
    )


def triangle_distance(tree: TriangleTree, points: Array) -> Array:
    """Distance (k,) from points (k, 3) to the nearest triangle; infinite if there is none."""
    if not len(tree.corners):
        return np.full(len(points), np.inf)
    bound, _ = tree.seeds.query(points)
    result = np.asarray(bound, dtype=np.float64)
    _search(tree.boxes, tree.after, tree.first, tree.last, tree.corners, points, result)
    return result


@inlined
def _side(ax: float, ay: float, az: float, bx: float, by: float, bz: float) -> float:
    """Squared distance from the origin to a segment."""
    ux, uy, uz = bx - ax, by - ay, bz - az
    square = ux * ux + uy * uy + uz * uz
    t = 0.0
    if square > 0.0:
        t = min(1.0, max(0.0, -(ax * ux + ay * uy + az * uz) / square))
    px, py, pz = ax + t * ux, ay + t * uy, az + t * uz
    return px * px + py * py + pz * pz


@inlined
def _square(corners: Array, k: int, x: float, y: float, z: float) -> float:
    """Squared distance from a point to triangle k: to its plane if it is above it, else to a side.

    With a degenerate triangle the point is never above it, and the sides decide.
    """
    ax, ay, az = corners[k, 0] - x, corners[k, 1] - y, corners[k, 2] - z
    bx, by, bz = corners[k, 3] - x, corners[k, 4] - y, corners[k, 5] - z
    cx, cy, cz = corners[k, 6] - x, corners[k, 7] - y, corners[k, 8] - z
    ux, uy, uz = bx - ax, by - ay, bz - az
    vx, vy, vz = cx - ax, cy - ay, cz - az
    nx, ny, nz = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
    square = nx * nx + ny * ny + nz * nz
    # n . (a x b) is positive when the point sees side ab from within, as it does for a and c
    ab = nx * (ay * bz - az * by) + ny * (az * bx - ax * bz) + nz * (ax * by - ay * bx)
    bc = nx * (by * cz - bz * cy) + ny * (bz * cx - bx * cz) + nz * (bx * cy - by * cx)
    ca = nx * (cy * az - cz * ay) + ny * (cz * ax - cx * az) + nz * (cx * ay - cy * ax)
    if square > 0.0 and ab >= 0.0 and bc >= 0.0 and ca >= 0.0:
        height = nx * ax + ny * ay + nz * az
        return float(height * height / square)
    one = _side(ax, ay, az, bx, by, bz)
    two = _side(bx, by, bz, cx, cy, cz)
    return min(one, two, _side(cx, cy, cz, ax, ay, az))


@scalar
def _search(
    boxes: Array, after: Ints, first: Ints, last: Ints, corners: Array, points: Array, best: Array
) -> None:
    """Lower the bounds `best` (k,) to the distances."""
    for i in range(len(points)):
        x, y, z = points[i, 0], points[i, 1], points[i, 2]
        least = best[i] * best[i]
        node = 0
        while node < len(after):
            dx = max(boxes[node, 0] - x, 0.0, x - boxes[node, 3])
            dy = max(boxes[node, 1] - y, 0.0, y - boxes[node, 4])
            dz = max(boxes[node, 2] - z, 0.0, z - boxes[node, 5])
            if dx * dx + dy * dy + dz * dz > least:
                node = after[node]
                continue
            for k in range(first[node], last[node]):
                least = min(least, _square(corners, k, x, y, z))
            node += 1
        best[i] = sqrt(least)
