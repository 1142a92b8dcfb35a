"""The triangles of a mesh of tetrahedra, and which tetrahedra they part."""

from __future__ import annotations

from dataclasses import dataclass
from math import acos, pi, sqrt

import numpy as np

from decomp.kernels.compiled import kernel
from decomp.tolerance import TINY
from decomp.vectors import Array, Ints, cross, dot

OPPOSITE = np.array([[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]])
"""The face opposite to each vertex of a positive tetrahedron, seen from outside it."""
EDGES = np.array([[0, 1], [1, 2], [2, 0], [3, 0], [3, 2], [3, 1]])
TRIANGLE_EDGES = EDGES[:3]
"""The edges of a tetrahedron in Gmsh's order."""
NONE = -1
MOST_VERTICES = 1 << 21
"""With fewer vertices three numbers of vertices fit into one of 64 bits."""


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
    keys = _keys(every)
    order = np.argsort(keys, kind="stable")
    keys = keys[order]
    same = keys[1:] == keys[:-1]
    if (same[1:] & same[:-1]).any():
        raise ValueError("a triangle belongs to three tetrahedra")
    first = np.flatnonzero(np.concatenate([[True], ~same]))
    paired = np.concatenate([same, [False]])[first]
    other = np.full(len(first), NONE, dtype=np.int64)
    other[paired] = owner[order[first[paired] + 1]]
    return Faces(every[order[first]], np.stack([owner[order[first]], other], axis=1))


def is_complex(tets: Ints) -> bool:
    """Whether each triangle of tetrahedra (m, 4) belongs to two of them at most."""
    keys = np.sort(_keys(tets[:, OPPOSITE].reshape(-1, 3)))
    return not bool((keys[2:] == keys[:-2]).any())


def _keys(triangles: Ints) -> Ints:
    """A number (k,) for each triangle (k, 3), whatever the order of its vertices.

    Raises:
        ValueError: there are too many vertices.
    """
    low, middle, high = np.sort(triangles, axis=1).T
    width = int(high.max(initial=0)) + 1
    if width < MOST_VERTICES:
        return np.asarray((low * width + middle) * width + high)
    # the two first vertices are few beside all pairs
    _, pair = np.unique(low * width + middle, return_inverse=True)
    if width >= 1 << 31:
        raise ValueError(f"{width} vertices are too many")
    return np.asarray(pair * width + high)


def volumes(points: Array, tets: Ints) -> Array:
    """Signed volumes (m,) of tetrahedra (m, 4)."""
    a, b, c, d = np.moveaxis(points[tets], 1, 0)
    return np.asarray(dot(cross(b - a, c - a), d - a) / 6)


def least_dihedral(points: Array, tets: Ints) -> Array:
    """The least dihedral angle (m,) of each tetrahedron, in degrees; 0 and less if inverted.

    The angle between two faces is measured with a sign of the tetrahedron's volume.
    """
    result = np.empty(len(tets))
    _least_dihedral(np.ascontiguousarray(points), np.ascontiguousarray(tets), result)
    return result


@kernel
def _least_dihedral(points: Array, tets: Ints, result: Array) -> None:
    normal = np.empty((4, 3))
    for t in range(len(tets)):
        a, b, c, d = points[tets[t, 0]], points[tets[t, 1]], points[tets[t, 2]], points[tets[t, 3]]
        for i in range(3):
            # out of the face opposite to each vertex, twice its area long; together they are zero
            j, k = (i + 1) % 3, (i + 2) % 3
            uj, uk, vj, vk, wj, wk = (
                b[j] - a[j],
                b[k] - a[k],
                c[j] - a[j],
                c[k] - a[k],
                d[j] - a[j],
                d[k] - a[k],
            )
            normal[1, i] = wj * vk - wk * vj
            normal[2, i] = uj * wk - uk * wj
            normal[3, i] = vj * uk - vk * uj
            normal[0, i] = -(normal[1, i] + normal[2, i] + normal[3, i])
        volume = 0.0
        for i in range(3):
            volume -= normal[3, i] * (d[i] - a[i])
        least = 1.0
        for m in range(4):
            length = sqrt(normal[m, 0] ** 2 + normal[m, 1] ** 2 + normal[m, 2] ** 2)
            for i in range(3):
                normal[m, i] /= max(length, TINY)
            for n in range(m):
                cosine = 0.0
                for i in range(3):
                    cosine += normal[m, i] * normal[n, i]
                least = min(least, cosine)
        angle = acos(min(max(-least, -1.0), 1.0)) * 180 / pi
        result[t] = angle if volume > 0 else -angle


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
