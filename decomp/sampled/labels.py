"""Which site each node of tetrahedra is nearest to.

A node on the boundary is as near to several sites where faces meet. It bears one of them as its
label and knows them all: walls between two of them end in it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from decomp.boundary.topology import Edge
from decomp.sampled.bisecting import Bisected
from decomp.skeletons.balls.queries import RegionQueries
from decomp.skeletons.curves.incidence import Incidence
from decomp.vectors import Array, Bools, Ints, norm

NODE_ON_EDGE = 1e-8
"""Nodes nearer to an edge or vertex than this part of the region's diagonal are on it."""


@dataclass(frozen=True, eq=False)
class Labels:
    """The labels of the nodes of one region.

    Args:
        site: (n,) the label of each node, -1 for nodes of other regions.
        distance: (n,) from the region's boundary, 0 on it.
        touching: for each node at which several sites meet these, all of them.
    """

    site: Ints
    distance: Array
    touching: dict[int, frozenset[int]]

    def at(self, node: int) -> frozenset[int]:
        """All sites that a node is known to be as near to."""
        return self.touching.get(node) or frozenset([int(self.site[node])])


class Labeller:
    """Labels nodes of one region.

    Args:
        queries: of the region.
        incidence: of the region.
        face_of_patch: the face of the region on each patch of the boundaries, -1 for none.
    """

    def __init__(self, queries: RegionQueries, incidence: Incidence, face_of_patch: Ints) -> None:
        self._queries, self._incidence = queries, incidence
        self._face_of_patch = face_of_patch
        self._slack = NODE_ON_EDGE * incidence.boundary.diagonal

    def labels(self, mesh: Bisected, known: Labels | None) -> Labels:
        """The labels of all nodes; those of the first that are known are kept."""
        it = self._incidence
        count = len(mesh.points)
        site: Ints = np.full(count, -1, dtype=np.int64)
        distance = np.zeros(count)
        touching: dict[int, frozenset[int]] = {}
        first = 0
        if known is not None:
            first = len(known.site)
            site[:first], distance[:first] = known.site, known.distance
            touching = dict(known.touching)
        inside = np.zeros(count, dtype=np.bool_)
        inside[mesh.tets[mesh.region == it.region]] = True
        face = self._face_of_patch[mesh.patches]
        own = np.flatnonzero(face >= 0)
        pairs = np.stack([mesh.triangles[own].reshape(-1), np.repeat(face[own], 3)], axis=1)
        pairs = np.unique(pairs[pairs[:, 0] >= first], axis=0)
        nodes, start, many = np.unique(pairs[:, 0], return_index=True, return_counts=True)
        inside[nodes] = False
        faces = np.array([it.face_site[k] for k in range(len(it.boundary.faces))])
        site[nodes] = faces[pairs[start, 1]]
        for row in np.flatnonzero(many > 1).tolist():
            around = pairs[start[row] : start[row] + many[row], 1].tolist()
            node = int(nodes[row])
            best, touching[node] = self._meeting(mesh.points[node], around)
            site[node] = best
        rows = first + np.flatnonzero(inside[first:])
        found = self._queries.nearest(mesh.points[rows])
        site[rows], distance[rows] = found.site, found.distance
        return Labels(site, distance, touching)

    def _meeting(self, point: Array, faces: list[int]) -> tuple[int, frozenset[int]]:
        """The label of a node at which faces meet, and all sites there."""
        it = self._incidence
        every = {it.face_site[face] for face in faces}
        edges = {e for face in faces for e in it.edges_of_face[face]}
        vertices = {v for e in edges for v in it.boundary.edges[e].vertices or ()}
        at = [v for v in vertices if norm(it.boundary.vertices[v].point - point) <= self._slack]
        if at:
            vertex = it.boundary.vertices[at[0]]
            every |= {it.face_site[face] for face in vertex.faces}
            on = [e for e in vertex.edges if e in it.edge_site]
        else:
            near = [e for e in edges if e in it.edge_site]
            near = [e for e in near if set(it.boundary.edges[e].faces) <= set(faces)]
            on = [e for e in near if on_edge(it.boundary.edges[e], point[None], self._slack)[0]]
        every |= {it.edge_site[e] for e in on}
        corners = [it.vertex_site[v] for v in at if v in it.vertex_site]
        every |= set(corners)
        best = corners or sorted(it.edge_site[e] for e in on) or sorted(every)
        return best[0], frozenset(every)


def on_edge(edge: Edge, points: Array, slack: float) -> Bools:
    """Which points (k, 3) of an edge's faces are on the edge."""
    t = edge.curve.parameter(points)
    near = norm(edge.curve.point(t) - points) <= slack
    if edge.closed:
        return np.asarray(near)
    ends = edge.samples[[0, -1]]
    at_end = norm(points[:, None] - ends[None]).min(axis=1) <= slack
    if edge.curve.closed:
        inner = np.mod(t - edge.start, edge.curve.period) <= edge.end - edge.start
    else:
        inner = (t >= edge.start) & (t <= edge.end)
    return np.asarray(near & (inner | at_end))
