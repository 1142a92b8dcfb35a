"""Long triangles cut up before TetWild gets them.

TetWild begins with the Delaunay tetrahedra of all vertices and inserts the triangles into it. Long
ones cut through many tetrahedra and leave slivers, which take it passes to mend; short ones are
faces of the Delaunay tetrahedra already.
"""

from __future__ import annotations

import numpy as np

from decomp.tetra.faces import edges_of
from decomp.vectors import Array, Ints, norm

SIDES = np.array([[0, 1], [1, 2], [2, 0]])


def subdivided(points: Array, triangles: Ints, longest: float) -> tuple[Array, Ints]:
    """Bisect edges until none is longer than a given length; neighbours stay conforming.

    An edge is bisected when it is the longest of all triangles at it (Rivara 1997: the terminal
    edge), so that angles are at least half of what they were.

    Args:
        points: (n, 3).
        triangles: (m, 3).
        longest: positive.
    """
    while True:
        edges, sides = edges_of(triangles, SIDES)
        length = norm(points[edges[:, 1]] - points[edges[:, 0]])
        rank = np.empty(len(edges), dtype=np.int64)
        rank[np.argsort(length, kind="stable")] = np.arange(len(edges))
        local = np.argmax(rank[sides], axis=1)
        first = sides[np.arange(len(sides)), local]
        count = len(edges)
        terminal = np.bincount(first, minlength=count) == np.bincount(sides.ravel())
        cut = terminal & (length > longest)
        if not cut.any():
            return points, triangles
        number = np.full(count, -1, dtype=np.int64)
        number[cut] = len(points) + np.arange(int(cut.sum()))
        middle = number[first]
        rows = np.flatnonzero(middle >= 0)
        a, b, c = (triangles[rows, (local[rows] + k) % 3] for k in range(3))
        new = middle[rows]
        points = np.concatenate([points, points[edges[cut]].mean(axis=1)])
        triangles = np.concatenate(
            [
                triangles[middle < 0],
                np.stack([a, new, c], axis=1),
                np.stack([new, b, c], axis=1),
            ]
        )
