"""What a wall is: a surface at whose points a region's thickness can be told."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from decomp.meshing.surface.surface import MeshSurface
from decomp.skeletons.cells.owners import site_owners
from decomp.vectors import Array, Ints

FACING = -0.5
"""Feet face each other where the cosine between their directions is below this."""


class Wall(NamedTuple):
    """A surface along a wall.

    Args:
        triangles: (m, 3) of the complex, near it.
        measured: takes points (n, 3) near it to places where feet face each other: (k, 3) on
            the surface, and other points (k, 3) across the wall there; and how thick (k,) it is.
    """

    triangles: Ints
    measured: Callable[[Array], tuple[tuple[Array, ...], Array]]


def owners_and_meeting(surface: MeshSurface, number: int) -> tuple[Ints, set[frozenset[int]]]:
    """The face that owns each site, and which faces of a region meet in an edge.

    Between those there is a wedge, which tells of no wall.
    """
    owner = site_owners(surface.sites, [each.boundary for each in surface.regions])
    edges = surface.regions[number].boundary.edges
    return owner, {frozenset(edge.faces) for edge in edges}
