"""The complex's triangles as TetWild takes them quickly: cut to short ones, and sorted in space."""

from __future__ import annotations

import numpy as np

from decomp.meshing.backends.base import Task
from decomp.meshing.backends.tetwild.child import Settings
from decomp.meshing.backends.tetwild.sorting import sorted_in_space
from decomp.meshing.backends.tetwild.subdividing import subdivided
from decomp.vectors import Array, Ints

INSERTED = 1.2
"""TetWild is given no edges longer than so many of those wanted,"""
BEGUN = 0.1
"""unless they are below this part of the length that it begins with."""
PLANE = 0.05
"""Triangles no farther off each other's planes than this part of epsilon are cut up as one."""


def soup(task: Task, settings: Settings) -> tuple[Array, Ints]:
    """Points (n, 3) and triangles (m, 3) for TetWild.

    Args:
        task: what is to be filled.
        settings: TetWild's.
    """

    def longest(middles: Array) -> Array:
        wanted = np.minimum(task.lengths(middles), settings.edge_length)
        return np.asarray(np.maximum(INSERTED * wanted, BEGUN * settings.edge_length))

    flat = PLANE * settings.epsilon
    points, triangles = subdivided(task.points, task.triangles, longest, flat)
    return points, sorted_in_space(points, triangles)
