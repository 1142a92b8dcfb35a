"""Nodes that have no room where they belong are merged with a neighbour that belongs there too.

A mesher that keeps to a tolerance can end a sheet a little short of the edge or seam that it should
reach, next to nodes that are on it. Such a node cannot be moved there without flattening
tetrahedra: it is one too many.
"""

from __future__ import annotations

import itertools
from collections.abc import Mapping

import numpy as np

from decomp.meshes.faces import faces_of, least_dihedral
from decomp.vectors import Array, Ints

OUTER = -1
"""A vertex that stands for all that is outside, so that nodes on the hull have closed stars."""
SOUND = 3.0
"""Degrees. No tetrahedron may come out with a lesser dihedral angle unless it had one before; nodes
are smoothed afterwards."""


def collapsed(
    points: Array, tets: Ints, part: Ints, nodes: Ints, kinds: Mapping[int, frozenset[int]]
) -> tuple[Ints, Ints] | None:
    """Merge nodes with neighbours at which at least the same kinds of patches meet.

    Args:
        points: (n, 3).
        tets: (m, 4), positively oriented.
        part: (m,) of each, kept.
        nodes: to be merged.
        kinds: the kinds of patches that meet at each node that is on any.

    Returns:
        tetrahedra and their parts; None if no node could be merged.
    """
    faces = faces_of(tets)
    hull = faces.triangles[faces.tets[:, 1] < 0]
    alive = np.ones(len(tets), dtype=np.bool_)
    tets = tets.copy()
    moved: set[int] = set()
    for node in nodes.tolist():
        near = np.flatnonzero((tets == node).any(axis=1) & alive)
        around = set(tets[near].reshape(-1).tolist()) - {node}
        outer = hull[(hull == node).any(axis=1)]
        if moved & (around | {node}):
            continue
        goals = [k for k in around if kinds[node] <= kinds.get(k, frozenset())]
        goals = [k for k in goals if (hull == k).any() == bool(len(outer))]
        best = _best_goal(points, tets[alive], hull, node, goals)
        if best is None:
            continue
        gone = near[(tets[near] == best).any(axis=1)]
        alive[gone] = False
        tets[near] = np.where(tets[near] == node, best, tets[near])
        moved |= around | {node}
    if not moved:
        return None
    return tets[alive], part[alive]


def _best_goal(points: Array, tets: Ints, hull: Ints, node: int, goals: list[int]) -> int | None:
    """The neighbour that a node is merged with to the best effect, if with any to a sound one."""
    star = tets[(tets == node).any(axis=1)]
    floor = min(SOUND, float(least_dihedral(points, star).min()))
    best, most = None, floor
    for goal in goals:
        left = star[(star != goal).all(axis=1)]
        angle = float(least_dihedral(points, np.where(left == node, goal, left)).min(initial=180.0))
        if angle >= most and keeps_shape(tets, hull, node, goal):
            best, most = goal, angle
    return best


def keeps_shape(tets: Ints, hull: Ints, node: int, goal: int) -> bool:
    """Whether merging two nodes changes no connection (the link condition)."""
    closed = np.concatenate([tets, np.column_stack([hull, np.full(len(hull), OUTER)])])
    links = []
    for vertex in (node, goal):
        own = closed[(closed == vertex).any(axis=1)]
        links.append(_simplices([set(row) - {vertex} for row in own.tolist()]))
    both = closed[(closed == node).any(axis=1) & (closed == goal).any(axis=1)]
    between = _simplices([set(row) - {node, goal} for row in both.tolist()])
    return links[0] & links[1] == between


def _simplices(cells: list[set[int]]) -> set[frozenset[int]]:
    """Cells with all their vertices, edges and triangles."""
    return {
        frozenset(some)
        for cell in cells
        for size in range(1, len(cell) + 1)
        for some in itertools.combinations(cell, size)
    }
