"""Ten-node tetrahedra: a node on each edge, on the exact surface or curve that the edge lies on.

A curved edge that would turn a Jacobian at a quadrature point, or bring it near zero, stays
straight.
"""

from __future__ import annotations

import numpy as np

from decomp.complex.many_elements import Elements
from decomp.meshes.faces import EDGES, TRIANGLE_EDGES, edges_of
from decomp.meshes.quality import FOUR, POINTS, jacobians
from decomp.meshing.exact.targets import CORNER, Finder, placed
from decomp.meshing.naming.tagging import Tagged
from decomp.vectors import Array, Ints

AT = np.concatenate([np.eye(4), FOUR, POINTS])
"""Where Jacobians are looked at: corners, and the points of the rules of degree 2 and 5."""
LEAST_VOLUME = 0.1
"""They stay above this part of the straight tetrahedron's."""


def quadratic(
    points: Array, tets: Ints, tagged: Tagged, finder: Finder, elements: Elements, corners: Array
) -> tuple[Array, Ints, Ints]:
    """Put nodes on all edges.

    Args:
        points: (n, 3), all used, in their exact places.
        tets: (m, 4).
        tagged: triangles of the tets.
        finder: tells what edges belong to.
        elements: of the complex.
        corners: (p, 3) the complex's points.

    Returns:
        points (n + e, 3), those at corners first; tetrahedra (m, 10); the tagged triangles (k, 6).
    """
    edges, of_tet = edges_of(tets, EDGES)
    straight = points[edges].mean(axis=1)
    of_triangle = _edges_at(edges, tagged.triangles, len(points))
    targets = finder.targets(straight, Tagged(of_triangle, tagged.cells, tagged.patches))
    rows = targets.nodes
    goals, good = placed(elements, corners, targets.dimension, targets.element, straight[rows])
    good &= targets.complete & (targets.dimension != CORNER)
    middles = np.array(straight)
    middles[rows[good]] = goals[good]
    curved = np.zeros(len(edges), dtype=np.bool_)
    curved[rows[good]] = True
    every = np.concatenate([points, middles])
    whole = np.concatenate([tets, of_tet + len(points)], axis=1)
    allowed = LEAST_VOLUME * jacobians(points, tets)[:, 0]
    checked = np.flatnonzero(curved[of_tet].any(axis=1))
    while len(checked):
        least = jacobians(every, whole[checked], AT).min(axis=1)
        bad = checked[least < allowed[checked]]
        back = np.unique(of_tet[bad][curved[of_tet[bad]]])
        if not len(back):
            break
        curved[back] = False
        every[len(points) + back] = straight[back]
        touched = np.zeros(len(edges), dtype=np.bool_)
        touched[back] = True
        checked = np.flatnonzero(touched[of_tet].any(axis=1))
    six = np.concatenate([tagged.triangles, of_triangle + len(points)], axis=1)
    return every, whole, six


def _edges_at(edges: Ints, triangles: Ints, count: int) -> Ints:
    """The numbers (k, 3) of triangles' edges 01, 12, 20 among sorted edges (e, 2)."""
    wanted = np.sort(triangles[:, TRIANGLE_EDGES], axis=2)
    keys = edges[:, 0] * count + edges[:, 1]
    return np.searchsorted(keys, wanted[..., 0] * count + wanted[..., 1])
