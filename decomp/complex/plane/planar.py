"""Constrained Delaunay triangulation of a plane, a periodic strip or a flat torus.

A periodic domain is triangulated as several copies side by side, of which one representative of
each triangle is kept. Every point is moved by a tiny amount that is the same in all copies, so that
four points on a circle are split alike everywhere.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product
from typing import Any

import numpy as np
import pythoncdt
from scipy.sparse import coo_array  # type: ignore[import-untyped]
from scipy.sparse.csgraph import connected_components  # type: ignore[import-untyped]

from decomp.complex.plane.crossings import PLANE, Period, crossings
from decomp.errors import GeometryError
from decomp.vectors import Array, Bools, Ints

__all__ = [
    "PLANE",
    "Period",
    "SparseError",
    "Triangulation",
    "components",
    "crossings",
    "triangulate",
]

COPIES = (1, 2, 4)
"""Copies on either side of the middle one that are tried in turn."""
JITTER = 1e-10
"""How far points of a periodic domain are moved, in units of the least period."""
GUARDS = 12
"""Points per period of the rows that close a strip on either side."""


class MergedError(GeometryError):
    """Points of a plane domain coincide."""


class SparseError(GeometryError):
    """A periodic domain has too few points to be triangulated; more of them help.

    Args:
        message: what is wrong.
        spots: (k, 2) of the domain where points would help, as far as that is known.
    """

    def __init__(self, message: str, spots: Array | None = None) -> None:
        super().__init__(message)
        self.spots: Array = np.empty((0, 2)) if spots is None else spots


@dataclass(frozen=True, eq=False)
class Triangulation:
    """Triangles between points of a plane domain.

    Args:
        triangles: (m, 3) indices of points, counterclockwise.
        component: (m,) which of the parts, into which the constraints cut the domain, a triangle
            belongs to, from 0; -1 outside all constraints (only in a domain without a period).
        corners: (m, 3, 2) coordinates of the corners; in a periodic domain unwrapped, so that a
            triangle's corners are close together and its centroid is within the first period.
    """

    triangles: Ints
    component: Ints
    corners: Array

    @property
    def centroids(self) -> Array:
        """(m, 2)."""
        return np.asarray(self.corners.mean(axis=1))

    @property
    def components(self) -> int:
        """Number of parts, that outside all constraints not counted."""
        return int(self.component.max(initial=-1)) + 1


def triangulate(points: Array, segments: Ints, period: Period = PLANE) -> Triangulation:
    """Triangulate all points, with the segments among the edges.

    Without a period the triangles fill the convex hull. With one period the part that reaches out
    to infinity is left out, and with it points that lie in no closed part. With two periods the
    triangles cover the whole torus.

    Args:
        points: (n, 2), pairwise different.
        segments: (k, 2) indices of points; none crosses or touches another one except at common
            ends. Across a period they take the shorter way round.
        period: of the first and second coordinate, None where there is none.

    Raises:
        GeometryError: points coincide or segments cross.
        SparseError: a periodic domain has too few points.
    """
    points = np.asarray(points, dtype=np.float64).reshape(-1, 2)
    segments = np.asarray(segments, dtype=np.int64).reshape(-1, 2)
    if period == PLANE:
        return _plane(points, segments)
    for around in COPIES[:-1]:
        try:
            return _periodic(points, segments, period, around)
        except SparseError:
            continue
    return _periodic(points, segments, period, COPIES[-1])


def _plane(points: Array, segments: Ints) -> Triangulation:
    if len(points) < 3:
        raise GeometryError(f"{len(points)} points of a plane domain have no triangulation")
    triangles, fixed = _delaunay(points, segments)
    if not len(triangles):
        raise GeometryError("all points of a plane domain lie on one line")
    part, loose = _parts(triangles, fixed, len(points))
    return Triangulation(triangles, _numbered(part, ~np.isin(part, loose)), points[triangles])


def _periodic(points: Array, segments: Ints, period: Period, around: int) -> Triangulation:
    n = len(points)
    if n < 3:
        raise SparseError(f"{n} points of a periodic domain have no triangulation")
    base = np.array([p or np.inf for p in period])
    cyclic = np.isfinite(base)
    home = np.where(cyclic, np.mod(points, np.where(cyclic, base, 1.0)), points)
    guards = _guards(home, base) if not cyclic.all() else np.empty((0, 2))
    row = np.arange(len(guards)).reshape(2, -1) + n
    rails = np.stack([row, np.roll(row, -1, axis=1)], axis=-1).reshape(-1, 2)
    home = np.concatenate([home + _jitter(n, float(base.min())), guards])
    segments = np.concatenate([segments, rails])

    copies = list(product(*(range(-around, around + 1) if c else (0,) for c in cyclic)))
    shifts = np.array(copies)
    laid = home[None] + np.where(cyclic, shifts, 0)[:, None] * np.where(cyclic, base, 0.0)
    triangles, fixed = _delaunay(
        laid.reshape(-1, 2), _copied(segments, home, base, shifts, len(home))
    )

    # one representative of each triangle: the one whose least vertex is in the middle copy
    vertex, copy = triangles % len(home), triangles // len(home)
    rows = np.arange(len(triangles))
    middle = copies.index((0, 0))
    keep = copy[rows, np.argmin(vertex, axis=1)] == middle
    coordinates = laid.reshape(-1, 2)[triangles[keep]]
    vertex = vertex[keep]
    ends = np.stack([triangles[keep], np.roll(triangles[keep], -1, axis=1)], axis=-1)
    turns_of = [_turned(edges, shifts, len(home)) for edges in (ends, fixed)]
    fixed = fixed % len(home)
    part, _ = _parts(vertex, fixed, len(home), *turns_of)
    fixed = np.unique(np.sort(fixed, axis=1), axis=0)
    outer = np.unique(part[(vertex >= n).any(axis=1)])
    inner = ~np.isin(part, outer)
    vertex, part, coordinates = vertex[inner], part[inner], coordinates[inner]
    _check(vertex, coordinates, fixed, n, bool(cyclic.all()))
    turns = np.floor(coordinates.mean(axis=1) / np.where(cyclic, base, 1.0))
    coordinates = (
        coordinates - (np.where(cyclic, turns * np.where(cyclic, base, 0.0), 0.0))[:, None]
    )
    return Triangulation(vertex, _numbered(part, np.ones(len(part), dtype=np.bool_)), coordinates)


def _guards(home: Array, base: Array) -> Array:
    """Two rows of points that run around a strip below and above everything."""
    along = int(np.argmin(base))
    across = 1 - along
    gap = base[along] / GUARDS
    low, high = home[:, across].min(), home[:, across].max()
    guards = np.empty((2, GUARDS, 2))
    guards[..., along] = (np.arange(GUARDS) + 0.37) * gap
    guards[0, :, across], guards[1, :, across] = low - gap, high + gap
    return guards.reshape(-1, 2)


def _jitter(n: int, scale: float) -> Array:
    """Offsets (n, 2) that differ from point to point: multiples of two irrational numbers."""
    steps = np.arange(1, n + 1)[:, None] * np.array([0.7548776662466927, 0.5698402909980532])
    return np.asarray(JITTER * scale * (np.mod(steps, 1.0) - 0.5))


def _copied(segments: Ints, home: Array, base: Array, shifts: Ints, n: int) -> Ints:
    """The segments of all copies that end inside the copies laid out."""
    cyclic = np.isfinite(base)
    apart = home[segments[:, 1]] - home[segments[:, 0]]
    turns = np.where(cyclic, -np.round(apart / np.where(cyclic, base, 1.0)), 0.0).astype(np.int64)
    number = {(int(a), int(b)): k for k, (a, b) in enumerate(shifts)}
    result = []
    for (a, b), k in number.items():
        other = np.array([number.get((a + int(s), b + int(t)), -1) for s, t in turns])
        inside = other >= 0
        result.append(
            np.stack([segments[inside, 0] + k * n, segments[inside, 1] + other[inside] * n], axis=1)
        )
    return np.concatenate(result)


def _check(triangles: Ints, corners: Array, fixed: Ints, n: int, closed: bool) -> None:
    """Raise SparseError unless the triangles form a surface whose border is constrained."""
    problem = "a periodic domain has too few points: "
    if closed and not len(triangles):
        raise SparseError(problem + "no triangle fits")
    ends = np.roll(triangles, -1, axis=1)
    halfway = (corners + np.roll(corners, -1, axis=1)) / 2
    around = triangles == ends
    if around.any():
        raise SparseError(problem + "a triangle goes all the way round", halfway[around])
    forth, back = (triangles * n + ends).ravel(), (ends * n + triangles).ravel()
    _, inverse, count = np.unique(forth, return_inverse=True, return_counts=True)
    if (count > 1).any():
        double = (count > 1)[inverse.ravel()]
        raise SparseError(problem + "triangles overlap", halfway.reshape(-1, 2)[double])
    border = ~np.isin(forth, back)
    if closed and border.any():
        raise SparseError(problem + "its triangles leave a gap")
    if closed and n - len(forth) // 2 + len(triangles) != 0:
        raise SparseError(problem + "its triangles do not form a torus")
    walls = np.concatenate([fixed[:, 0] * n + fixed[:, 1], fixed[:, 1] * n + fixed[:, 0]])
    if not np.isin(forth[border], walls).all():
        raise SparseError(problem + "its triangles leave a gap beside the constraints")


def _delaunay(points: Array, segments: Ints) -> tuple[Ints, Ints]:
    """Triangles (m, 3), and the constrained edges (k, 2) as they were cut at points on them."""
    made: Any = pythoncdt.Triangulation(
        pythoncdt.VertexInsertionOrder.AUTO, pythoncdt.IntersectingConstraintEdges.NOT_ALLOWED, 0.0
    )
    try:
        made.insert_vertices(np.ascontiguousarray(points))
        if len(segments):
            made.insert_edges(np.ascontiguousarray(segments, dtype=np.uint32))
        made.erase_super_triangle()
    except RuntimeError as failure:
        if len(np.unique(points, axis=0)) < len(points):
            raise MergedError("points of a plane domain coincide") from failure
        raise GeometryError(f"a plane domain: {str(failure).splitlines()[0]}") from failure
    triangles = made.triangles_array()["vertices"].astype(np.int64)
    fixed = np.array([(edge.v1, edge.v2) for edge in made.fixed_edges], dtype=np.int64)
    return triangles, fixed.reshape(-1, 2)


def _turned(ends: Ints, shifts: Ints, n: int) -> Ints:
    """Numbers (...) that tell how many periods lie between edges' ends (..., 2).

    The ends are in copies of n points; it is counted from the end with the lower number.
    """
    low = ends[..., :1] % n <= ends[..., 1:] % n
    way = np.where(low, 1, -1)
    apart = way * (shifts[ends[..., 1] // n] - shifts[ends[..., 0] // n])
    most = 2 * int(np.abs(shifts).max()) + 1
    return np.asarray((apart[..., 0] + most) * (2 * most + 1) + apart[..., 1] + most)


def _parts(
    triangles: Ints,
    fixed: Ints,
    n: int,
    turned: Ints | None = None,
    fixed_turned: Ints | None = None,
) -> tuple[Ints, Ints]:
    """For each triangle its part between constraints; and the parts with a free border edge.

    Two edges between the same points may go different ways around a period; numbers for the edges
    (m, 3) of triangles, each from its corner on, and for those fixed tell them apart.
    """
    ends = np.roll(triangles, -1, axis=1)
    keys = np.minimum(triangles, ends) * n + np.maximum(triangles, ends)
    walls = fixed.min(axis=1) * n + fixed.max(axis=1)
    if turned is not None and fixed_turned is not None:
        most = int(max(turned.max(initial=0), fixed_turned.max(initial=0))) + 1
        keys, walls = keys * most + turned, walls * most + fixed_turned
    edges, edge, count = np.unique(keys, return_inverse=True, return_counts=True)
    edge = edge.reshape(keys.shape)
    open_edge: Bools = ~np.isin(edges, walls)
    passing = open_edge[edge]
    owner = np.broadcast_to(np.arange(len(triangles))[:, None], keys.shape)
    size = len(triangles) + len(edges)
    links = coo_array(
        (np.ones(int(passing.sum())), (owner[passing], len(triangles) + edge[passing])),
        shape=(size, size),
    )
    part = connected_components(links, directed=False)[1][: len(triangles)].astype(np.int64)
    loose = part[(passing & (count == 1)[edge]).any(axis=1)]
    return part, np.unique(loose)


def components(triangles: Ints, segments: Ints, count: int) -> Ints:
    """The part (m,) between segments that each triangle belongs to, from 0.

    Args:
        triangles: (m, 3) indices of points.
        segments: (k, 2) across which triangles do not belong together.
        count: number of points.
    """
    part, _ = _parts(triangles, segments, count)
    return _numbered(part, np.ones(len(part), dtype=np.bool_))


def _numbered(part: Ints, kept: Bools) -> Ints:
    """Parts numbered from 0 in order of their first triangles, -1 where they are not kept."""
    result = np.full(len(part), -1, dtype=np.int64)
    _, first, inverse = np.unique(part[kept], return_index=True, return_inverse=True)
    rank = np.empty(len(first), dtype=np.int64)
    rank[np.argsort(first)] = np.arange(len(first))
    result[kept] = rank[inverse]
    return result
