"""The points, curves, surfaces and volumes on which Gmsh wants nodes and elements to lie.

Surfaces are the finest parts that groups join: each piece of a face or interface, each sheet.
Volumes are the regions, or the cells where groups are of cells. Curves are where the surfaces
meet or end: edges of triangles that are not between two triangles of one surface. Points are where
curves meet or end. Curves and points are numbered from 1.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_array  # type: ignore[import-untyped]
from scipy.sparse.csgraph import connected_components  # type: ignore[import-untyped]

from decomp.complex.model import SIDES
from decomp.meshes.curve_edges import curve_edges, is_point
from decomp.meshes.incidence import incidence, row_keys
from decomp.meshes.model import GroupKind, TetMesh
from decomp.vectors import Ints


@dataclass(frozen=True, eq=False)
class Entities:
    """Entities and where the nodes lie.

    Args:
        dimension: (n,) of the entity that holds each node: the lowest one.
        tag: (n,) its tag.
        points: (p,) the node of each point; its tag is its place, from 1.
        tets: (m,) the volume of each tetrahedron.
        triangles: (k,) the surface of each triangle.
        lines: (e,) the curve of each of the mesh's edge elements.
        nodes: (q,) the point of each of its node elements.
        bounds: for curves, surfaces and volumes (dimensions 1 to 3) the entities that bound them:
            by tag a list of tags, negative where an outward normal points into the volume.
    """

    dimension: Ints
    tag: Ints
    points: Ints
    tets: Ints
    triangles: Ints
    lines: Ints
    nodes: Ints
    bounds: tuple[dict[int, list[int]], dict[int, list[int]], dict[int, list[int]]]


def entities(mesh: TetMesh) -> Entities:
    """Find the curves and points of a mesh, and put each node on the entity of least dimension."""
    volume, surface = entity_tags(mesh)
    dimension = np.full(len(mesh.points), 3, dtype=np.int64)
    tag = np.zeros(len(mesh.points), dtype=np.int64)
    _place(tag, mesh.tets, volume)
    dimension[mesh.triangles] = 2
    _place(tag, mesh.triangles, surface)

    found = curve_edges(mesh.triangles, surface)
    ends = found.ends
    nodes, links = np.unique(ends, return_inverse=True)
    links = links.reshape(-1, 2)
    corner = is_point(links, found.of, len(nodes))
    curve = _connected(links, corner)
    for along in (*ends.T, *([found.middles] if mesh.order == 2 else [])):
        dimension[along], tag[along] = 1, curve + 1
    points = nodes[corner]
    dimension[points], tag[points] = 0, np.arange(1, len(points) + 1)

    at_end = corner[links]
    number = np.cumsum(corner, dtype=np.int64)
    curves = _listed(np.repeat(curve + 1, 2)[at_end.ravel()], number[links[at_end]])
    for loop in range(1, int(curve.max(initial=-1)) + 2):
        curves.setdefault(loop, [])
    of_node = np.zeros(len(mesh.points), dtype=np.int64)
    of_node[points] = np.arange(1, len(points) + 1)
    return Entities(
        dimension,
        tag,
        points,
        volume,
        surface,
        _curves_of(mesh.lines[:, :2], ends, curve),
        of_node[mesh.nodes],
        (curves, _surfaces(mesh, surface, ends, curve), _volumes(mesh, volume, surface)),
    )


def entity_tags(mesh: TetMesh) -> tuple[Ints, Ints]:
    """The volume (m,) of each tetrahedron, and the surface (k,) of each triangle."""
    parts = mesh.all_parts
    of_cells = any(group.kind is GroupKind.CELL for group in mesh.groups)
    return (parts.of_tets if of_cells else parts.region_of_tets), mesh.triangle_parts


def _curves_of(lines: Ints, ends: Ints, curve: Ints) -> Ints:
    """The curve (e,) on which each of some edges (e, 2) is."""
    keys = row_keys(np.concatenate([ends, lines]))
    known, own = keys[: len(ends)], keys[len(ends) :]
    order = np.argsort(known)
    return np.asarray(curve[order[np.searchsorted(known[order], own)]] + 1)


def _place(tag: Ints, elements: Ints, tags: Ints) -> None:
    """Give the nodes of elements their elements' tag, the least one where there are several."""
    order = np.argsort(-tags, kind="stable")
    tag[elements[order].reshape(-1)] = np.repeat(tags[order], elements.shape[1])


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


def _surfaces(mesh: TetMesh, surface: Ints, ends: Ints, curve: Ints) -> dict[int, list[int]]:
    """The curves that bound each surface."""
    edges = mesh.triangles[:, SIDES].reshape(-1, 2)
    keys = row_keys(np.concatenate([ends, edges]))
    known, own = keys[: len(ends)], keys[len(ends) :]
    order = np.argsort(known)
    slot = np.minimum(np.searchsorted(known[order], own), max(len(known) - 1, 0))
    hit = known[order][slot] == own if len(known) else np.zeros(len(own), dtype=np.bool_)
    tags = np.repeat(surface, 3)[hit]
    found = _listed(tags, curve[order[slot[hit]]] + 1)
    return {int(t): found.get(int(t), []) for t in np.unique(surface)}


def _volumes(mesh: TetMesh, volume: Ints, surface: Ints) -> dict[int, list[int]]:
    """The surfaces that bound each volume."""
    pairs = incidence(mesh.triangles, mesh.tets)
    sign = np.where(pairs.outward > 0, 1, -1)
    found = _listed(volume[pairs.tet], surface[pairs.triangle] * sign)
    result = {}
    for tag in np.unique(volume):
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
