"""Edges whose tetrahedra, between its ends and a ring of vertices, give way to others.

Those over a triangulation of the ring, of which the best is Klincsek's optimum.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence

import numpy as np

from decomp.meshes.faces import least_dihedral
from decomp.vectors import Array, Ints

LARGEST_RING = 7
"""The most vertices of a ring."""
EVEN_ORDERS = [p for p in itertools.permutations(range(4)) if np.linalg.det(np.eye(4)[list(p)]) > 0]
"""Orders of a tetrahedron's vertices that leave it positive."""


def ring_around(tets: Sequence[Sequence[int]], a: int, b: int) -> list[int] | None:
    """The vertices around an edge in order, None if they do not close or are too many.

    Args:
        tets: all that have the edge, positively oriented.
        a, b: its ends.
    """
    after = {}
    for row in tets:
        order = next(p for p in EVEN_ORDERS if row[p[0]] == a and row[p[1]] == b)
        after[row[order[2]]] = row[order[3]]
    if not 3 <= len(tets) <= LARGEST_RING or len(after) != len(tets):
        return None
    ring = [next(iter(after))]
    while len(ring) < len(after):
        if after.get(ring[-1]) in (None, ring[0]):
            return None
        ring.append(after[ring[-1]])
    return ring if after.get(ring[-1]) == ring[0] else None


def best_over_ring(points: Array, a: int, b: int, ring: list[int]) -> Ints:
    """The best tetrahedra (2 (n - 2), 4) between an edge's ends and its ring of n vertices.

    Those at `a` come first. The least angle over part i..j of the ring is that over its best
    triangle i, k, j and the two parts that this leaves.
    """
    count = len(ring)
    triples = list(itertools.combinations(range(count), 3))
    corners = np.array(ring)[np.array(triples)]
    ends = np.broadcast_to([[a], [b]], (2, len(triples)))
    lower = np.column_stack([corners[:, [0, 2, 1]], ends[0]])
    upper = np.column_stack([corners, ends[1]])
    angle = np.minimum(least_dihedral(points, lower), least_dihedral(points, upper))
    number = {triple: k for k, triple in enumerate(triples)}
    best: dict[tuple[int, int], tuple[float, list[int]]] = {}
    for width in range(1, count):
        for i in range(count - width):
            j = i + width
            options: list[tuple[float, list[int]]] = [(180.0, [])] if width == 1 else []
            for k in range(i + 1, j):
                row = number[i, k, j]
                (low, left), (high, right) = best[i, k], best[k, j]
                options.append((min(low, high, float(angle[row])), [*left, row, *right]))
            best[i, j] = max(options, key=lambda option: option[0])
    rows = best[0, count - 1][1]
    return np.concatenate([lower[rows], upper[rows]])
