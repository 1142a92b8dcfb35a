"""Walls without width are contracted.

Where more than three sites meet along a curve, as along the middle of a square bar, labels make
walls between sites that only touch there. All their vertices are on the curve. So their edges are
contracted, the shortest first, to the end with all sites of the other, as long as that changes
nothing else: the two ends of an edge may
have no neighbours in common but those of the triangles at it (T. K. Dey, H. Edelsbrunner, S. Guha
and D. V. Nekhayev, Topology preserving edge contraction, 1999: the link condition).
"""

from __future__ import annotations

import heapq
from collections import defaultdict

import numpy as np

from decomp.sampled.placing import Placer
from decomp.vectors import Array, Bools, Ints, cross, norm

FLAT = 0.05
"""Walls whose triangles are no higher than this part of their longest sides can be contracted."""


def thin(
    points: Array, sites: list[tuple[int, ...]], triangles: Ints, placer: Placer
) -> Bools:
    """Which triangles (t, 3) have all vertices on one curve.

    That is where three sites or more meet, or the normal of a face at a vertex of it.
    """
    if not len(triangles):
        return np.zeros(0, dtype=np.bool_)
    corners = points[triangles]
    sides = norm(corners - np.roll(corners, 1, axis=1))
    double = norm(cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]))
    low = double <= FLAT * sides.max(axis=1) ** 2
    result = np.zeros(len(triangles), dtype=np.bool_)
    for row in np.flatnonzero(low).tolist():
        a, b, c = (set(sites[v]) for v in triangles[row].tolist())
        common = a & b & c
        result[row] = len(common) >= 3 or any(
            placer.on_normal(i, j) for i in common for j in common if i != j
        )
    return result


def contracted(
    points: Array,
    sites: list[tuple[int, ...]],
    triangles: Ints,
    fixed: Bools,
    wanted: Bools,
    sheet: Bools,
    short: Ints,
    least: float,
) -> Ints:
    """Which vertex each vertex (v,) has become one with.

    Args:
        points: (v, 3).
        sites: of each vertex.
        triangles: (t, 3) all of them.
        fixed: (v,) vertices that may not become one with other fixed ones, nor move.
        wanted: (t,) triangles that are to go.
        sheet: (t,) triangles that are skeleton, whose shape must stay the same too.
        short: (k, 2) edges that are to go.
        least: no shorter edge has a length; where one goes trim surfaces may come to lie on each
            other.
    """
    parent = np.arange(len(points))
    mesh = {k: set(row) for k, row in enumerate(triangles.tolist())}
    at: dict[int, set[int]] = defaultdict(set)
    for k, row in mesh.items():
        for vertex in row:
            at[vertex].add(k)
    skeleton = set(np.flatnonzero(sheet).tolist())
    goal = set(np.flatnonzero(wanted).tolist())
    heap: list[tuple[float, int, int]] = []

    def gap(a: int, b: int) -> float:
        length = float(norm(points[a] - points[b]))
        return length if length > least else 0.0

    def push(k: int) -> None:
        row = sorted(mesh[k])
        for i in range(3):
            a, b = row[i - 1], row[i]
            heapq.heappush(heap, (gap(a, b), min(a, b), max(a, b)))

    gone_edges = {(min(a, b), max(a, b)) for a, b in short.tolist()}
    for a, b in sorted(gone_edges):
        heapq.heappush(heap, (gap(a, b), a, b))
    for k in sorted(goal):
        push(k)
    while heap:
        length, a, b = heapq.heappop(heap)
        shared = at[a] & at[b]
        if parent[a] != a or parent[b] != b or (fixed[a] and fixed[b]):
            continue
        if not shared & goal and not (shared and (a, b) in gone_edges):
            continue
        if length > 0 and not _linked(mesh, at[a], at[b], a, b):
            continue
        if not _linked(mesh, at[a] & skeleton, at[b] & skeleton, a, b):
            continue
        first = fixed[a] or (not fixed[b] and len(sites[a]) >= len(sites[b]))
        kept, gone = (a, b) if first else (b, a)
        if not set(sites[gone]) <= set(sites[kept]):
            continue
        parent[gone] = kept
        for k in list(at[gone]):
            at[gone].discard(k)
            if k in shared:
                for v in mesh.pop(k):
                    at[v].discard(k)
                goal.discard(k)
                skeleton.discard(k)
            else:
                mesh[k] = {kept if v == gone else v for v in mesh[k]}
                at[kept].add(k)
        for k in at[kept] & goal:
            push(k)
        for v in {v for k in at[kept] for v in mesh[k]} - {kept}:
            # what was to become one with what is gone is to become one with what it has become
            if (min(v, gone), max(v, gone)) in gone_edges:
                pair = (min(v, kept), max(v, kept))
                gone_edges.add(pair)
                heapq.heappush(heap, (gap(v, kept), *pair))
    while True:
        above = parent[parent]
        if (above == parent).all():
            return parent
        parent = above


def _linked(mesh: dict[int, set[int]], one: set[int], two: set[int], a: int, b: int) -> bool:
    """Whether two vertices with given triangles can become one without any other change."""
    if not one or not two:
        return True
    if not one & two:
        return False
    around = {v for k in one & two for v in mesh[k]} - {a, b}
    near = {v for k in one for v in mesh[k]} & {v for k in two for v in mesh[k]}
    if near - {a, b} != around:
        return False
    facing = {frozenset(mesh[k] - {a}) for k in one - two}
    return not facing & {frozenset(mesh[k] - {b}) for k in two - one}
