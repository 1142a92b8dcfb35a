"""Walls as the sheets of a skeleton tell of them: a point of a sheet is halfway through one."""

from __future__ import annotations

from functools import partial

import numpy as np

from decomp.complex.model import LineKind, SurfaceElement
from decomp.geometry import Geometry
from decomp.meshing.sizing.wall import FACING, Wall, owners_and_meeting
from decomp.meshing.surface.surface import MeshSurface
from decomp.tolerance import TINY
from decomp.vectors import Array, dot

TO_SIDES = 1e-6
"""Feet on a sheet's two sides are asked this part of the diagonal off it."""


def sheet_walls(geometry: Geometry, surface: MeshSurface, number: int) -> list[Wall]:
    """The sheets of a region but for those between faces that meet in an edge."""
    owner, meeting = owners_and_meeting(surface, number)
    found = []
    for patch, sites in surface.regions[number].sheets.items():
        if frozenset(owner[list(sites)].tolist()) not in meeting:
            own = surface.complex.patches[patch]
            found.append(Wall(own.triangles, partial(_facing, geometry, own.surface, number)))
    return found


def reflexive_walls(
    geometry: Geometry, surface: MeshSurface, number: int
) -> list[tuple[tuple[Array, Array], Array]]:
    """Points (k, 3) of each reflexive curve of a region with their feet and thicknesses (k,).

    The tip of a cone is a corner, and does not count.
    """
    found = []
    for line in surface.complex.lines:
        if line.kind is LineKind.REFLEXIVE:
            some = surface.complex.points[line.vertices]
            near = geometry.index.nearest(some)
            rows = (near.region == number) & (near.distance > near.distance.max() / 2)
            found.append(((some[rows], near.foot[rows]), 2 * near.distance[rows]))
    return found


def _facing(
    geometry: Geometry, sheet: SurfaceElement, number: int, some: Array
) -> tuple[tuple[Array, ...], Array]:
    """Points (k, 3) of a sheet among some (n, 3) at which feet face each other.

    With their feet on both sides, and how far these are apart (k,).
    """
    some = sheet.place(np.unique(some, axis=0))  # triangles share their corners
    way = sheet.normal(some) * (TO_SIDES * geometry.diagonal)
    one, two = (geometry.index.nearest(some + sign * way) for sign in (-1, 1))
    good = (one.region == number) & (two.region == number) & (one.distance > 0)
    good &= two.distance > 0
    u = (one.foot - some) / np.maximum(one.distance, TINY)[:, None]
    v = (two.foot - some) / np.maximum(two.distance, TINY)[:, None]
    rows = good & (dot(u, v) < FACING)
    return (some[rows], one.foot[rows], two.foot[rows]), np.asarray(2 * one.distance[rows])
