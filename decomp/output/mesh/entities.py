"""The points, curves, surfaces and volumes on which Gmsh wants nodes and elements to lie.

Surfaces and volumes are the mesh's groups, with the groups' tags. Curves are where the surfaces
meet or end: edges of triangles that are not between two triangles of one surface. Points are where
curves meet or end. Curves and points are numbered from 1 and are in no physical group.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_array  # type: ignore[import-untyped]
from scipy.sparse.csgraph import connected_components  # type: ignore[import-untyped]

from decomp.tetra.incidence import incidence, row_keys
from decomp.tetra.mesh import TetMesh
from decomp.vectors import Ints

EDGES: Ints = np.array([[0, 1], [1, 2], [2, 0]])


@dataclass(frozen=True, eq=False)
class Entities:
    """Entities and where the nodes lie.

    Args:
        dimension: (n,) of the entity that holds each node: the lowest one.
        tag: (n,) its tag.
        points: (p,) the node of each point; its tag is its place, from 1.
        bounds: for curves, surfaces and volumes (dimensions 1 to 3) the entities that bound them:
            by tag a list of tags, negative where an outward normal points into the volume.
    """

    dimension: Ints
    tag: Ints
    points: Ints
    bounds: tuple[dict[int, list[int]], dict[int, list[int]], dict[int, list[int]]]


def entities(mesh: TetMesh) -> Entities:
    """Find the curves and points of a mesh, and put each node on the entity of least dimension."""
    dimension = np.full(len(mesh.points), 3, dtype=np.int64)
    tag = np.zeros(len(mesh.points), dtype=np.int64)
    _place(tag, mesh.tets, mesh.tet_tags)
    dimension[mesh.triangles] = 2
    _place(tag, mesh.triangles, mesh.triangle_tags)

    ends, middle, meeting = _curve_edges(mesh)
    nodes, links = np.unique(ends, return_inverse=True)
    links = links.reshape(-1, 2)
    corner = _corners(links, meeting, len(nodes))
    curve = _connected(links, corner)
    for along in (*ends.T, *([middle] if mesh.order == 2 else [])):
        dimension[along], tag[along] = 1, curve + 1
    points = nodes[corner]
    dimension[points], tag[points] = 0, np.arange(1, len(points) + 1)

    at_end = corner[links]
    number = np.cumsum(corner)
    curves = _listed(np.repeat(curve + 1, 2)[at_end.ravel()], number[links[at_end]])
    for loop in range(1, int(curve.max(initial=-1)) + 2):
        curves.setdefault(loop, [])
    return Entities(dimension, tag, points, (curves, _surfaces(mesh, ends, curve), _volumes(mesh)))


def _place(tag: Ints, elements: Ints, tags: Ints) -> None:
    """Give the nodes of elements their elements' tag, the least one where there are several."""
    order = np.argsort(-tags, kind="stable")
    tag[elements[order].reshape(-1)] = np.repeat(tags[order], elements.shape[1])


def _curve_edges(mesh: TetMesh) -> tuple[Ints, Ints, Ints]:
    """Edges (e, 2) on curves, their middle nodes (e,), and numbers (e,) of the sets of surfaces."""
    edges = mesh.triangles[:, EDGES].reshape(-1, 2)
    tags = np.repeat(mesh.triangle_tags, 3)
    middles = mesh.triangles[:, 3:].reshape(-1) if mesh.order == 2 else np.zeros_like(tags)
    _, edge, count = np.unique(row_keys(edges), return_inverse=True, return_counts=True)
    order = np.lexsort([tags, edge])
    start = np.cumsum(count) - count
    place = np.arange(len(order)) - np.repeat(start, count)
    around = np.zeros((len(count), int(count.max(initial=0))), dtype=np.int64)
    around[edge[order], place] = tags[order]
    inner = (count == 2) & (around[:, :1] == around[:, 1:2]).all(axis=1)
    kept = order[start[~inner]]
    sets = np.unique(around[~inner], axis=0, return_inverse=True)[1].reshape(-1)
    return edges[kept], middles[kept], sets.astype(np.int64)


def _corners(links: Ints, meeting: Ints, count: int) -> np.ndarray:
    """Which nodes (count,) are points: not two curve edges there, or of different surfaces."""
    flat, both = links.reshape(-1), np.repeat(meeting, 2)
    degree = np.bincount(flat, minlength=count)
    low, high = np.full(count, np.iinfo(np.int64).max), np.full(count, -1)
    np.minimum.at(low, flat, both)
    np.maximum.at(high, flat, both)
    return np.asarray((degree != 2) | (low != high))


def _connected(links: Ints, corner: np.ndarray) -> Ints:
    """Number (e,) the curves: edges that follow each other through nodes that are no points."""
    edges = np.arange(len(links))
    inner = ~corner[links]
    rows, nodes = np.repeat(edges, 2)[inner.ravel()], links[inner]
    # a bipartite graph of edges and the nodes that join them
    size = len(links) + len(corner)
    graph = coo_array((np.ones(len(rows)), (rows, len(links) + nodes)), shape=(size, size))
    found = connected_components(graph, directed=False)[1][: len(links)]
    return np.unique(found, return_inverse=True)[1].astype(np.int64)


def _surfaces(mesh: TetMesh, ends: Ints, curve: Ints) -> dict[int, list[int]]:
    """The curves that bound each surface."""
    edges = mesh.triangles[:, EDGES].reshape(-1, 2)
    keys = row_keys(np.concatenate([ends, edges]))
    known, own = keys[: len(ends)], keys[len(ends) :]
    order = np.argsort(known)
    slot = np.minimum(np.searchsorted(known[order], own), max(len(known) - 1, 0))
    hit = known[order][slot] == own if len(known) else np.zeros(len(own), dtype=np.bool_)
    tags = np.repeat(mesh.triangle_tags, 3)[hit]
    found = _listed(tags, curve[order[slot[hit]]] + 1)
    return {int(t): found.get(int(t), []) for t in np.unique(mesh.triangle_tags)}


def _volumes(mesh: TetMesh) -> dict[int, list[int]]:
    """The surfaces that bound each volume."""
    pairs = incidence(mesh.triangles, mesh.tets)
    sign = np.where(pairs.outward > 0, 1, -1)
    found = _listed(mesh.tet_tags[pairs.tet], mesh.triangle_tags[pairs.triangle] * sign)
    result = {}
    for tag in np.unique(mesh.tet_tags):
        both = found.get(int(tag), [])
        # a sheet with the volume on both sides bounds it once
        result[int(tag)] = [t for t in both if t > 0 or -t not in both]
    return result


def _listed(keys: Ints, values: Ints) -> dict[int, list[int]]:
    """The different values of each key, in ascending order."""
    result: dict[int, list[int]] = {}
    for key, value in np.unique(np.stack([keys, values], axis=1), axis=0).tolist():
        result.setdefault(key, []).append(value)
    return result
