"""The triangles of a mesh of tetrahedra, and which tetrahedra they part."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from decomp.vectors import Array, Ints, cross, dot, norm

OPPOSITE = np.array([[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]])
"""The face opposite to each vertex of a positive tetrahedron, seen from outside it."""
EDGES = np.array([[0, 1], [1, 2], [2, 0], [3, 0], [3, 2], [3, 1]])
"""The edges of a tetrahedron in Gmsh's order."""
PAIRS = np.array([[i, j] for i in range(4) for j in range(i)])
NONE = -1


@dataclass(frozen=True, eq=False)
class Faces:
    """All triangles of a mesh of tetrahedra.

    Args:
        triangles: (f, 3), pointing out of the first of their tetrahedra.
        tets: (f, 2) the tetrahedra on both sides, the second NONE on the hull.
    """

    triangles: Ints
    tets: Ints


def faces_of(tets: Ints) -> Faces:
    """List the triangles of tetrahedra (m, 4).

    Raises:
        ValueError: a triangle belongs to more than two.
    """
    every = tets[:, OPPOSITE].reshape(-1, 3)
    owner = np.repeat(np.arange(len(tets)), 4)
    keys = np.sort(every, axis=1)
    order = np.lexsort((owner, keys[:, 2], keys[:, 1], keys[:, 0]))
    keys = keys[order]
    same = (keys[1:] == keys[:-1]).all(axis=1)
    if (same[1:] & same[:-1]).any():
        raise ValueError("a triangle belongs to three tetrahedra")
    first = np.flatnonzero(np.concatenate([[True], ~same]))
    paired = np.concatenate([same, [False]])[first]
    other = np.full(len(first), NONE, dtype=np.int64)
    other[paired] = owner[order[first[paired] + 1]]
    return Faces(every[order[first]], np.stack([owner[order[first]], other], axis=1))


def volumes(points: Array, tets: Ints) -> Array:
    """Signed volumes (m,) of tetrahedra (m, 4)."""
    a, b, c, d = np.moveaxis(points[tets], 1, 0)
    return np.asarray(dot(cross(b - a, c - a), d - a) / 6)


def least_dihedral(points: Array, tets: Ints) -> Array:
    """The least dihedral angle (m,) of each tetrahedron, in degrees; 0 and less if inverted.

    The angle between two faces is measured with a sign of the tetrahedron's volume.
    """
    corners = points[tets]
    start = corners[:, OPPOSITE[:, 0]]
    first, second = corners[:, OPPOSITE[:, 1]] - start, corners[:, OPPOSITE[:, 2]] - start
    normal = cross(first, second)
    normal /= np.maximum(norm(normal), 1e-300)[..., None]
    cosine = -dot(normal[:, PAIRS[:, 0]], normal[:, PAIRS[:, 1]]).min(axis=1)
    least = np.degrees(np.arccos(np.clip(cosine, -1, 1)))
    # the fourth normal points out of the vertices 0, 1, 2, away from vertex 3 if it is positive
    positive = dot(normal[:, 3], corners[:, 3] - corners[:, 0]) < 0
    return np.asarray(np.where(positive, least, -least))


def edges_of(cells: Ints, pairs: Ints) -> tuple[Ints, Ints]:
    """The distinct edges of simplices.

    Args:
        cells: (m, any).
        pairs: (k, 2) local numbers of the ends of each edge.

    Returns:
        edges (e, 2), lower vertex first, and (m, k) the edge at each place.
    """
    every = np.sort(cells[:, pairs].reshape(-1, 2), axis=1)
    edges, which = np.unique(every, axis=0, return_inverse=True)
    return edges, which.reshape(len(cells), len(pairs))
