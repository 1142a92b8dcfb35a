"""Tetrahedra whose edges are halved; boundaries stay exact, and all stay conforming.

An edge is halved with all tetrahedra around it. To shorten a tetrahedron's longest edge the longest
edges of its neighbours are halved first (M.-C. Rivara, Algorithms for refining triangular grids
suitable for adaptive and multigrid techniques, 1984), so that shapes stay sound.
"""

from __future__ import annotations

import numpy as np

from decomp.complex.model import SIDES
from decomp.errors import GeometryError
from decomp.sampled.interior import Interior
from decomp.vectors import Array, Bools, Ints, norm

TET_EDGES = np.array([[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]])
BISECTING_ROUNDS = 200


class Bisected:
    """The tetrahedra of an `Interior` while they are refined.

    Attributes:
        points, tets, region, triangles, patches: as of `Interior`.
    """

    def __init__(self, given: Interior) -> None:
        self._plan, self._elements = given.plan, given.elements
        self.points, self.tets, self.region = given.points, given.tets, given.region
        self.triangles, self.patches = given.triangles, given.patches
        self._lines: dict[tuple[int, ...], list[int]] = {}
        for number, around in enumerate(given.plan.around_line):
            self._lines.setdefault(around, []).append(number)

    def edges(self) -> tuple[Ints, Ints]:
        """The distinct edges (e, 2), lower node first, and those of each tetrahedron (m, 6)."""
        keys, which = np.unique(
            self._keys(self.tets[:, TET_EDGES]).reshape(-1), return_inverse=True
        )
        low, high = np.divmod(keys, len(self.points))
        return np.stack([low, high], axis=1), which.reshape(-1, 6)

    def boundary_edges(self, edges: Ints) -> Bools:
        """Which of some edges (e, 2), lower node first, are edges of boundary triangles."""
        known = np.unique(self._keys(self.triangles[:, SIDES]))
        keys = edges[:, 0] * len(self.points) + edges[:, 1]
        return np.asarray(np.isin(keys, known))

    def line_edges(self, edges: Ints) -> Bools:
        """Which of some edges (e, 2) are parts of the boundary's lines, where patches meet."""
        own = self._keys(self.triangles[:, SIDES]).reshape(-1)
        pairs = np.unique(np.stack([own, np.repeat(self.patches, 3)], axis=1), axis=0)
        lines, many = np.unique(pairs[:, 0], return_counts=True)
        return np.asarray(np.isin(self._keys(edges), lines[many > 1]))

    def sagitta(self, edges: Ints) -> Array:
        """How far the middles of edges (e, 2) are off the boundary's lines; 0 for all others."""
        some = np.flatnonzero(self.line_edges(edges))
        result = np.zeros(len(edges))
        result[some] = norm(self._middles(edges[some]) - self.points[edges[some]].mean(axis=1))
        return result

    def shorten(self, wanted: Bools) -> None:
        """Halve edges until none of some tetrahedra (m,) is left whole.

        Those that neighbours make necessary are halved too.
        """
        left = np.array(wanted)
        for _ in range(BISECTING_ROUNDS):
            if not left.any():
                return
            edges, which = self.edges()
            length = norm(self.points[edges[:, 1]] - self.points[edges[:, 0]])
            rank = np.empty(len(edges), dtype=np.int64)
            rank[np.argsort(length, kind="stable")] = np.arange(len(edges))
            longest = which[np.arange(len(which)), rank[which].argmax(axis=1)]
            left = self._halve(edges, which, self._leading(which, longest, left), left)
        raise GeometryError("the refinement of tetrahedra does not end")

    def halve(self, edges: Ints, which: Ints, wanted: Bools, at: Array | None = None) -> None:
        """Cut some of the edges (e,) in two: of those that share a tetrahedron only one.

        Args:
            edges, which: of `edges()`.
            wanted: (e,) which to cut.
            at: (e, 3) where, in their middles if not given; for edges inside regions only.
        """
        rank = np.where(wanted, np.arange(len(wanted)) + 1, 0)
        best = rank[which].max(axis=1)
        beaten = np.zeros(len(wanted), dtype=np.bool_)
        beaten[which[(rank[which] > 0) & (rank[which] < best[:, None])]] = True
        none = np.zeros(len(self.tets), dtype=np.bool_)
        self._halve(edges, which, wanted & ~beaten, none, at)

    @staticmethod
    def _leading(which: Ints, longest: Ints, wanted: Bools) -> Bools:
        """The edges (e,) to be halved first: each the longest of all tetrahedra around it."""
        marked = np.array(wanted)
        while True:
            target = np.zeros(int(which.max()) + 1, dtype=np.bool_)
            target[longest[marked]] = True
            more = target[which].any(axis=1) & ~marked
            if not more.any():
                break
            marked |= more
        other = np.zeros(len(target), dtype=np.bool_)
        other[which[which != longest[:, None]]] = True
        return np.asarray(target & ~other)

    def _halve(
        self, edges: Ints, which: Ints, chosen: Bools, left: Bools, at: Array | None = None
    ) -> Bools:
        """Halve edges (e,) of which no two share a tetrahedron; what is left of a mask (m,)."""
        some = np.flatnonzero(chosen)
        middle = self._middles(edges[some]) if at is None else at[some]
        number = np.full(len(edges), -1, dtype=np.int64)
        number[some] = len(self.points) + np.arange(len(some))
        before = len(self.points)
        cut = np.flatnonzero((number[which] >= 0).any(axis=1))
        node = number[which[cut]].max(axis=1)
        ends = edges[which[cut, number[which[cut]].argmax(axis=1)]]
        one, two = self.tets[cut], np.array(self.tets[cut])
        first = np.where(one == ends[:, :1], node[:, None], one)
        second = np.where(two == ends[:, 1:], node[:, None], two)
        self._halve_triangles(edges[some], number[some], before)
        self.points = np.concatenate([self.points, middle])
        tets = np.array(self.tets)
        tets[cut] = first
        self.tets = np.concatenate([tets, second])
        self.region = np.concatenate([self.region, self.region[cut]])
        left = np.array(left)
        left[cut] = False
        return np.concatenate([left, np.zeros(len(cut), dtype=np.bool_)])

    def _halve_triangles(self, edges: Ints, node: Ints, count: int) -> None:
        keys = edges[:, 0] * count + edges[:, 1]
        order = np.argsort(keys)
        keys, node = keys[order], node[order]
        own = self._keys(self.triangles[:, SIDES])
        at = np.minimum(np.searchsorted(keys, own), len(keys) - 1)
        hit = keys[at] == own
        cut = np.flatnonzero(hit.any(axis=1))
        side = hit[cut].argmax(axis=1)
        middle = node[at[cut, side]]
        a, b, c = (self.triangles[cut, (side + k) % 3] for k in range(3))
        triangles = np.array(self.triangles)
        triangles[cut] = np.stack([a, middle, c], axis=1)
        self.triangles = np.concatenate([triangles, np.stack([middle, b, c], axis=1)])
        self.patches = np.concatenate([self.patches, self.patches[cut]])

    def _middles(self, edges: Ints) -> Array:
        """Where edges (k, 2) are halved; those on boundaries exactly on these."""
        middle: Array = self.points[edges].mean(axis=1)
        keys = edges[:, 0] * len(self.points) + edges[:, 1]
        own = self._keys(self.triangles[:, SIDES])
        rows, sides = np.nonzero(np.isin(own, keys))
        pairs = np.stack([own[rows, sides], self.patches[rows]], axis=1)
        found: dict[int, list[int]] = {}
        for key, patch in np.unique(pairs, axis=0).tolist():
            found.setdefault(key, []).append(patch)
        at = {int(key): row for row, key in enumerate(keys.tolist())}
        single = [(at[key], patches[0]) for key, patches in found.items() if len(patches) == 1]
        if single:
            row, patch = np.array(single, dtype=np.int64).T
            middle[row] = self._elements.place(self._elements.of_patch[patch], middle[row])
        for key, patches in found.items():
            if len(patches) > 1:
                middle[at[key]] = self._on_line(tuple(patches), middle[at[key]])
        return middle

    def _on_line(self, patches: tuple[int, ...], point: Array) -> Array:
        """A point on the nearest line along which patches meet."""
        if patches not in self._lines:
            raise GeometryError("tetrahedra do not follow the edge near {at}", at=point)
        lines = self._elements.of_line[self._lines[patches]]
        placed: Array = self._elements.place(lines, np.repeat(point[None], len(lines), axis=0))
        nearest = int(np.argmin(norm(placed - point)))
        return np.asarray(placed[nearest])

    def _keys(self, pairs: Ints) -> Ints:
        """A number for each pair of nodes (..., 2) in any order."""
        return np.asarray(pairs.min(axis=-1) * len(self.points) + pairs.max(axis=-1))
