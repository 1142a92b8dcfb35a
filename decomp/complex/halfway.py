"""The middle of an edge found by going along its surface from one end towards the other.

Where an edge is long for its surface, as across the narrow end of a sheet that opens widely, the
surface may place the chord's middle far away, on another part. From an end, in steps that are short
for the edge, the way to the other end stays on the part between both.
"""

from __future__ import annotations

import numpy as np

from decomp.complex.many_elements import Elements
from decomp.tolerance import TINY
from decomp.vectors import Array, Ints, dot, norm

HALFWAY_STEP = 0.05
"""Length of a step, as a part of the edge's."""
HALFWAY_STEPS = 200
STRAY = 0.5
"""A step that leads farther away than this part of itself from where it aims is not believed."""
MIDDLE = 1e-3
"""How far from the middle a way may stop, as a part of the edge's length."""


def halfway(elements: Elements, numbers: Ints, ends: Array) -> Array:
    """Points (k, 3) on surfaces, as far from both ends of edges (k, 2, 3); nan if none is found.

    Args:
        elements: of a complex.
        numbers: (k,) of the surfaces.
        ends: of the edges, on them.

    Raises:
        GeometryError: a surface gives no point or normal beside the way.
    """
    point, goal = np.array(ends[:, 0]), ends[:, 1]
    length = norm(goal - ends[:, 0])
    found = np.full_like(point, np.nan)
    rows = np.arange(len(point))
    reach = np.full(len(point), HALFWAY_STEP)
    for _ in range(HALFWAY_STEPS):
        if not len(rows):
            break
        at, step = point[rows], reach[rows] * length[rows]
        normal = elements.normal(numbers[rows], at)
        way = goal[rows] - at
        way = way - dot(way, normal)[:, None] * normal
        way /= np.maximum(norm(way), TINY)[:, None]
        aim = at + step[:, None] * way
        moved = elements.place(numbers[rows], aim)
        near = norm(moved - aim) <= STRAY * step
        gone = norm(moved - ends[rows, 0]) - norm(moved - goal[rows])
        past = near & (gone > MIDDLE * length[rows])
        there = near & ~past & (gone >= -MIDDLE * length[rows])
        on = near & ~past
        point[rows[on]] = moved[on]
        found[rows[there]] = moved[there]
        reach[rows[~on]] /= 2
        rows = rows[~there & (reach[rows] > MIDDLE / 4)]
    return found
