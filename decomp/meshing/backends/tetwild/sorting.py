"""Triangles in an order in which those that follow each other lie close together.

TetWild looks for the triangle nearest to a point in a tree of boxes over halves of the list of
triangles, halves of these and so on. It takes the list as it comes, so that the order decides how
well the boxes fit.
"""

from __future__ import annotations

import numpy as np

from decomp.vectors import Array, Ints

FEW_TRIANGLES = 4
"""So few triangles are not sorted further."""


def sorted_in_space(points: Array, triangles: Ints) -> Ints:
    """The same triangles (m, 3), halved again and again across the longest side of their box."""
    centres = points[triangles].mean(axis=1)
    order = np.arange(len(triangles))
    parts = [(0, len(order))]
    while parts:
        start, end = parts.pop()
        if end - start <= FEW_TRIANGLES:
            continue
        rows = order[start:end]
        axis = int(np.argmax(np.ptp(centres[rows], axis=0)))
        half = len(rows) // 2
        order[start:end] = rows[np.argpartition(centres[rows, axis], half)]
        parts += [(start, start + half), (start + half, end)]
    return np.asarray(triangles[order])
