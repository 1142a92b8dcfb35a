"""Sharp edges that a mesher has cut off are put back.

Two nodes on an edge can be joined across the cut by an edge between a node of either face, in
place of an edge between the two: no node can be moved so that the faces meet in their edge. The
tetrahedron that is missing in this notch is added, and the edge in it is exchanged.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from decomp.meshes.faces import faces_of, least_dihedral
from decomp.meshing.repairs.rings import best_over_ring, ring_around
from decomp.meshing.surface.cells import OUTSIDE
from decomp.vectors import Array, Bools, Ints

SOUND = 3.0
"""Degrees. Tetrahedra that are put in have no lesser dihedral angle."""

Locate = Callable[[Array], Ints]
"""Points (k, 3) -> the parts (k,) of cells that hold them."""


def filled(
    points: Array, tets: Ints, part: Ints, nodes: Ints, locate: Locate
) -> tuple[Ints, Ints] | None:
    """Fill the notches at nodes.

    Args:
        points: (n, 3).
        tets: (m, 4), positively oriented.
        part: (m,) the part of a cell that each is in.
        nodes: (k,) at which notches are looked for.
        locate: exactly.

    Returns:
        tetrahedra and their parts; None if there is no notch.
    """
    faces = faces_of(tets)
    hull = faces.triangles[faces.tets[:, 1] < 0]
    notches = _notches(hull[np.isin(hull, nodes).any(axis=1)])
    notches = notches[least_dihedral(points, notches) > 0]
    gone = np.zeros(len(tets), dtype=np.bool_)
    came: list[Ints] = []
    touched: set[int] = set()
    for notch in notches:
        around = _with(tets, notch[:2])
        if touched & set(tets[around].reshape(-1).tolist()) or _with(tets, notch[2:]).any():
            continue
        new = _exchanged(points, np.concatenate([tets[around], notch[None]]), notch)
        if not len(new) or (locate(points[new].mean(axis=1)) == OUTSIDE).any():
            continue
        gone |= around
        came.append(new)
        touched |= set(tets[around].reshape(-1).tolist())
    if not came:
        return None
    new = np.concatenate(came)
    at = locate(points[new].mean(axis=1))
    return np.concatenate([tets[~gone], new]), np.concatenate([part[~gone], at])


def _notches(hull: Ints) -> Ints:
    """The tetrahedra (k, 4) on every two triangles, which point outwards, with an edge in common.

    They are positive where the edge, which comes first, is in a notch.
    """
    edges = {(row[k - 2], row[k - 1]): row[k] for row in hull.tolist() for k in range(3)}
    rows = [(a, b, c, edges[b, a]) for (a, b), c in edges.items() if a < b and (b, a) in edges]
    return np.array(rows, dtype=np.int64).reshape(-1, 4)


def _with(tets: Ints, edge: Ints) -> Bools:
    """Which tetrahedra (m,) have an edge."""
    return np.asarray((tets == edge[0]).any(axis=1) & (tets == edge[1]).any(axis=1))


def _exchanged(points: Array, around: Ints, notch: Ints) -> Ints:
    """What comes in place of the tetrahedra around the edge of a notch; none if it is not sound."""
    a, b = notch[:2].tolist()
    ring = ring_around(around.tolist(), a, b)
    if ring is None:
        return np.empty((0, 4), dtype=np.int64)
    new = best_over_ring(points, a, b, ring)
    return new if least_dihedral(points, new).min() >= SOUND else new[:0]
