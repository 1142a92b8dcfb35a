"""Sheets that lie in several planes, parted by the planes.

Two equal cylinders whose axes meet have two planes between them, which cross in a line. Where the
cylinders are tangent one point is the foot of a whole segment of that line, at which sheets in both
planes end: no footprint tells them apart, but each plane shows its own.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from decomp.vectors import Array, Ints


def flat_parts(points: Array, lines: Sequence[Ints], slack: float) -> list[list[Ints]] | None:
    """The lines in each of the planes that polylines lie in.

    Args:
        points: (n, 3).
        lines: of vertices; a straight one can be in several planes.
        slack: how far points may be off a plane, in units of length.

    Returns:
        For each plane its lines; None if there are not two planes, or a line is in none.
    """
    planes: list[tuple[Array, Array]] = []

    def within(line: Ints, plane: tuple[Array, Array]) -> bool:
        through, normal = plane
        return bool(np.abs((points[line] - through) @ normal).max() <= slack)

    for line in lines:
        middle = points[line].mean(axis=0)
        _, spread, axes = np.linalg.svd(points[line] - middle)
        least = slack * np.sqrt(len(line))
        straight = len(spread) < 2 or spread[1] <= least
        if not straight and not any(within(line, plane) for plane in planes):
            planes.append((middle, axes[2]))
    groups = [[line for line in lines if within(line, plane)] for plane in planes]
    own = [any(within(line, plane) for plane in planes) for line in lines]
    return groups if len(groups) > 1 and all(own) else None
