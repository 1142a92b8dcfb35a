"""Closed surfaces made of oriented patches: are they closed, what do they hold, their triangles.

A surface is given by its sides, pairs (patch, +1 or -1): the triangles of the patch as they are, or
turned round. A patch that stands on both sides of a cell occurs once with each sign.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from decomp.complex.model import Complex
from decomp.vectors import Array, Bools, Ints, cross, dot

Sides = Iterable[tuple[int, int]]


def side_triangles(mesh: Complex, sides: Sides) -> Ints:
    """All triangles (m, 3) of some sides, turned round where the sign is -1."""
    parts = [mesh.patches[patch].triangles[:, ::sign] for patch, sign in sides]
    return np.concatenate([np.empty((0, 3), dtype=np.int64), *parts])


def open_edges(triangles: Ints) -> Ints:
    """Edges (k, 2) of triangles (m, 3) that are not walked as often one way as the other.

    There is none just when the triangles form a closed 2-cycle.
    """
    directed = triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)
    edges, which = np.unique(np.sort(directed, axis=1), axis=0, return_inverse=True)
    sense = np.where(directed[:, 0] < directed[:, 1], 1, -1)
    net = np.zeros(len(edges), dtype=np.int64)
    np.add.at(net, which.reshape(-1), sense)
    return np.asarray(edges[net != 0])


def is_closed(mesh: Complex, sides: Sides) -> bool:
    """Whether sides form a closed 2-cycle."""
    return len(open_edges(side_triangles(mesh, sides))) == 0


def volume(mesh: Complex, sides: Sides, origin: Array) -> float:
    """Volume inside a closed surface, positive where it is oriented outwards.

    By the divergence theorem; `origin` (3,) should be near, so that little is cancelled.
    """
    a, b, c = np.moveaxis(mesh.points[side_triangles(mesh, sides)] - origin, 1, 0)
    return float(dot(a, cross(b, c)).sum() / 6)


def cell_surface(mesh: Complex, sides: Sides) -> tuple[Array, Ints]:
    """The points (n, 3) and triangles (m, 3) of a surface; points that it does not use are left."""
    return used_points(mesh.points, side_triangles(mesh, sides))[:2]


def used_points(points: Array, triangles: Ints) -> tuple[Array, Ints, Bools]:
    """Drop the points that triangles (m, any) do not use.

    Returns:
        the points, the triangles renumbered, and the mask (n,) of the points that were kept.
    """
    used = np.zeros(len(points), dtype=np.bool_)
    used[triangles] = True
    number = np.cumsum(used) - 1
    return points[used], number[triangles], used
