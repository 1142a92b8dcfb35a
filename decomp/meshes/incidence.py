"""Which triangle is which face of which tetrahedron."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from decomp.vectors import Array, Ints

FACES: Ints = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]])
"""The faces of a positively oriented tetrahedron, counterclockwise seen from outside."""

MIDDLES: Ints = np.array([[6, 5, 4], [4, 9, 7], [5, 8, 9], [7, 8, 6]])
"""The middle nodes of these faces in quadratic tetrahedra, on edges 01, 12, 20 of each."""


def row_keys(rows: Ints) -> Ints:
    """One number (n,) for each row (n, c) of indices, the same for rows of the same indices.

    The order within a row does not count.
    """
    ordered = np.sort(rows, axis=1)
    keys = ordered[:, 0].astype(np.int64)
    for column in range(1, rows.shape[1]):
        top = int(ordered[:, column].max(initial=0)) + 1
        if column > 1:
            keys = np.unique(keys, return_inverse=True)[1].astype(np.int64)
        keys = keys * top + ordered[:, column]
    return keys


def odd(rows: Ints) -> Ints:
    """1 for rows (n, 3) that an odd permutation sorts, else 0."""
    swaps = sum((rows[:, i] > rows[:, j]).astype(np.int64) for i, j in ((0, 1), (0, 2), (1, 2)))
    return np.asarray(swaps % 2, dtype=np.int64)


def faces_of(tets: Ints) -> Ints:
    """Corners (4m, 3) of the faces of tetrahedra (m, 4 or more); face f of tet t is row 4t + f."""
    return np.asarray(tets[:, FACES].reshape(-1, 3))


@dataclass(frozen=True, eq=False)
class Incidence:
    """Where triangles lie on tetrahedra: one row for each pair, by ascending triangle.

    Args:
        triangle: index (p,).
        face: row (p,) of `faces_of`.
        outward: (p,) whether the triangle's normal points out of the tetrahedron.
    """

    triangle: Ints
    face: Ints
    outward: Ints

    @property
    def tet(self) -> Ints:
        """The tetrahedron (p,)."""
        return self.face // 4


def incidence(triangles: Ints, tets: Ints) -> Incidence:
    """Find triangles (k, 3 or more) among the faces of tetrahedra (m, 4 or more)."""
    faces = faces_of(tets)
    corners = triangles[:, :3]
    keys = row_keys(np.concatenate([corners, faces]))
    own, known = keys[: len(corners)], keys[len(corners) :]
    order = np.argsort(known, kind="stable")
    first = np.searchsorted(known[order], own, side="left")
    count = np.searchsorted(known[order], own, side="right") - first
    triangle = np.repeat(np.arange(len(corners)), count)
    ahead = np.arange(len(triangle)) - np.repeat(np.cumsum(count) - count, count)
    face = order[np.repeat(first, count) + ahead]
    same = odd(corners)[triangle] == odd(faces)[face]
    return Incidence(triangle, face, same.astype(np.int64))


def box(points: Array) -> Array:
    """Corners (2, 3) of the axis-parallel box around points (n, 3)."""
    return np.array([points.min(axis=0), points.max(axis=0)])
