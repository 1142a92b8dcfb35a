"""Simplices cut in two at edges, many edges at a time."""

from __future__ import annotations

import numpy as np

from decomp.vectors import Array, Bools, Ints


def apart(edges: Ints, of_tet: Ints, rank: Array) -> tuple[Ints, Bools]:
    """Of some edges those of which no tetrahedron has two, the highest of rank first.

    Args:
        edges: (k,) numbers of edges.
        of_tet: (m, 6) the edges of each tetrahedron.
        rank: (e,) of all edges.

    Returns:
        the edges, and whether each tetrahedron (m,) has none of them.
    """
    free = np.ones(len(of_tet), dtype=np.bool_)
    order = np.argsort(of_tet.reshape(-1), kind="stable")
    first = np.searchsorted(of_tet.reshape(-1)[order], np.arange(len(rank) + 1))
    chosen = []
    for edge in edges[np.argsort(-rank[edges])].tolist():
        around = order[first[edge] : first[edge + 1]] // of_tet.shape[1]
        if free[around].all():
            free[around] = False
            chosen.append(edge)
    return np.array(chosen, dtype=np.int64), free


def halved(cells: Ints, pairs: Ints, new: Ints) -> tuple[Ints, Ints]:
    """Cut simplices in two at nodes on their edges.

    Args:
        cells: (m, c).
        pairs: (k, 2) local numbers of the ends of each edge.
        new: (m, k) the node on each edge, below 0 for none; at most one of each simplex.

    Returns:
        simplices, oriented as they were, and for each the one that it is of.
    """
    rows, place = np.nonzero(new >= 0)
    kept = np.ones(len(cells), dtype=np.bool_)
    kept[rows] = False
    halves = []
    for end in pairs[place].T:
        half = cells[rows].copy()
        half[np.arange(len(rows)), end] = new[rows, place]
        halves.append(half)
    return np.concatenate([cells[kept], *halves]), np.concatenate(
        [np.flatnonzero(kept), rows, rows]
    )
