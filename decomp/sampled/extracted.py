"""Walls of one region, and how they are made simpler."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from decomp.complex.model import SIDES
from decomp.sampled.contracting import Contractor, Holds
from decomp.sampled.placing import Placer
from decomp.vectors import Array, Bools, Ints, norm

CLOSE_VERTICES = 2e-6
"""Vertices closer than this part of the size become one if all walls allow it: where a site is
touched to second order a junction is known no better."""
ONE_VERTEX = 1e-10
"""Vertices closer than this part of the size are one."""


@dataclass(frozen=True, eq=False)
class Extracted:
    """Walls of one region.

    Args:
        points: (v, 3) of their vertices.
        radius: (v,) distance from the boundary.
        node: (v,) the boundary node that a vertex is, -1 for those inside.
        sites: of each vertex, all that are as near.
        triangles: (t, 3) vertices, all different.
        between: (t, 2) sites on both sides, lower first; normals point from it to the other.
        links: (t, 2) on trim surfaces the sites of which one takes over, -1 on sheets.
        tet: (t,) the tetrahedron, counted within the region's, that each triangle is in.
        lost: (v,) vertices that could not be placed well.
        pinned: (v,) vertices that stay where they are, as loci end there.
        passed, passing: edges (k, 2) of tetrahedra, as nodes, that lead through a third site's zone
            and whose vertex has no place, and points (k, 3) on them in that zone.
    """

    points: Array
    radius: Array
    node: Ints
    sites: list[tuple[int, ...]]
    triangles: Ints
    between: Ints
    links: Ints
    tet: Ints
    lost: Bools
    pinned: Bools
    passed: Ints
    passing: Array

    @classmethod
    def none(cls) -> Extracted:
        """The walls of a region that is not sampled."""
        places, pairs = np.empty((0, 3)), np.empty((0, 2), dtype=np.int64)
        numbers, no = np.empty(0, dtype=np.int64), np.empty(0, dtype=np.bool_)
        triangles = np.empty((0, 3), dtype=np.int64)
        return cls(
            places,
            np.empty(0),
            numbers,
            [],
            triangles,
            pairs,
            pairs,
            numbers,
            no,
            no,
            pairs,
            places,
        )

    def short_edges(self, least: float) -> Ints:
        """The edges (k, 2) that are no longer than a length."""
        edges = np.unique(np.sort(self.triangles[:, SIDES].reshape(-1, 2), axis=1), axis=0)
        length = norm(self.points[edges[:, 0]] - self.points[edges[:, 1]])
        return np.asarray(edges[length <= least])


def contracted(
    given: Extracted, wanted: Bools, short: Ints, least: float, placer: Placer
) -> Extracted:
    """Walls without some of their triangles and edges, as far as that changes nothing else.

    Args:
        given: the walls; vertices may be unused.
        wanted: (t,) triangles that are to go.
        short: (k, 2) edges that are to go.
        least: no shorter edge has a length.
        placer: of the region.
    """
    sites = list(given.sites)
    sheet, fixed = given.links[:, 0] < 0, (given.node >= 0) | given.pinned
    become = Contractor(
        given.points,
        sites,
        given.triangles,
        fixed,
        wanted,
        sheet,
        short,
        least,
        given.between,
        holding(given, placer),
    ).run()
    triangles = become[given.triangles]
    a, b, c = triangles.T
    rows = np.flatnonzero((a != b) & (b != c) & (c != a))
    rows = rows[_uncancelled(triangles[rows], given.between[rows])]
    used, which = np.unique(triangles[rows], return_inverse=True)
    return Extracted(
        given.points[used],
        given.radius[used],
        given.node[used],
        [sites[k] for k in used.tolist()],
        which.reshape(-1, 3),
        given.between[rows],
        given.links[rows],
        given.tet[rows],
        given.lost[used],
        given.pinned[used],
        given.passed,
        given.passing,
    )


def holding(given: Extracted, placer: Placer) -> Holds:
    """Which vertices of walls lie on which walls."""
    known: dict[tuple[int, int, int, bool], bool] = {}

    def holds(vertex: int, a: int, b: int, sheet: bool) -> bool:
        if {a, b} <= set(given.sites[vertex]):
            return True
        key = (vertex, a, b, sheet)
        if key not in known:
            known[key] = not given.lost[vertex] and placer.holds(
                given.points[vertex], float(given.radius[vertex]), (a, b), sheet
            )
        return known[key]

    return holds


def _uncancelled(triangles: Ints, between: Ints) -> Ints:
    """Rows of the triangles that do not lie on another one of the same wall, turned round."""
    ordered = np.sort(triangles, axis=1)
    turn = np.argmin(triangles, axis=1)
    second = np.take_along_axis(triangles, ((turn + 1) % 3)[:, None], axis=1)[:, 0]
    sense = np.where(second == ordered[:, 1], 1, -1)
    key = np.concatenate([ordered, between], axis=1)
    _, which = np.unique(key, axis=0, return_inverse=True)
    which = which.reshape(-1)
    net = np.bincount(which, weights=sense)
    taken = np.zeros(len(net), dtype=np.int64)
    rows = []
    for row, kind in enumerate(which.tolist()):
        if taken[kind] < abs(net[kind]) and sense[row] * net[kind] > 0:
            taken[kind] += 1
            rows.append(row)
    return np.array(rows, dtype=np.int64)
