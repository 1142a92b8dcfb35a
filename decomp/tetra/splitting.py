"""Tetrahedra with all four vertices on the boundary get a node inside.

Such elements have no free node: a solution that is prescribed on the boundary is constant in them.
"""

from __future__ import annotations

import numpy as np

from decomp.tetra.faces import EDGES, NONE, edges_of, faces_of
from decomp.vectors import Array, Bools, Ints, norm

ROUNDS = 8
TRIANGLE_EDGES = np.array([[0, 1], [1, 2], [2, 0]])


def held(tets: Ints, region: Ints) -> tuple[Ints, Ints]:
    """The tetrahedra with all vertices on the boundary of their or another region.

    Args:
        tets: (m, 4).
        region: (m,) of each.

    Returns:
        their numbers, and the triangles (k, 3) of the boundary.
    """
    faces = faces_of(tets)
    other = np.where(faces.tets[:, 1] == NONE, -1, region[faces.tets[:, 1]])
    hull = faces.triangles[other != region[faces.tets[:, 0]]]
    on = np.zeros(int(tets.max()) + 1, dtype=np.bool_)
    on[hull] = True
    return np.flatnonzero(on[tets].all(axis=1)), hull


def freed(points: Array, tets: Ints, label: Ints, region: Ints) -> tuple[Array, Ints, Ints]:
    """Split edges, or else tetrahedra, until none has all its vertices on the boundary.

    Args:
        points: (n, 3).
        tets: (m, 4), positively oriented.
        label: (m,) the cell of each; parts of one keep it.
        region: (c,) of each cell.

    Returns:
        points, tetrahedra and labels.
    """
    for _ in range(ROUNDS):
        bad, hull = held(tets, region[label])
        if not len(bad):
            break
        edges, of_tet = edges_of(tets, EDGES)
        length = norm(points[edges[:, 1]] - points[edges[:, 0]])
        width = len(points)
        flat = np.unique(np.sort(hull[:, TRIANGLE_EDGES].reshape(-1, 2), axis=1), axis=0)
        inner = ~np.isin(edges[:, 0] * width + edges[:, 1], flat[:, 0] * width + flat[:, 1])
        rank = np.where(inner, length, -1.0)[of_tet[bad]]
        best = of_tet[bad, np.argmax(rank, axis=1)]
        cut = rank.max(axis=1) > 0
        chosen, free = _apart(np.unique(best[cut]), of_tet, length)
        alone = bad[~cut & free[bad]]
        points, tets, label = _split(points, tets, label, edges, of_tet, chosen, alone)
    return points, tets, label


def _apart(edges: Ints, of_tet: Ints, length: Array) -> tuple[Ints, Bools]:
    """Of some edges those of which no tetrahedron has two, longest first.

    Returns:
        the edges, and whether each tetrahedron has none of them.
    """
    free = np.ones(len(of_tet), dtype=np.bool_)
    order = np.argsort(of_tet.reshape(-1), kind="stable")
    first = np.searchsorted(of_tet.reshape(-1)[order], np.arange(len(length) + 1))
    chosen = []
    for edge in edges[np.argsort(-length[edges])].tolist():
        around = order[first[edge] : first[edge + 1]] // of_tet.shape[1]
        if free[around].all():
            free[around] = False
            chosen.append(edge)
    return np.array(chosen, dtype=np.int64), free


def _split(
    points: Array,
    tets: Ints,
    label: Ints,
    edges: Ints,
    of_tet: Ints,
    chosen: Ints,
    alone: Ints,
) -> tuple[Array, Ints, Ints]:
    """Split the tetrahedra around chosen edges in two, and those alone in four."""
    number = np.full(len(edges), -1, dtype=np.int64)
    number[chosen] = len(points) + np.arange(len(chosen))
    rows, place = np.nonzero(number[of_tet] >= 0)
    new = number[of_tet[rows, place]]
    ends = EDGES[place]
    one, two = tets[rows].copy(), tets[rows].copy()
    one[np.arange(len(rows)), ends[:, 0]] = new
    two[np.arange(len(rows)), ends[:, 1]] = new
    centres = len(points) + len(chosen) + np.arange(len(alone))
    parts = []
    for k in range(4):
        part = tets[alone].copy()
        part[:, k] = centres
        parts.append(part)
    kept = np.ones(len(tets), dtype=np.bool_)
    kept[rows] = False
    kept[alone] = False
    middles = points[edges[chosen]].mean(axis=1)
    return (
        np.concatenate([points, middles, points[tets[alone]].mean(axis=1)]),
        np.concatenate([tets[kept], one, two, *parts]),
        np.concatenate([label[kept], label[rows], label[rows], *[label[alone]] * 4]),
    )
