"""Tetrahedra with all four vertices on the boundary get a node inside.

Such elements have no free node: a solution that is prescribed on the boundary is constant in them.
"""

from __future__ import annotations

import numpy as np

from decomp.meshes.cutting import apart, halved
from decomp.meshes.faces import EDGES, NONE, TRIANGLE_EDGES, edges_of, faces_of
from decomp.vectors import Array, Ints, norm

SPLITTING_ROUNDS = 8


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
    for _ in range(SPLITTING_ROUNDS):
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
        chosen, free = apart(np.unique(best[cut]), of_tet, length)
        alone = bad[~cut & free[bad]]
        new = np.full(len(edges), NONE, dtype=np.int64)
        new[chosen] = len(points) + np.arange(len(chosen))
        centres = len(points) + len(chosen) + np.arange(len(alone))
        points = np.concatenate(
            [points, points[edges[chosen]].mean(axis=1), points[tets[alone]].mean(axis=1)]
        )
        left, parts = np.ones(len(tets), dtype=np.bool_), []
        left[alone] = False
        for k in range(4):
            parts.append(tets[alone])
            parts[-1][:, k] = centres
        cells, rows = halved(tets[left], EDGES, new[of_tet[left]])
        tets = np.concatenate([cells, *parts])
        label = np.concatenate([label[left][rows], *[label[alone]] * 4])
    return points, tets, label
