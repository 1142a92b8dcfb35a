"""Tetrahedra with small angles are exchanged for others of the same space with better ones.

An edge inside a cell can go: the tetrahedra around it, between its ends and a ring of vertices,
give way to the best ones over the ring (`rings`). A triangle inside a cell can go too: the two
tetrahedra at it give way to three around a new edge. Triangles on patches stay.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np

from decomp.meshes.faces import OPPOSITE, least_dihedral
from decomp.meshing.repairs.rings import best_over_ring, ring_around
from decomp.vectors import Array, Ints

WANTED = 12.0
"""Tetrahedra with dihedral angles (degrees) below this are exchanged, if it helps."""
ANGLE_GAIN = 0.2
"""By so many degrees the least angle must grow."""


@dataclass(frozen=True, eq=False)
class _Exchange:
    """What goes, what comes, and the least angle then."""

    old: tuple[int, ...]
    new: Ints
    angle: float


def flipped(points: Array, tets: Ints, part: Ints, kept: Ints) -> tuple[Ints, Ints] | None:
    """Exchange the tetrahedra with small angles that can be exchanged for better ones.

    Args:
        points: (n, 3).
        tets: (m, 4), positively oriented.
        part: (m,) of each; only tetrahedra of one part are exchanged for each other.
        kept: (k, 3) triangles that stay.

    Returns:
        tetrahedra and their parts; None if nothing could be exchanged.
    """
    bad = np.flatnonzero(least_dihedral(points, tets) < WANTED)
    near = np.isin(tets, tets[bad]).any(axis=1)
    patch = _Patch(points, tets[near], part[near], kept)
    if not patch.improve():
        return None
    return (
        np.concatenate([tets[~near], patch.tets]),
        np.concatenate([part[~near], patch.part]),
    )


class _Patch:
    """Some tetrahedra, all that have a vertex of one with small angles among them."""

    def __init__(self, points: Array, tets: Ints, part: Ints, kept: Ints) -> None:
        self._points = points
        self._tets = [tuple(row) for row in tets.tolist()]
        self._part = part.tolist()
        self._angle = least_dihedral(points, tets).tolist()
        self._alive = [True] * len(tets)
        self._at: dict[int, set[int]] = {}
        for number, row in enumerate(self._tets):
            for vertex in row:
                self._at.setdefault(vertex, set()).add(number)
        self._kept = {tuple(row) for row in np.sort(kept, axis=1).tolist()}
        self._kept_edges = {pair for row in self._kept for pair in itertools.combinations(row, 2)}

    @property
    def tets(self) -> Ints:
        """Those that are left."""
        rows = [row for row, alive in zip(self._tets, self._alive, strict=True) if alive]
        return np.array(rows, dtype=np.int64).reshape(-1, 4)

    @property
    def part(self) -> Ints:
        """Their parts."""
        return np.array(
            [part for part, alive in zip(self._part, self._alive, strict=True) if alive],
            dtype=np.int64,
        )

    def improve(self) -> int:
        """Exchange what can be exchanged, the worst first; how often it was done."""
        worst = [k for k in np.argsort(self._angle).tolist() if self._angle[k] < WANTED]
        count = 0
        for number in worst:
            if not self._alive[number]:
                continue
            found = [*self._without_edges(number), *self._without_faces(number)]
            if found:
                self._do(max(found, key=lambda exchange: exchange.angle))
                count += 1
        return count

    def _without_edges(self, number: int) -> list[_Exchange]:
        """What can come in place of the tetrahedra around each edge of one."""
        found = []
        for a, b in itertools.combinations(sorted(self._tets[number]), 2):
            around = self._at[a] & self._at[b]
            if (a, b) in self._kept_edges or not self._one_part(around):
                continue
            ring = ring_around([self._tets[k] for k in around], a, b)
            if ring is not None:
                found += self._judged(around, best_over_ring(self._points, a, b, ring))
        return found

    def _without_faces(self, number: int) -> list[_Exchange]:
        """What can come in place of one and its neighbour across each of its faces."""
        found = []
        for k, opposite in enumerate(OPPOSITE):
            a, b, c = (self._tets[number][j] for j in opposite)
            both = self._at[a] & self._at[b] & self._at[c]
            if tuple(sorted((a, b, c))) in self._kept or len(both) != 2:
                continue
            if not self._one_part(both):
                continue
            (other,) = both - {number}
            low = self._tets[number][k]
            (high,) = set(self._tets[other]) - {a, b, c}
            new = np.array([[low, high, a, b], [low, high, b, c], [low, high, c, a]])
            found += self._judged(both, new)
        return found

    def _one_part(self, numbers: set[int]) -> bool:
        return len({self._part[k] for k in numbers}) == 1

    def _judged(self, old: set[int], new: Ints) -> list[_Exchange]:
        """The exchange, if it makes the least angle greater.

        Where tetrahedra lie over each other, a triangle between new ones can be there already.
        """
        if not len(new) or self._is_there(old, new):
            return []
        angle = float(least_dihedral(self._points, new).min())
        if angle < min(self._angle[k] for k in old) + ANGLE_GAIN:
            return []
        return [_Exchange(tuple(old), new, angle)]

    def _is_there(self, old: set[int], new: Ints) -> bool:
        """Whether other tetrahedra than the old have a triangle between two new ones."""
        triangles = np.sort(new[:, OPPOSITE].reshape(-1, 3), axis=1)
        rows, count = np.unique(triangles, axis=0, return_counts=True)
        return any(
            self._at[a] & self._at[b] & self._at[c] - old for a, b, c in rows[count == 2].tolist()
        )

    def _do(self, exchange: _Exchange) -> None:
        part = self._part[exchange.old[0]]
        for number in exchange.old:
            self._alive[number] = False
            for vertex in self._tets[number]:
                self._at[vertex].discard(number)
        angles = least_dihedral(self._points, exchange.new).tolist()
        for row, angle in zip(exchange.new.tolist(), angles, strict=True):
            for vertex in row:
                self._at[vertex].add(len(self._tets))
            self._tets.append(tuple(row))
            self._part.append(part)
            self._angle.append(angle)
            self._alive.append(True)
