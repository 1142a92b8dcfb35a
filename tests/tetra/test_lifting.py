"""The worst elements of a mesh are made better."""

from __future__ import annotations

import numpy as np

from decomp.tetra.faces import least_dihedral
from decomp.tetra.lifting import lifted
from decomp.vectors import Array, Bools, Ints


def lattice() -> tuple[Array, Ints, Bools]:
    """A 4 x 4 x 4 cube, six tetrahedra for each unit cube; which nodes are inside."""
    grid = np.stack(np.meshgrid(*[np.arange(5.0)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    low = np.stack(np.meshgrid(*[np.arange(4)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    tets = []
    for order in ((0, 1, 2), (1, 2, 0), (2, 0, 1), (0, 2, 1), (1, 0, 2), (2, 1, 0)):
        steps = np.cumsum([np.zeros(3, int), *(np.eye(3, dtype=int)[k] for k in order)], axis=0)
        corners = (low[:, None] + steps[None]) @ np.array([25, 5, 1])
        even = order in ((0, 1, 2), (1, 2, 0), (2, 0, 1))
        tets.append(corners if even else corners[:, [0, 2, 1, 3]])
    inside = ((grid > 0) & (grid < 4)).all(axis=1)
    return grid, np.concatenate(tets), inside


def test_a_squashed_element_is_mended_and_the_rest_stays() -> None:
    points, tets, inside = lattice()
    before = least_dihedral(points, tets).min()
    assert before > 40
    node = int(np.flatnonzero(inside)[13])
    points[node] += [0.97, 0, 0]
    assert least_dihedral(points, tets).min() < 3
    mended = lifted(points, tets, inside)
    assert least_dihedral(mended, tets).min() > 12
    moved = np.flatnonzero((mended != points).any(axis=1))
    assert node in moved
    assert inside[moved].all()
