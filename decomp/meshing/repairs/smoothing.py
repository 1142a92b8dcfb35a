"""Nodes moved to where the tetrahedra around them have better angles, many at a time.

They go towards the middle of their neighbours first, then wherever a small step at random helps.
In each round nodes are chosen of which no two are neighbours, so that every tetrahedron has at most
one of them and all moves can be judged together.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from decomp.meshes.faces import EDGES, edges_of, least_dihedral
from decomp.vectors import Array, Bools, Ints, norm

SMOOTHING_ROUNDS = 40
SMOOTHED_BY = 0.6
"""A node goes this part of the way to the middle of its neighbours."""
WANDERING = 60
STRIDE = 0.12
"""Then it is tried in so many places nearby, at most this part of its mean edge away."""
SOUND_SMOOTHED = 20.0
"""The least angle (degrees) at a node may fall, but not below this."""

Place = Callable[[Ints, Array], tuple[Array, Bools]]


def smoothed(
    points: Array,
    tets: Ints,
    free: Bools,
    held: Bools,
    place: Place,
    longest: Array,
    seed: int = 0,
) -> Array:
    """Better places for nodes.

    Args:
        points: (n, 3).
        tets: (m, 4).
        free: (n,) nodes that may go anywhere.
        held: (n,) nodes that may move on their surfaces; they go towards the middle of those of
            their neighbours that are not free.
        place: puts such nodes (their numbers, and wanted places) onto their surfaces, and tells
            which succeeded.
        longest: (e,) of edges in the order of `edges_of`: none gets longer by moving a node.
        seed: of the choice of nodes.
    """
    points = np.array(points)
    edges, _ = edges_of(tets, EDGES)
    ends = np.concatenate([edges, edges[:, ::-1]])
    counts = free[ends[:, 0]] | ~free[ends[:, 1]]
    near = ends[counts]
    most = np.concatenate([longest, longest])
    movable = free | held
    random = np.random.default_rng(seed)
    quality = least_dihedral(points, tets)
    length = _means(ends[:, 0], norm(points[ends[:, 0]] - points[ends[:, 1]]), len(points))
    for turn in range(SMOOTHING_ROUNDS + WANDERING):
        rank = np.where(movable, random.random(len(points)), -1.0)
        best = np.zeros(len(points))
        np.maximum.at(best, ends[:, 0], rank[ends[:, 1]])
        chosen = rank > best
        if turn < SMOOTHING_ROUNDS:
            wanted = points + SMOOTHED_BY * (_middles(points, near) - points)
        else:
            wanted = points + STRIDE * length[:, None] * random.uniform(-1, 1, size=points.shape)
        on = np.flatnonzero(chosen & held)
        wanted[on], good = place(on, wanted[on])
        chosen[on[~good]] = False
        rows = np.flatnonzero(chosen[tets].any(axis=1))
        node = tets[rows][chosen[tets[rows]]]
        moved = np.where(chosen[:, None], wanted, points)
        new, old = least_dihedral(moved, tets[rows]), quality[rows]
        gain = np.bincount(node, new - old, minlength=len(points))
        low, before = np.full(len(points), np.inf), np.full(len(points), np.inf)
        np.minimum.at(low, node, new)
        np.minimum.at(before, node, old)
        kept = chosen & (gain > 0) & (low >= np.minimum(before, SOUND_SMOOTHED))
        own = np.flatnonzero(kept[ends[:, 0]])
        far = norm(moved[ends[own, 0]] - moved[ends[own, 1]]) > most[own]
        kept[ends[own[far], 0]] = False
        points[kept] = wanted[kept]
        done = kept[node]
        quality[rows[done]] = new[done]
    return points


def _middles(points: Array, near: Ints) -> Array:
    """The middles (n, 3) of each node's neighbours, given as pairs (k, 2) of node and neighbour."""
    middles = [_means(near[:, 0], points[near[:, 1], k], len(points)) for k in range(3)]
    return np.stack(middles, axis=1)


def _means(which: Ints, values: Array, count: int) -> Array:
    """The mean (count,) of the values (k,) that belong to each number, 0 where there is none."""
    number = np.maximum(np.bincount(which, minlength=count), 1)
    return np.asarray(np.bincount(which, values, minlength=count) / number)
