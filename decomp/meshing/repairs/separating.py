"""Sheets that come down on a face short of the edge that they should reach are lifted off it.

At a sharp edge such a mesher can end a sheet many tolerances before the edge, at nodes of a face.
All that is close to such a node belongs to the cell of its face. So the tetrahedra of other cells
at it are cut where the exact sheet passes, and their parts next to it are given to the cell of the
face.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from decomp.meshing.surface.cells import OUTSIDE
from decomp.vectors import Array, Ints

ALONG_EDGE = np.linspace(0, 1, 65)[1:-1]
"""Where along an edge its passage through the sheet is looked for."""
CUT_NEAREST, CUT_FARTHEST = 0.3, 0.7
"""An edge is cut between these parts of it, seen from the node."""

Locate = Callable[[Array], Ints]
"""Points (k, 3) -> the parts (k,) of cells that hold them."""


def separated(
    points: Array, tets: Ints, part: Ints, nodes: Ints, owner: Ints, locate: Locate
) -> tuple[Array, Ints, Ints] | None:
    """Give the surroundings of nodes to the cells of their faces.

    Args:
        points: (n, 3).
        tets: (m, 4), positively oriented.
        part: (m,) the part of a cell that each is in.
        nodes: (k,) nodes of faces.
        owner: (k,) the part that the face of each belongs to, OUTSIDE for nodes to be left alone.
        locate: exactly.

    Returns:
        points, tetrahedra and their parts; None if nothing had to change.
    """
    changed = False
    touched: set[int] = set()
    for node, own in zip(nodes.tolist(), owner.tolist(), strict=True):
        star = np.flatnonzero((tets == node).any(axis=1))
        wrong = star[part[star] != own]
        around = set(tets[star].reshape(-1).tolist())
        if own == OUTSIDE or not len(wrong) or touched & around:
            continue
        touching = np.unique(tets[part == own])
        others = np.setdiff1d(np.unique(tets[wrong]), np.append(touching, node))
        for other in others.tolist():
            cut = _passage(points[node], points[other], own, locate)
            if cut is not None:
                points, tets, part = _split(points, tets, part, node, other, cut)
        part = np.where((tets == node).any(axis=1), own, part)
        touched |= around
        changed = True
    return (points, tets, part) if changed else None


def _passage(node: Array, other: Array, own: int, locate: Locate) -> Array | None:
    """The point (3,) at which an edge leaves the part of its first end, None if it does not."""
    found = locate(node + ALONG_EDGE[:, None] * (other - node))
    held = (found == own) | (found == OUTSIDE)  # on the node's own face
    if held.all():
        return None
    share = min(max(float(ALONG_EDGE[int(np.argmin(held))]), CUT_NEAREST), CUT_FARTHEST)
    return np.asarray(node + share * (other - node))


def _split(
    points: Array, tets: Ints, part: Ints, one: int, two: int, place: Array
) -> tuple[Array, Ints, Ints]:
    """Split the tetrahedra around an edge at a place."""
    new = len(points)
    around = (tets == one).any(axis=1) & (tets == two).any(axis=1)
    halves = [np.where(tets[around] == end, new, tets[around]) for end in (two, one)]
    return (
        np.concatenate([points, place[None]]),
        np.concatenate([tets[~around], *halves]),
        np.concatenate([part[~around], part[around], part[around]]),
    )
