"""What a plane leaves of triangles and of tetrahedra, cut exactly."""

from __future__ import annotations

import numpy as np

from decomp.drawing.raster import Triangles, joined
from decomp.vectors import Array, Bools, Ints


def kept(triangles: Triangles, distance: Array, within: bool) -> Triangles:
    """The parts of triangles on one side of a plane.

    Args:
        triangles: k of them.
        distance: (k, 3) of their corners from the plane; what is negative is cut away.
        within: whether triangles in the plane are kept: sections have their places.
    """
    inside = distance >= 0 if within else distance > 0
    count = inside.sum(axis=1)
    whole = count == 3
    parts = [Triangles(triangles.corners[whole], triangles.sides[whole], triangles.colours[whole])]
    for number in (1, 2):
        rows = np.flatnonzero(count == number)
        # turned so that the corner that is alone on its side is the first
        alone = np.argmax(inside[rows] if number == 1 else ~inside[rows], axis=1)
        turn = (alone[:, None] + np.arange(3)) % 3
        corners = np.take_along_axis(triangles.corners[rows], turn[:, :, None], axis=1)
        far = np.take_along_axis(distance[rows], turn, axis=1)
        sides = np.take_along_axis(triangles.sides[rows], turn, axis=1)
        a, b, c = np.moveaxis(corners, 1, 0)
        p, q = (_between(a, other, far[:, 0], far[:, k]) for k, other in ((1, b), (2, c)))
        yes, no = np.ones(len(rows), dtype=np.bool_), np.zeros(len(rows), dtype=np.bool_)
        colours = triangles.colours[rows]
        across, at_b, at_c = np.moveaxis(sides, 1, 0)
        if number == 1:
            parts.append(_of((a, p, q), (yes, at_b, at_c), colours))
        else:
            parts.append(_of((p, b, c), (across, no, at_c), colours))
            parts.append(_of((p, c, q), (at_b, yes, no), colours))
    return joined(parts)


def sections(corners: Array, distance: Array, colours: Array) -> Triangles:
    """Where tetrahedra are cut by a plane, or touch it from the side that is kept.

    These are triangles, and quadrilaterals as two.

    Args:
        corners: (m, 4, 3).
        distance: (m, 4) from the plane.
        colours: (m, 3).
    """
    count = (distance > 0).sum(axis=1)
    parts = []
    for number in (1, 2, 3):
        rows = np.flatnonzero(count == number)
        order: Ints = np.argsort(distance[rows] <= 0, axis=1, kind="stable")
        at = np.take_along_axis(corners[rows], order[:, :, None], axis=1)
        far = np.take_along_axis(distance[rows], order, axis=1)
        pairs = [(i, j) for i in range(number) for j in range(number, 4)]
        on = [_between(at[:, i], at[:, j], far[:, i], far[:, j]) for i, j in pairs]
        yes, no = np.ones(len(rows), dtype=np.bool_), np.zeros(len(rows), dtype=np.bool_)
        own = colours[rows]
        if number == 2:
            first, second, fourth, third = on  # around: 02, 03, 13, 12
            parts.append(_of((first, second, third), (yes, no, yes), own))
            parts.append(_of((first, third, fourth), (yes, yes, no), own))
        else:
            parts.append(_of((on[0], on[1], on[2]), (yes, yes, yes), own))
    return joined(parts)


def _between(one: Array, other: Array, here: Array, there: Array) -> Array:
    """The points (k, 3) of segments where the distance is 0."""
    share = here / (here - there)
    return np.asarray(one + share[:, None] * (other - one))


def _of(corners: tuple[Array, ...], sides: tuple[Bools, ...], colours: Array) -> Triangles:
    return Triangles(np.stack(corners, axis=1), np.stack(sides, axis=1), colours)
