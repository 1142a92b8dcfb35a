"""Nodes that have no room where they belong take in the neighbour that is in their way.

A mesher's nodes are up to the tolerance off their surfaces, and where edges are hardly longer than
that a node inside can be just where one of a surface belongs.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from decomp.meshes.faces import faces_of, least_dihedral
from decomp.meshing.repairs.collapsing import SOUND, keeps_shape
from decomp.vectors import Array, Ints


def cleared(
    points: Array,
    tets: Ints,
    part: Ints,
    nodes: Ints,
    goals: Array,
    kinds: Mapping[int, frozenset[int]],
) -> tuple[Array, Ints, Ints] | None:
    """Move nodes where they belong, each merged with a neighbour at which fewer patches meet.

    Args:
        points: (n, 3).
        tets: (m, 4), positively oriented.
        part: (m,) of each, kept.
        nodes: (k,) to be moved.
        goals: (k, 3) where to.
        kinds: the kinds of patches that meet at each node that is on any.

    Returns:
        points, tetrahedra and their parts; None if no node could be moved.
    """
    faces = faces_of(tets)
    hull = faces.triangles[faces.tets[:, 1] < 0]
    outer = set(hull.reshape(-1).tolist())
    alive = np.ones(len(tets), dtype=np.bool_)
    points, tets = points.copy(), tets.copy()
    moved: set[int] = set()
    for node, goal in zip(nodes.tolist(), goals, strict=True):
        around = set(tets[(tets == node).any(axis=1) & alive].reshape(-1).tolist()) - {node}
        if moved & (around | {node}):
            continue
        others = [k for k in around if k not in outer and kinds.get(k, frozenset()) < kinds[node]]
        best = _best(points, tets[alive], hull, node, goal, others)
        if best is None:
            continue
        near = (tets == best).any(axis=1) & alive
        moved |= around | set(tets[near].reshape(-1).tolist()) | {node}
        alive &= ~(near & (tets == node).any(axis=1))
        tets[near] = np.where(tets[near] == best, node, tets[near])
        points[node] = goal
    return (points, tets[alive], part[alive]) if moved else None


def _best(
    points: Array, tets: Ints, hull: Ints, node: int, goal: Array, others: list[int]
) -> int | None:
    """The neighbour that a node at its goal takes in to the best effect, if to a sound one."""
    moved = points.copy()
    moved[node] = goal
    best, most = None, SOUND
    for other in others:
        star = tets[np.isin(tets, [node, other]).any(axis=1)]
        left = star[~((star == node).any(axis=1) & (star == other).any(axis=1))]
        angle = float(least_dihedral(moved, np.where(left == other, node, left)).min(initial=180))
        if angle >= most and keeps_shape(tets, hull, other, node):
            best, most = other, angle
    return best
