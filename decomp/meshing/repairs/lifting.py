"""The worst tetrahedra made better: their nodes are tried in places all around.

A mesher such as TetWild now and then leaves one or two flat elements, which the middle of their
neighbours does not mend. There are few, so each node is looked at by itself.
"""

from __future__ import annotations

import numpy as np

from decomp.meshes.faces import least_dihedral
from decomp.vectors import Array, Bools, Ints, norm

POOR = 12.0
"""Tetrahedra with a lesser angle (degrees) are made better."""
LIFTING_PASSES = 8
WAYS_TRIED = 60
REACHES = (0.4, 0.15, 0.05)
"""How far from a node it is tried, in parts of the least distance to its neighbours."""


def lifted(points: Array, tets: Ints, free: Bools) -> Array:
    """Better places for the nodes of poor tetrahedra.

    Args:
        points: (n, 3).
        tets: (m, 4).
        free: (n,) nodes that may be moved.
    """
    points = np.array(points)
    random = np.random.default_rng(0)
    for _ in range(LIFTING_PASSES):
        poor = least_dihedral(points, tets) < POOR
        nodes = np.unique(tets[poor])
        near = tets[np.isin(tets, nodes).any(axis=1)]
        moves = [_lift(points, near, int(node), random) for node in nodes[free[nodes]]]
        if not any(moves):
            break
    return points


def _lift(points: Array, tets: Ints, node: int, random: np.random.Generator) -> bool:
    """Move one node to where the least angle around it is greatest; whether it was moved.

    All its tetrahedra are among those given.
    """
    star = tets[(tets == node).any(axis=1)]
    around = np.unique(star)
    around = around[around != node]
    near = float(norm(points[around] - points[node]).min())
    ways = random.normal(size=(WAYS_TRIED, 3))
    ways /= norm(ways)[:, None]
    tried = np.concatenate([points[node] + reach * near * ways for reach in REACHES])
    # one copy of the star for each place: its corners, then the places of the node
    where = np.concatenate([points[around], tried])
    local = np.searchsorted(around, star)
    copies = np.repeat(local[None], len(tried), axis=0)
    copies[:, star == node] = (len(around) + np.arange(len(tried)))[:, None]
    angles = least_dihedral(where, copies.reshape(-1, 4)).reshape(len(tried), -1).min(axis=1)
    best = int(np.argmax(angles))
    if angles[best] <= least_dihedral(points, star).min() + 1e-3:
        return False
    points[node] = tried[best]
    return True
