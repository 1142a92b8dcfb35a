"""Where the nearest site changes along edges of tetrahedra."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from decomp.skeletons.balls.queries import RegionQueries
from decomp.vectors import Array, Ints

CHANGE_HALVINGS = 12
"""How often the place of a change is halved."""
DIRECT = 2.0
"""Changes closer than so many of the least steps are one."""


@dataclass(frozen=True, eq=False)
class Crossings:
    """Changes of the nearest site along edges with two labels.

    Args:
        points: (k, 3) where the change is, or the middle of what lies between.
        third: (k,) the site that is nearest there, -1 where there is none between the two.
    """

    points: Array
    third: Ints


def crossings(queries: RegionQueries, ends: Array, labels: Ints) -> Crossings:
    """Find the changes along edges.

    Args:
        queries: of the region.
        ends: (k, 2, 3) of the edges.
        labels: (k, 2) of their ends.
    """
    start, way = ends[:, 0], ends[:, 1] - ends[:, 0]
    found = []
    for column in range(2):
        # the end of the run of this label that begins at its end
        inner, outer = np.full(len(ends), float(column)), np.full(len(ends), 1.0 - column)
        for _ in range(CHANGE_HALVINGS):
            middle = (inner + outer) / 2
            site = queries.nearest(start + middle[:, None] * way).site
            same = site == labels[:, column]
            inner, outer = np.where(same, middle, inner), np.where(same, outer, middle)
        found.append((inner + outer) / 2)
    low, high = np.minimum(*found), np.maximum(*found)
    middle = (low + high) / 2
    points = start + middle[:, None] * way
    site = np.asarray(queries.nearest(points).site, dtype=np.int64)
    between = (high - low > DIRECT / 2**CHANGE_HALVINGS) & (site[:, None] != labels).all(axis=1)
    return Crossings(points, np.where(between, site, -1))
