"""The triangles of a mesh of tetrahedra, and which tetrahedra they part."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from decomp.vectors import Array, Ints, cross, dot

OPPOSITE = np.array([[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]])
"""The face opposite to each vertex of a positive tetrahedron, seen from outside it."""
EDGES = np.array([[0, 1], [1, 2], [2, 0], [3, 0], [3, 2], [3, 1]])
"""The edges of a tetrahedron in Gmsh's order."""
PAIRS = [(i, j) for i in range(4) for j in range(i)]
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
    # vertices, coordinates, tetrahedra: operations on long rows are several times as fast
    corners = np.ascontiguousarray(points[tets].transpose(1, 2, 0))
    u, v, w = corners[1:] - corners[0]
    # out of the face opposite to each vertex, twice its area long; together they are zero
    normal = np.empty_like(corners)
    normal[1], normal[2], normal[3] = _cross(w, v), _cross(u, w), _cross(v, u)
    normal[0] = -(normal[1] + normal[2] + normal[3])
    positive = (normal[3] * w).sum(axis=0) < 0
    normal /= np.maximum(np.sqrt((normal**2).sum(axis=1)), 1e-300)[:, None]
    cosine = np.min([(normal[i] * normal[j]).sum(axis=0) for i, j in PAIRS], axis=0)
    least = np.degrees(np.arccos(np.clip(-cosine, -1, 1)))
    return np.asarray(np.where(positive, least, -least))


def _cross(a: Array, b: Array) -> Array:
    """Vector products (3, m) along the first axis."""
    return np.stack(
        [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    )


def edges_of(cells: Ints, pairs: Ints) -> tuple[Ints, Ints]:
    """The distinct edges of simplices.

    Args:
        cells: (m, any).
        pairs: (k, 2) local numbers of the ends of each edge.

    Returns:
        edges (e, 2), lower vertex first, and (m, k) the edge at each place.
    """
    every = np.sort(cells[:, pairs].reshape(-1, 2), axis=1)
    width = int(every.max(initial=0)) + 1
    keys, which = np.unique(every[:, 0] * width + every[:, 1], return_inverse=True)
    return np.stack(np.divmod(keys, width), axis=1), which.reshape(len(cells), len(pairs))
