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
from collections.abc import Callable

import numpy as np

from decomp.sampled.placing import Placer
from decomp.vectors import Array, Bools, Ints, cross, norm

FLAT_WALL = 0.15
"""Walls whose triangles are no higher than this part of their longest sides can be contracted."""


def thin(points: Array, sites: list[tuple[int, ...]], triangles: Ints, placer: Placer) -> Bools:
    """Which triangles (t, 3) have all vertices on one curve.

    That is where three sites or more meet, or the normal of a face at a vertex of it.
    """
    if not len(triangles):
        return np.zeros(0, dtype=np.bool_)
    corners = points[triangles]
    sides = norm(corners - np.roll(corners, 1, axis=1))
    double = norm(cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]))
    low = double <= FLAT_WALL * sides.max(axis=1) ** 2
    result = np.zeros(len(triangles), dtype=np.bool_)
    for row in np.flatnonzero(low).tolist():
        a, b, c = (set(sites[v]) for v in triangles[row].tolist())
        common = a & b & c
        result[row] = len(common) >= 3 or any(
            placer.normals.on_normal(i, j) for i in common for j in common if i != j
        )
    return result


Holds = Callable[[int, int, int, bool], bool]


class Contractor:
    """Contracts edges of a complex.

    Args:
        points: (v, 3).
        sites: of each vertex; where vertices at one place become one their sites are joined.
        triangles: (t, 3) all of them.
        fixed: (v,) vertices that may not become one with other fixed ones, nor move.
        wanted: (t,) triangles that are to go.
        sheet: (t,) triangles that are skeleton, whose shape must stay the same too.
        short: (k, 2) edges that are to go.
        least: no shorter edge has a length; where one goes trim surfaces may come to lie on each
            other.
        between: (t, 2) sites on both sides of each triangle.
        holds: whether a vertex lies on a wall between two sites; also told if it is a sheet.
    """

    def __init__(
        self,
        points: Array,
        sites: list[tuple[int, ...]],
        triangles: Ints,
        fixed: Bools,
        wanted: Bools,
        sheet: Bools,
        short: Ints,
        least: float,
        between: Ints,
        holds: Holds,
    ) -> None:
        self._points, self._sites, self._fixed, self._least = points, sites, fixed, least
        self._parent = np.arange(len(points))
        self._mesh = {k: set(row) for k, row in enumerate(triangles.tolist())}
        self._at: dict[int, set[int]] = defaultdict(set)
        for k, row in self._mesh.items():
            for vertex in row:
                self._at[vertex].add(k)
        self._skeleton = set(np.flatnonzero(sheet).tolist())
        self._goal = set(np.flatnonzero(wanted).tolist())
        self._between = [(int(a), int(b)) for a, b in between]
        self._sheet, self._holds = sheet, holds
        self._short = {(min(a, b), max(a, b)) for a, b in short.tolist()}

    def run(self) -> Ints:
        """Contract all that can be; which vertex each vertex (v,) has become one with."""
        while True:
            heap = [(self._gap(*pair), *pair) for pair in self._pairs()]
            heapq.heapify(heap)
            done = 0
            while heap:
                length, a, b = heapq.heappop(heap)
                if self._parent[a] == a and self._parent[b] == b:
                    done += self._contract(a, b, length)
            if not done and not sum(self._weld(own) for own in self._clusters()):
                break
        while True:
            above = self._parent[self._parent]
            if (above == self._parent).all():
                return above
            self._parent = above

    def _pairs(self) -> set[tuple[int, int]]:
        """The edges that are to go now."""
        found = {pair for pair in self._short if self._at[pair[0]] & self._at[pair[1]]}
        for k in self._goal:
            a, b, c = sorted(self._mesh[k])
            found |= {(a, b), (a, c), (b, c)}
        return found

    def _clusters(self) -> list[list[int]]:
        """Vertices at one place that edges join."""
        group: dict[int, set[int]] = {}
        for a, b in self._short:
            if self._at[a] & self._at[b] and not self._gap(a, b):
                both = group.get(a, {a}) | group.get(b, {b})
                for vertex in both:
                    group[vertex] = both
        return [sorted(own) for own in {min(each): each for each in group.values()}.values()]

    def _weld(self, cluster: list[int]) -> bool:
        """Make vertices at one place one, if that keeps the skeleton's Euler characteristic.

        They can hang together in a way in which no single edge may go.
        """
        fixed = [vertex for vertex in cluster if self._fixed[vertex]]
        if len(fixed) > 1:
            return False
        kept = fixed[0] if fixed else max(cluster, key=lambda v: (len(self._sites[v]), -v))
        around = {k for vertex in cluster for k in self._at[vertex]}
        mesh = {k: {kept if v in cluster else v for v in self._mesh[k]} for k in around}
        old = [self._mesh[k] for k in around & self._skeleton]
        if _euler(old) != _euler([mesh[k] for k in around & self._skeleton]):
            return False
        for k, row in mesh.items():
            for vertex in self._mesh[k]:
                self._at[vertex].discard(k)
            if len(row) < 3:
                del self._mesh[k]
                self._goal.discard(k)
                self._skeleton.discard(k)
                continue
            self._mesh[k] = row
            for vertex in row:
                self._at[vertex].add(k)
        self._sites[kept] = tuple(sorted({site for v in cluster for site in self._sites[v]}))
        for vertex in set(cluster) - {kept}:
            self._parent[vertex] = kept
            self._renamed(vertex, kept)
        return True

    def _renamed(self, gone: int, kept: int) -> None:
        """What was to become one with what is gone is to become one with what that has become."""
        for pair in [pair for pair in self._short if gone in pair]:
            self._short.discard(pair)
            other = pair[0] if pair[1] == gone else pair[1]
            if other != kept:
                self._short.add((min(other, kept), max(other, kept)))

    def _gap(self, a: int, b: int) -> float:
        length = float(norm(self._points[a] - self._points[b]))
        return length if length > self._least else 0.0

    def _contract(self, a: int, b: int, length: float) -> bool:
        """Contract an edge if it is still one, and that changes nothing else."""
        at, sites = self._at, self._sites
        shared = at[a] & at[b]
        if not shared or (self._fixed[a] and self._fixed[b]):
            return False
        if not shared & self._goal and (a, b) not in self._short:
            return False
        if length > 0 and not self._linked(at[a], at[b], a, b):
            return False
        if not self._linked(at[a] & self._skeleton, at[b] & self._skeleton, a, b):
            return False
        first = self._fixed[a] or (not self._fixed[b] and len(sites[a]) >= len(sites[b]))
        kept, gone = (a, b) if first else (b, a)
        if length > 0 and not self._serves(kept, gone):
            kept, gone = gone, kept
            if self._fixed[gone] or not self._serves(kept, gone):
                return False
        more = sites[gone] if length <= 0 else [s for w in self._walls(kept, gone) for s in w[:2]]
        sites[kept] = tuple(sorted({*sites[kept], *more}))
        self._parent[gone] = kept
        for k in list(at[gone]):
            at[gone].discard(k)
            if k in shared:
                for v in self._mesh.pop(k):
                    at[v].discard(k)
                self._goal.discard(k)
                self._skeleton.discard(k)
            else:
                self._mesh[k] = {kept if v == gone else v for v in self._mesh[k]}
                at[kept].add(k)
        self._renamed(gone, kept)
        return True

    def _serves(self, kept: int, gone: int) -> bool:
        """Whether a vertex lies on all walls that are left at another one."""
        if set(self._sites[gone]) <= set(self._sites[kept]):
            return True
        return all(self._holds(kept, *wall) for wall in self._walls(kept, gone))

    def _walls(self, kept: int, gone: int) -> set[tuple[int, int, bool]]:
        """The walls at a vertex that are left when it has become one with another."""
        left = self._at[gone] - self._at[kept]
        return {(*self._between[k], bool(self._sheet[k])) for k in left}

    def _linked(self, one: set[int], two: set[int], a: int, b: int) -> bool:
        """Whether two vertices with given triangles can become one without any other change."""
        if not one or not two:
            return True
        if not one & two:
            return False
        mesh = self._mesh
        around = {v for k in one & two for v in mesh[k]} - {a, b}
        near = {v for k in one for v in mesh[k]} & {v for k in two for v in mesh[k]}
        if near - {a, b} != around:
            return False
        facing = {frozenset(mesh[k] - {a}) for k in one - two}
        return not facing & {frozenset(mesh[k] - {b}) for k in two - one}


def _euler(triangles: list[set[int]]) -> int:
    """Euler characteristic of triangles with their sides and corners; some may be flat ones."""
    every = {frozenset(row) for row in triangles}
    for row in list(every):
        corners = sorted(row)
        every |= {frozenset((v,)) for v in corners}
        every |= {frozenset((corners[i - 1], corners[i])) for i in range(len(corners))}
    return sum((-1) ** (len(simplex) - 1) for simplex in every)
