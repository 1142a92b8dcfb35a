"""The complex's triangles as TetWild takes them quickly: cut to short ones, and sorted in space."""

from __future__ import annotations

import numpy as np

from decomp.meshing.backends.tetwild.child import Settings
from decomp.meshing.backends.tetwild.sorting import sorted_in_space
from decomp.meshing.backends.tetwild.subdividing import subdivided
from decomp.meshing.sizing.wishes import Wishes
from decomp.meshing.surface.layout import Layout
from decomp.vectors import Array, Ints

INSERTED = 1.2
"""TetWild is given no edges longer than so many of those wanted,"""
BEGUN = 0.1
"""unless they are below this part of the length that it begins with."""
PLANE = 0.05
"""Triangles no farther off each other's planes than this part of epsilon are cut up as one."""


def soup(plan: Layout, wish: Wishes, settings: Settings) -> tuple[Array, Ints]:
    """Points (n, 3) and triangles (m, 3) for TetWild.

    Args:
        plan: the complex.
        wish: lengths of edges.
        settings: TetWild's.
    """

    def longest(middles: Array) -> Array:
        wanted = np.minimum(wish.at(middles), settings.edge_length)
        return np.asarray(np.maximum(INSERTED * wanted, BEGUN * settings.edge_length))

    used, triangles = np.unique(plan.triangles, return_inverse=True)
    points, triangles = subdivided(
        plan.complex.points[used], triangles.reshape(-1, 3), longest, PLANE * settings.epsilon
    )
    return points, sorted_in_space(points, triangles)
