"""Which walls are skeleton: those across which the nearest point jumps."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from decomp.sampled.normals import LOOSE, TIGHT
from decomp.sampled.placing import Placer
from decomp.vectors import Array, Bools, Ints

NO_RADIUS = 1e-6
"""Vertices with less than this part of the largest radius are on the boundary: none tells."""


def links(
    placer: Placer,
    owner: dict[int, int],
    points: Array,
    radius: Array,
    sites: Sequence[tuple[int, ...]],
    node: Ints,
    triangles: Ints,
    between: Ints,
) -> Ints:
    """For each triangle (t, 2) the sites of which one takes over from the other, -1 on sheets.

    Where a thin part is missing between two sites it is one of them and what lies between.

    Args:
        placer: of the region.
        owner: the face that owns each site.
        points, radius: (v, 3) and (v,) of the vertices.
        sites: of each vertex.
        node: (v,) the boundary node that each vertex is, -1 for none.
        triangles: (t, 3) vertices.
        between: (t, 2) sites on both sides.
    """
    result: Ints = np.full((len(triangles), 2), -1, dtype=np.int64)
    direct = _direct(placer, points, radius, node, triangles, between)
    groups: dict[int, list[set[int]]] = {}
    for row, (a, b) in enumerate(between.tolist()):
        if direct[row]:
            result[row] = a, b
            continue
        corners = triangles[row].tolist()
        inner = [vertex for vertex in corners if node[vertex] < 0]
        if not inner:
            # on the boundary itself: it is the edge that the nodes are on
            own = tuple(sorted({site for v in corners for site in sites[v]}))
            if any(a in group and b in group for group in placer.contacts(own)):
                result[row] = _between(placer, owner, own, a, b)
        for vertex in inner:
            own = sites[vertex]
            if len(own) < 3 or a not in own or b not in own:
                continue
            if vertex not in groups:
                groups[vertex] = placer.contacts(own, points[vertex])
            if any(a in group and b in group for group in groups[vertex]):
                result[row] = _between(placer, owner, own, a, b)
                break
    return result


def _direct(
    placer: Placer, points: Array, radius: Array, node: Ints, triangles: Ints, between: Ints
) -> Bools:
    """Which triangles (t, 3) lie on normals at which one of their own sites takes over."""
    result = np.zeros(len(triangles), dtype=np.bool_)
    least = NO_RADIUS * float(np.abs(radius).max(initial=0.0))
    pairs, which = np.unique(between, axis=0, return_inverse=True)
    for number, (a, b) in enumerate(pairs.tolist()):
        if not placer.normals.takes_over(a, b):
            continue
        rows = np.flatnonzero(which.reshape(-1) == number)
        used = np.unique(triangles[rows])
        slant = placer.normals.slant(a, b, points[used])
        told = (node[used] < 0) & (np.abs(radius[used]) > least)
        votes = np.zeros((len(points), 3), dtype=np.int64)
        votes[used] = told[:, None] & np.stack(
            [slant <= TIGHT, (slant > TIGHT) & (slant <= LOOSE), slant > LOOSE], axis=1
        )
        on, beside, off = votes[triangles[rows]].sum(axis=1).T
        result[rows] = (off == 0) & (on >= beside)
    return result


def _between(
    placer: Placer, owner: dict[int, int], sites: tuple[int, ...], a: int, b: int
) -> tuple[int, int]:
    """Of what lies between two sites the pair at which one takes over from another's cell."""
    pairs = [(i, j) for i in sites for j in sites if i < j and placer.normals.takes_over(i, j)]
    wanted = {owner[a], owner[b]}
    for i, j in pairs:
        if {owner[i], owner[j]} == wanted:
            return i, j
    return next(((i, j) for i, j in pairs if {a, b} & {i, j}), (a, b))
