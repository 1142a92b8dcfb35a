"""Long triangles cut up before TetWild gets them.

TetWild begins with the Delaunay tetrahedra of all vertices and inserts the triangles into it. Long
ones cut through many tetrahedra and leave slivers, which take it passes to mend; short ones are
faces of the Delaunay tetrahedra already.

Creases, where triangles meet at an angle or more than two of them meet, are cut first. What is
plane between them, such as a strip of a cylinder, is kept Delaunay by flips, so that it becomes a
ladder: cut at their diagonals its slender triangles would give others that are as slender.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from decomp.complex.model import OPPOSITE_SIDES
from decomp.meshes.faces import edges_of
from decomp.vectors import Array, Bools, Ints, cross, dot, norm

LADDER = 1.5
"""Edges that are no creases may be so many times as long as asked: a ladder has diagonals."""
SHAKEN = 1e-3
"""Edges are cut off the right place by up to this part of them, at random: regular vertices lie on
common spheres, between which Delaunay tetrahedra may be flat, and TetWild inserts nothing there."""
FLIPPING_SWEEPS = 2
"""How often flips are looked for after each round of cuts; what is left comes with the next."""
STRICT = 1e-6
"""Flips are made where opposite angles exceed a half turn by this sine."""


def subdivided(
    points: Array, triangles: Ints, longest: Callable[[Array], Array], flat: float
) -> tuple[Array, Ints]:
    """Cut edges in two until none is longer than asked; neighbours stay conforming.

    Args:
        points: (n, 3).
        triangles: (m, 3).
        longest: middles of edges (k, 3) -> lengths (k,), positive.
        flat: triangles no farther off each other's planes are one.
    """
    while True:
        for _ in range(FLIPPING_SWEEPS):
            net = _Net(points, triangles, flat)
            triangles = net.flipped()
        net = _Net(points, triangles, flat)
        cut, parts = net.cuts(longest)
        if not len(cut):
            return points, triangles
        points, triangles = net.divided(cut, parts)


class _Net:
    """Triangles and their edges.

    Args:
        points: (n, 3).
        triangles: (m, 3).
        flat: see `subdivided`.
    """

    def __init__(self, points: Array, triangles: Ints, flat: float) -> None:
        self._points, self._triangles = points, triangles
        self._edges, self._sides = edges_of(triangles, OPPOSITE_SIDES)
        count = len(self._edges)
        order = np.argsort(self._sides.ravel(), kind="stable")
        self._number = np.bincount(self._sides.ravel(), minlength=count)
        start = np.concatenate([[0], np.cumsum(self._number)[:-1]])
        pair = np.flatnonzero(self._number == 2)
        both = np.stack([order[start[pair]], order[start[pair] + 1]], axis=1)
        self._pair, self._tri, self._corner = pair, both // 3, both % 3
        self._plane = np.zeros(count, dtype=np.bool_)
        self._plane[pair] = self._are_plane(flat)

    def _are_plane(self, flat: float) -> Bools:
        """Which pairs of triangles (k,) lie in one plane, on both sides of their edge."""
        tri, corner = self._triangles[self._tri], self._corner
        rows = np.arange(len(tri))
        apex = self._points[tri[rows, 0, corner[:, 0]]], self._points[tri[rows, 1, corner[:, 1]]]
        a, b = np.moveaxis(self._points[self._edges[self._pair]], 1, 0)
        one, two = cross(b - a, apex[0] - a), cross(b - a, apex[1] - a)
        areas = norm(one), norm(two)
        off = np.abs(dot(one, apex[1] - a)), np.abs(dot(two, apex[0] - a))
        good = (areas[0] > 0) & (areas[1] > 0)
        near = (off[0] <= flat * areas[0]) & (off[1] <= flat * areas[1])
        return np.asarray(good & near & (dot(one, two) < 0))

    def cuts(self, longest: Callable[[Array], Array]) -> tuple[Ints, Ints]:
        """Edges (k,) to be cut now, and into how many parts (k,) in the end.

        They are the longest of all their triangles, creases before others.
        """
        ends = self._points[self._edges]
        length = norm(ends[:, 1] - ends[:, 0])
        limit = np.where(self._plane, LADDER, 1.0) * longest(ends.mean(axis=1))
        long = length > limit
        keys = np.lexsort((length, long, long & ~self._plane))
        rank = np.empty(len(length), dtype=np.int64)
        rank[keys] = np.arange(len(length))
        first = self._first(rank)
        cut = np.flatnonzero(long & (np.bincount(first, minlength=len(long)) == self._number))
        return cut, np.ceil(length[cut] / limit[cut]).astype(np.int64)

    def _first(self, rank: Ints) -> Ints:
        """The edge (m,) of highest rank of each triangle."""
        local = np.argmax(rank[self._sides], axis=1)
        return np.asarray(self._sides[np.arange(len(local)), local])

    def divided(self, cut: Ints, parts: Ints) -> tuple[Array, Ints]:
        """Points and triangles with edges cut in two, no two of one triangle.

        About half of an edge's parts come to lie on each side.
        """
        new = np.full(len(self._edges), -1, dtype=np.int64)
        new[cut] = len(self._points) + np.arange(len(cut))
        a, b = np.moveaxis(self._points[self._edges[cut]], 1, 0)
        shaken = np.random.default_rng(len(cut)).uniform(-SHAKEN, SHAKEN, size=len(cut))
        part = (parts // 2 / parts + shaken)[:, None]
        points = np.concatenate([self._points, a + part * (b - a)])
        rows, local = np.nonzero(new[self._sides] >= 0)
        a, b, c = (self._triangles[rows, (local + k) % 3] for k in range(3))
        there = new[self._sides[rows, local]]
        left = np.ones(len(self._triangles), dtype=np.bool_)
        left[rows] = False
        halves = np.stack([a, b, there], axis=1), np.stack([a, there, c], axis=1)
        return points, np.concatenate([self._triangles[left], *halves])

    def flipped(self) -> Ints:
        """The triangles with edges in planes flipped where that makes them Delaunay (Lawson 1977).

        No two flips share a triangle.
        """
        flip = self._flips()
        result = self._triangles.copy()
        (one, two), (i, j) = self._tri[flip].T, self._corner[flip].T
        a, b, c = (self._triangles[one, (i + k) % 3] for k in range(3))
        d = self._triangles[two, j]
        result[one], result[two] = np.stack([a, b, d], axis=1), np.stack([a, d, c], axis=1)
        return result

    def _flips(self) -> Ints:
        """The pairs of triangles (k,) in which opposite angles exceed a half turn, some of them."""
        pairs = np.flatnonzero(self._plane[self._pair])
        sine, cosine = np.zeros((2, len(pairs))), np.zeros((2, len(pairs)))
        for k in range(2):
            tri = self._triangles[self._tri[pairs, k]]
            at = (self._corner[pairs, k][:, None] + np.arange(3)) % 3
            a, b, c = np.moveaxis(self._points[np.take_along_axis(tri, at, axis=1)], 1, 0)
            sine[k], cosine[k] = norm(cross(b - a, c - a)), dot(b - a, c - a)
        both = sine[0] * cosine[1] + cosine[0] * sine[1]
        wanted = pairs[both < -STRICT * np.prod(np.hypot(sine, cosine), axis=0)]
        order = np.random.default_rng(len(wanted)).permutation(len(wanted))
        best = np.full(len(self._triangles), -1, dtype=np.int64)
        np.maximum.at(best, self._tri[wanted], order[:, None])
        return np.asarray(wanted[(best[self._tri[wanted]] == order[:, None]).all(axis=1)])
