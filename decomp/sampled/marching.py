"""The walls between differently labelled nodes of tetrahedra, as triangles.

A tetrahedron's edge between two labels carries a point, a triangle with three labels and a
tetrahedron with four labels one more each. They are shared, so that the walls around all nodes of
one label are closed by construction.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from decomp.vectors import Array, Ints

TETRAHEDRON = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
"""A positively oriented tetrahedron, from which the tables' orientations are taken."""

Vertex = tuple[int, ...]
"""Corners of a tetrahedron: two for the point on an edge, three on a triangle, four inside."""


def _quad(a: Vertex, b: Vertex, c: Vertex, d: Vertex) -> list[tuple[Vertex, ...]]:
    return [(a, b, c), (a, c, d)]


def _six() -> list[tuple[tuple[int, int], tuple[Vertex, ...]]]:
    """The walls of a tetrahedron with four labels."""
    found = []
    for i in range(4):
        for j in range(i + 1, 4):
            k, m = (x for x in range(4) if x not in (i, j))
            one, two = (tuple(sorted((i, j, x))) for x in (k, m))
            found += [((i, j), each) for each in _quad((i, j), one, (0, 1, 2, 3), two)]
    return found


Table = list[tuple[tuple[int, int], tuple[Vertex, ...]]]

TABLES: dict[tuple[int, ...], Table] = {
    (3, 1): [((0, 3), ((0, 3), (1, 3), (2, 3)))],
    (2, 2): [((0, 2), each) for each in _quad((0, 2), (0, 3), (1, 3), (1, 2))],
    (2, 1, 1): [
        ((2, 3), ((2, 3), (0, 2, 3), (1, 2, 3))),
        *(((0, 2), each) for each in _quad((0, 2), (1, 2), (1, 2, 3), (0, 2, 3))),
        *(((0, 3), each) for each in _quad((0, 3), (1, 3), (1, 2, 3), (0, 2, 3))),
    ],
    (1, 1, 1, 1): _six(),
}
"""By how many corners have each label, the most first: the corners between whose labels a wall
is, and its vertices."""


def _oriented(table: Table) -> Table:
    """A table whose triangles face the second label."""
    result = []
    for (i, j), triangle in table:
        a, b, c = (TETRAHEDRON[list(vertex)].mean(axis=0) for vertex in triangle)
        ahead = float(np.cross(b - a, c - a) @ (TETRAHEDRON[j] - TETRAHEDRON[i])) > 0
        result.append(((i, j), triangle if ahead else triangle[::-1]))
    return result


ORIENTED = {pattern: _oriented(table) for pattern, table in TABLES.items()}


@dataclass(frozen=True, eq=False)
class Walls:
    """Triangles between labels.

    Args:
        corners: (v, 4) the nodes that each vertex lies between, ascending, -1 for none: two on an
            edge, three on a triangle, four in a tetrahedron.
        triangles: (t, 3) vertices.
        between: (t, 2) the labels on both sides, lower first; normals point from it to the other.
        tet: (t,) the tetrahedron that each triangle is in.
    """

    corners: Ints
    triangles: Ints
    between: Ints
    tet: Ints


def walls(tets: Ints, label: Ints) -> Walls:
    """The walls in tetrahedra (m, 4), positively oriented, between the labels (n,) of nodes."""
    mixed = np.flatnonzero((label[tets] != label[tets[:, :1]]).any(axis=1))
    own = tets[mixed]
    at = label[own]
    same = (at[:, :, None] == at[:, None, :]).sum(axis=2)
    # the most frequent label first, then by label
    order = np.lexsort((own, at, -same), axis=1)
    own, at, same = (np.take_along_axis(x, order, axis=1) for x in (own, at, same))
    odd = _odd(order)
    corners, between, tet = [], [], []
    for pattern, table in ORIENTED.items():
        rows = np.flatnonzero(_has(at, same, pattern))
        for (i, j), triangle in table:
            turned = odd[rows] ^ (at[rows, i] > at[rows, j])
            made = np.full((len(rows), 3, 4), -1, dtype=np.int64)
            for k, vertex in enumerate(triangle):
                nodes = np.sort(own[rows][:, list(vertex)], axis=1)
                made[:, k, : len(vertex)] = nodes
            made[turned] = made[turned][:, ::-1]
            corners.append(made)
            between.append(np.sort(at[rows][:, [i, j]], axis=1))
            tet.append(mixed[rows])
    every = np.concatenate(corners).reshape(-1, 4)
    vertices, which = np.unique(every, axis=0, return_inverse=True)
    return Walls(vertices, which.reshape(-1, 3), np.concatenate(between), np.concatenate(tet))


def _has(at: Ints, same: Ints, pattern: tuple[int, ...]) -> Array:
    """Which rows of labels, sorted, have a pattern."""
    wanted = np.concatenate([[count] * count for count in pattern])
    found = (same == wanted).all(axis=1)
    if pattern == (2, 2):
        found &= at[:, 1] != at[:, 2]
    return np.asarray(found)


def _odd(order: Ints) -> Array:
    """Whether permutations (m, 4) are odd."""
    swaps = np.zeros(len(order), dtype=np.int64)
    for i in range(4):
        for j in range(i + 1, 4):
            swaps += order[:, i] > order[:, j]
    return np.asarray(swaps % 2 == 1)
