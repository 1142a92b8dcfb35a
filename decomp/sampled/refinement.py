"""Tetrahedra made fine where labels ask for it.

Edges of the boundary are followed within the chord tolerance. Then:

1. Where walls are, edges are no longer than a part of the ball's radius, down to a floor.
2. An edge whose middle is nearest to a third site is too long, down to half the floor.
3. No edge leads along a face from one of its edges to another without a node between.
4. Where the zone of a reentrant edge or vertex is pinched off between two faces, a node is put
   into it.
"""

from __future__ import annotations

import numpy as np

from decomp.sampled.bisecting import TET_EDGES, Bisected
from decomp.sampled.crossings import crossings
from decomp.sampled.labels import Labeller, Labels
from decomp.sampled.placing import Placer
from decomp.skeletons.balls.queries import RegionQueries
from decomp.vectors import Array, Bools, Ints, norm

OF_RADIUS = 0.7
"""Edges at walls are no longer than this part of the radius."""
ODD = 0.5
"""Edges past a third site are made no shorter than this part of the floor."""
REFINING_ROUNDS = 60
PINCHES = 12


class Refiner:
    """Refines the tetrahedra of one region.

    Args:
        queries, labeller, placer: of the region.
        region: its index.
    """

    def __init__(
        self, queries: RegionQueries, labeller: Labeller, placer: Placer, region: int
    ) -> None:
        self._queries, self._labeller, self._placer = queries, labeller, placer
        self._region = region

    def refined(self, mesh: Bisected, labels: Labels, floor: float, chord: float) -> Labels:
        """Refine; the labels of all nodes then.

        Args:
            mesh: is refined.
            labels: of its nodes.
            floor: a length.
            chord: how far chords may be off the edges of the boundary.
        """
        for _ in range(REFINING_ROUNDS):
            edges, which = mesh.edges()
            bent = mesh.sagitta(edges) > chord
            if not bent.any():
                break
            mesh.halve(edges, which, bent)
        labels = self._labeller.labels(mesh, labels)
        for _ in range(REFINING_ROUNDS):
            wide = self._too_wide(mesh, labels, floor)
            if wide.any():
                mesh.shorten(wide)
            elif not self._mended(mesh, labels, floor):
                break
            labels = self._labeller.labels(mesh, labels)
        for _ in range(PINCHES):
            if not self._unpinched(mesh, labels):
                break
            labels = self._labeller.labels(mesh, labels)
        return labels

    def _too_wide(self, mesh: Bisected, labels: Labels, floor: float) -> Bools:
        at = labels.site[mesh.tets]
        mixed = (at != at[:, :1]).any(axis=1) & (mesh.region == self._region)
        corners = mesh.points[mesh.tets]
        longest = norm(corners[:, TET_EDGES[:, 0]] - corners[:, TET_EDGES[:, 1]]).max(axis=1)
        radius = labels.distance[mesh.tets].max(axis=1)
        return np.asarray(mixed & (longest > np.maximum(OF_RADIUS * radius, floor)))

    def _mended(self, mesh: Bisected, labels: Labels, floor: float) -> bool:
        """Halve edges for the second and third rule; whether there were any."""
        edges, which = mesh.edges()
        own = np.zeros(len(edges), dtype=np.bool_)
        own[which[mesh.region == self._region]] = True
        a, b = labels.site[edges].T
        split = own & mesh.boundary_edges(edges) & ~mesh.line_edges(edges)
        for k in np.flatnonzero(split).tolist():
            u, v = edges[k].tolist()
            split[k] = u in labels.touching and v in labels.touching
        if split.any():
            mesh.halve(edges, which, split)
            return True
        ends = mesh.points[edges]
        long = own & (norm(ends[:, 0] - ends[:, 1]) > ODD * floor)
        site: Ints = np.full(len(edges), -1, dtype=np.int64)
        site[long] = self._queries.nearest(ends[long].mean(axis=1)).site
        # the middle of an edge beside a hollow face can be outside
        outside = long & (site < 0) & ~mesh.boundary_edges(edges)
        odd = (site >= 0) & (site != a) & (site != b)
        for k in np.flatnonzero(odd).tolist():
            u, v = edges[k].tolist()
            odd[k] = site[k] not in labels.at(u) | labels.at(v)
        odd |= outside
        mesh.shorten(odd[which].any(axis=1))
        return bool(odd.any())

    def _unpinched(self, mesh: Bisected, labels: Labels) -> bool:
        """Put nodes into what is pinched off; whether there was something."""
        edges, which = mesh.edges()
        own = np.zeros(len(edges), dtype=np.bool_)
        own[which[mesh.region == self._region]] = True
        a, b = labels.site[edges].T
        rows = np.flatnonzero(own & (a != b) & ~mesh.boundary_edges(edges))
        found = crossings(self._queries, mesh.points[edges[rows]], labels.site[edges[rows]])
        pinched = np.zeros(len(edges), dtype=np.bool_)
        at: Array = mesh.points[edges].mean(axis=1)
        known: dict[tuple[int, int, int], bool] = {}
        for k in np.flatnonzero(found.third >= 0).tolist():
            row = int(rows[k])
            key = (int(a[row]), int(b[row]), int(found.third[k]))
            if key not in known:
                faces = self._placer.is_face(key[0]) and self._placer.is_face(key[1])
                known[key] = faces and len(self._placer.contacts(key)) == 1
            u, v = edges[row].tolist()
            near = key[0] in labels.at(v) or key[1] in labels.at(u)
            if known[key] and not near:
                pinched[row] = True
                at[row] = found.points[k]
        if pinched.any():
            mesh.halve(edges, which, pinched, at)
        return bool(pinched.any())
