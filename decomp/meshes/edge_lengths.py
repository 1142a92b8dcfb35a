"""How long edges have come out, beside how long they were to be."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from decomp.meshes.faces import EDGES, TRIANGLE_EDGES, edges_of
from decomp.vectors import Array, Ints, norm


@dataclass(frozen=True)
class EdgeLengths:
    """The edges of some elements, between their corners, in model units.

    Args:
        number: how many.
        mean, longest: their lengths.
        asked: the largest length asked for there (`size`, `maxh`, or the default), None if unknown.
        wanted: the mean of what was wanted at them, where curvature, layers, thin walls and what
            is near ask for less than that; None if unknown.
    """

    number: int
    mean: float
    longest: float
    asked: float | None
    wanted: float | None


def edge_lengths(
    points: Array, elements: Ints, asked: float | None = None, wanted: Array | None = None
) -> EdgeLengths:
    """Measure the edges of elements; 0 where there are none.

    Args:
        points: (n, 3).
        elements: tetrahedra (m, 4 or 10) or triangles (m, 3 or 6).
        asked: see `EdgeLengths`.
        wanted: (n,) the length wanted at each node.
    """
    solid = elements.shape[1] in (4, 10)
    ends, _ = edges_of(elements, EDGES if solid else TRIANGLE_EDGES)
    if not len(ends):
        return EdgeLengths(0, 0.0, 0.0, asked, None)
    length = norm(points[ends[:, 1]] - points[ends[:, 0]])
    most = np.inf if asked is None else asked
    mean = None if wanted is None else float(np.minimum(wanted[ends].mean(axis=1), most).mean())
    return EdgeLengths(len(ends), float(length.mean()), float(length.max()), asked, mean)
