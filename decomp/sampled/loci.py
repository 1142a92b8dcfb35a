"""Reflexive loci in walls: axes, spines and centres, from which a whole round face is as near.

Labels do not show them, as they lie inside one site's cell; they are known exactly. Where a part of
one ends a wall passes, of which the nearest vertex is moved there and stays. Along a part, vertices
of walls that are on it are its own, and what lies between them without a wall becomes a line.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from scipy.spatial import cKDTree  # type: ignore[import-untyped]

from decomp.complex.model import SIDES
from decomp.sampled.extracted import Extracted
from decomp.skeletons.balls.fields import site_fields
from decomp.skeletons.curves.incidence import Incidence
from decomp.skeletons.curves.reflexive import ReflexivePart
from decomp.vectors import Array, Ints, norm

ONE_POINT = 1e-9
"""Points closer than this part of the size are one."""
TIED = 1e-9
"""Sites are as near to the end of a locus to this part of the size."""
END_REACH = 3.0
"""A vertex is moved to the end of a locus over no more than so many of the edges there."""
MOST_PIECES = 2000


@dataclass(frozen=True, eq=False)
class Run:
    """A part of a locus as a chain of points.

    Args:
        part: of which it is a piece.
        points: (n, 3) in order; one for a centre.
        vertices: (n,) the vertex of the walls, or the boundary's node, that each is, -1 for none.
        closed: whether it leads back to its first point without passing any vertex.
    """

    part: ReflexivePart
    points: Array
    vertices: Ints
    closed: bool


def pinned_ends(
    incidence: Incidence, parts: Sequence[ReflexivePart], walls: Extracted
) -> Extracted:
    """Walls of which a vertex is at each end of each locus that a wall can pass."""
    size = incidence.boundary.diagonal
    points, radius, pinned = np.array(walls.points), np.array(walls.radius), np.array(walls.pinned)
    sites = list(walls.sites)
    on_sheet = np.zeros(len(points), dtype=np.bool_)
    on_sheet[walls.triangles[walls.links[:, 0] < 0]] = True
    edges = np.sort(walls.triangles[:, SIDES].reshape(-1, 2), axis=1)
    length = norm(points[edges[:, 0]] - points[edges[:, 1]])
    longest = np.zeros(len(points))
    np.maximum.at(longest, edges.reshape(-1), np.repeat(length, 2))
    become = np.arange(len(points))
    for part in parts:
        ends = part.ends if part.dimension else part.ends[:1]
        for end, other in zip(ends, part.others, strict=False):
            if part.dimension and other < 0:
                continue
            away = norm(points - end)
            here = np.flatnonzero(on_sheet & (away <= ONE_POINT * size))
            if not len(here):
                near = np.flatnonzero(
                    on_sheet & (walls.node < 0) & ~pinned & (away <= END_REACH * longest)
                )
                asked = {walls.sites[v] for v in near.tolist()}
                tied = {own: _tied(incidence, own, end) for own in asked}
                good = [v for v in near.tolist() if tied[walls.sites[v]]]
                if not good:
                    continue
                here = np.array([min(good, key=lambda v: (-len(walls.sites[v]), float(away[v])))])
                points[here[0]] = end
                radius[here[0]] = _distance(incidence, part.sites[0], end)
            pinned[here] = True
            for vertex in _others(incidence, walls, int(here[0]), end, END_REACH * longest):
                if not pinned[vertex] and walls.node[vertex] < 0:
                    become[vertex], sites[here[0]] = here[0], _united(sites, here[0], vertex)
    triangles = become[walls.triangles]
    a, b, c = triangles.T
    rows = np.flatnonzero((a != b) & (b != c) & (c != a))
    walls = replace(
        walls,
        triangles=triangles[rows],
        between=walls.between[rows],
        links=walls.links[rows],
        tet=walls.tet[rows],
        sites=sites,
    )
    return replace(walls, points=points, radius=radius, pinned=pinned)


def _others(
    incidence: Incidence, walls: Extracted, kept: int, end: Array, reach: Array
) -> list[int]:
    """Of each other sheet that comes to the end (3,) of a locus the nearest vertex.

    Two cones can have one tip, of which no edge leads from one to the other.
    """
    own = walls.triangles[walls.links[:, 0] < 0]
    between = walls.between[walls.links[:, 0] < 0]
    away = norm(walls.points - end)
    near = (away <= reach)[own].any(axis=1)
    own, between = own[near], between[near]
    at = (own == kept).any(axis=1)
    held = {tuple(pair) for pair in between[at].tolist()}
    found = []
    for pair in sorted({tuple(pair) for pair in between.tolist()} - held):
        if _tied(incidence, pair, end):
            vertices = np.unique(own[(between == pair).all(axis=1)])
            found.append(int(vertices[np.argmin(away[vertices])]))
    return found


def _united(sites: list[tuple[int, ...]], a: int, b: int) -> tuple[int, ...]:
    return tuple(sorted({*sites[a], *sites[b]}))


def _distance(incidence: Incidence, site: int, point: Array) -> float:
    feet = incidence.feet([site], point[None])[:, 0]
    which = np.array([site])
    found = site_fields(incidence.context, which, point[None], feet)
    return float(found.distance[0])


def _tied(incidence: Incidence, sites: tuple[int, ...], point: Array) -> bool:
    """Whether all of some sites are as near to a point (3,)."""
    away = [_distance(incidence, site, point) for site in sites]
    return max(away) - min(away) <= TIED * incidence.boundary.diagonal


def runs(
    parts: Sequence[ReflexivePart],
    points: Array,
    triangles: Ints,
    fixed: Ints,
    size: float,
    spacing: float,
) -> list[Run]:
    """What of some loci is on no wall, in pieces between the walls' vertices.

    Args:
        parts: of the loci.
        points: (n, 3).
        triangles: (t, 3) of sheets.
        fixed: (k,) other points in which loci may end, such as vertices of the boundary.
        size: the region's diagonal.
        spacing: about the length of chords.
    """
    used = np.unique(triangles)
    edges = {
        tuple(e)
        for e in np.unique(np.sort(triangles[:, SIDES].reshape(-1, 2), axis=1), axis=0).tolist()
    }
    candidates = np.concatenate([used, np.setdiff1d(fixed, used)])
    tree = cKDTree(points[candidates]) if len(candidates) else None
    found = []
    for part in parts:
        if not part.dimension:
            at = tree.query(part.ends[0])[0] if tree is not None else np.inf
            if at > ONE_POINT * size:
                found.append(Run(part, part.ends[:1], np.array([-1]), False))
            continue
        found += _pieces(part, points, candidates, edges, size, spacing)
    return found


def _pieces(
    part: ReflexivePart,
    points: Array,
    candidates: Ints,
    edges: set[tuple[int, ...]],
    size: float,
    spacing: float,
) -> list[Run]:
    locus = part.locus
    assert locus is not None
    u = np.asarray(locus.parameter(points[candidates]))
    if locus.closed:
        period = locus.span[1] - locus.span[0]
        u = part.start + np.mod(u - part.start + ONE_POINT * size, period) - ONE_POINT * size
    within = (u >= part.start - ONE_POINT * size) & (u <= part.end + ONE_POINT * size)
    within &= norm(locus.point(u) - points[candidates]) <= ONE_POINT * size
    rows = np.flatnonzero(within)
    rows = rows[np.argsort(u[rows], kind="stable")]
    stops = [(float(u[k]), int(candidates[k])) for k in rows.tolist()]
    if part.closed:
        if not stops:
            return [_run(part, part.start, part.end, -1, -1, spacing, True)]
        stops.append((stops[0][0] + part.end - part.start, stops[0][1]))
    else:
        if not stops or stops[0][0] > part.start + ONE_POINT * size:
            stops.insert(0, (part.start, -1))
        if stops[-1][0] < part.end - ONE_POINT * size:
            stops.append((part.end, -1))
    found = []
    for (a, v), (b, w) in pairwise(stops):
        if v < 0 or w < 0 or (min(v, w), max(v, w)) not in edges:
            found.append(_run(part, a, b, v, w, spacing, False))
    return found


def _run(
    part: ReflexivePart, a: float, b: float, v: int, w: int, spacing: float, closed: bool
) -> Run:
    assert part.locus is not None
    count = int(np.clip(np.ceil((b - a) / spacing), 4 if closed else 1, MOST_PIECES))
    points = part.locus.point(np.linspace(a, b, count + 1))
    vertices: Ints = np.full(count + 1, -1, dtype=np.int64)
    vertices[0], vertices[-1] = v, w
    return Run(part, points, vertices, closed)


def welded(found: Sequence[Run], size: float, first: int) -> tuple[Array, list[Ints]]:
    """Number the points of runs that are no vertices yet, one number for each place.

    Returns:
        the new points (k, 3), numbered from `first`, and the numbers (n,) of each run's points.
    """
    new: list[Array] = []
    chains = []
    for run in found:
        chain = np.array(run.vertices)
        for k in np.flatnonzero(chain < 0).tolist():
            if run.closed and k == len(chain) - 1:
                chain[k] = chain[0]
                continue
            end = k in (0, len(chain) - 1)
            same = [
                i for i, p in enumerate(new) if end and norm(p - run.points[k]) <= ONE_POINT * size
            ]
            if not same:
                same = [len(new)]
                new.append(run.points[k])
            chain[k] = first + same[0]
        chains.append(chain)
    return np.array(new).reshape(-1, 3), chains
