"""Edges of triangles where surfaces meet or end, and the points where such curves meet or end."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from decomp.complex.model import SIDES
from decomp.meshes.incidence import row_keys
from decomp.vectors import Bools, Ints


@dataclass(frozen=True, eq=False)
class CurveEdges:
    """Edges that are not between two triangles of one surface.

    Args:
        ends: (e, 2) nodes.
        middles: (e,) nodes in their middles; 0 of straight triangles.
        sets: the different sets of surfaces that meet in them, as ascending tags.
        of: (e,) which set is each one's.
    """

    ends: Ints
    middles: Ints
    sets: tuple[tuple[int, ...], ...]
    of: Ints


@dataclass(frozen=True, eq=False)
class CurvePoints:
    """Nodes at which there are not two curve edges, or of different surfaces.

    Args:
        nodes: (p,) ascending.
        sets: the different sets of surfaces that meet in them, as ascending tags.
        of: (p,) which set is each one's.
    """

    nodes: Ints
    sets: tuple[tuple[int, ...], ...]
    of: Ints


def curve_edges(triangles: Ints, tags: Ints) -> CurveEdges:
    """Find them among the edges of triangles (k, 3) or (k, 6) of surfaces told by tags (k,)."""
    edges = triangles[:, SIDES].reshape(-1, 2)
    tags = np.repeat(tags, 3)
    middles = triangles[:, 3:].reshape(-1) if triangles.shape[1] == 6 else np.zeros_like(tags)
    _, edge, count = np.unique(row_keys(edges), return_inverse=True, return_counts=True)
    order = np.lexsort([tags, edge])
    start = np.cumsum(count) - count
    place = np.arange(len(order)) - np.repeat(start, count)
    around = np.zeros((len(count), int(count.max(initial=0))), dtype=np.int64)
    around[edge[order], place] = tags[order]
    inner = (count == 2) & (around[:, :1] == around[:, 1:2]).all(axis=1)
    kept = order[start[~inner]]
    rows, of = np.unique(around[~inner], axis=0, return_inverse=True)
    sets = tuple(tuple(sorted(set(row) - {0})) for row in rows.tolist())
    return CurveEdges(edges[kept], middles[kept], sets, of.reshape(-1).astype(np.int64))


def is_point(links: Ints, meeting: Ints, count: int) -> Bools:
    """Which of `count` nodes are points.

    Args:
        links: (e, 2) nodes of curve edges.
        meeting: (e,) a number for the set of surfaces at each.
        count: of nodes.
    """
    flat, both = links.reshape(-1), np.repeat(meeting, 2)
    degree = np.bincount(flat, minlength=count)
    low, high = np.full(count, np.iinfo(np.int64).max), np.full(count, -1)
    np.minimum.at(low, flat, both)
    np.maximum.at(high, flat, both)
    return np.asarray((degree != 2) | (low != high))


def points_of(curves: CurveEdges) -> CurvePoints:
    """The points where curves meet or end."""
    nodes, links = np.unique(curves.ends, return_inverse=True)
    links = links.reshape(-1, 2)
    here = np.flatnonzero(is_point(links, curves.of, len(nodes)))
    around: dict[int, set[int]] = {int(k): set() for k in here}
    at = np.isin(links, here)
    for row, end in zip(*np.nonzero(at), strict=True):
        around[int(links[row, end])].update(curves.sets[curves.of[row]])
    every = [tuple(sorted(around[int(k)])) for k in here]
    sets = tuple(sorted(set(every)))
    number = {own: k for k, own in enumerate(sets)}
    return CurvePoints(nodes[here], sets, np.array([number[own] for own in every], dtype=np.int64))
