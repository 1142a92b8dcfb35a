"""The walls between labels with their vertices exactly where their sites are equally near.

1. A wall's vertex next to a boundary node at which its sites meet is that node.
2. Others start where the nearest site changes along edges, or between such places, and are moved
   to where all their sites are equally near. Sites that turn out to be nearer join in.
3. Vertices with the same sites in one tetrahedron become one where that closes up what is thinner
   than the tetrahedra are.
"""

from __future__ import annotations

from itertools import combinations

import numpy as np

from decomp.complex.model import SIDES
from decomp.sampled.bisecting import Bisected
from decomp.sampled.contacts import links
from decomp.sampled.contracting import thin
from decomp.sampled.crossings import crossings
from decomp.sampled.extracted import CLOSE_VERTICES, ONE_VERTEX, Extracted, contracted
from decomp.sampled.labels import Labels
from decomp.sampled.marching import Walls, walls
from decomp.sampled.normals import LOOSE
from decomp.sampled.placing import SITE_NEARER, Placer
from decomp.skeletons.balls.queries import RegionQueries
from decomp.vectors import Array, Bools, Ints, norm

MOST_SITES = 10
"""So many sites at most are as near to one vertex."""
FARTHEST_MOVE = 2.0
"""A vertex is moved no farther than so many of the longest edges around it."""


class Extractor:
    """Extracts walls from one region's tetrahedra.

    Args:
        queries: of the region.
        placer: of the region.
        owner: the face that owns each site.
        size: the region's diagonal.
    """

    def __init__(
        self, queries: RegionQueries, placer: Placer, owner: dict[int, int], size: float
    ) -> None:
        self._queries, self._placer = queries, placer
        self._owner, self._size = owner, size

    def extracted(self, mesh: Bisected, labels: Labels, region: int) -> Extracted:
        """The walls of a region."""
        found = walls(mesh.tets[mesh.region == region], labels.site)
        count = len(found.corners)
        node: Ints = np.full(count, -1, dtype=np.int64)
        sites = [
            tuple(sorted({int(labels.site[c]) for c in row if c >= 0}))
            for row in found.corners.tolist()
        ]
        for vertex, row in enumerate(found.corners.tolist()):
            for corner in row:
                if corner in labels.touching and labels.touching[corner] >= set(sites[vertex]):
                    node[vertex] = corner
                    break
        points = np.zeros((count, 3))
        points[node >= 0] = mesh.points[node[node >= 0]]
        reach = self._reach(mesh.points, found.corners)
        self._start(mesh.points, labels, found, node, points, sites)
        start = np.array(points)
        third = np.array([len(own) > 2 for own in sites], dtype=np.bool_)
        free = np.flatnonzero(node < 0)
        radius, lost = np.zeros(count), np.zeros(count, dtype=np.bool_)
        self._settle(free, points, sites, radius, lost, reach)
        for vertex in np.flatnonzero(node >= 0).tolist():
            sites[vertex] = tuple(sorted(labels.at(int(node[vertex]))))
        many = (found.corners >= 0).sum(axis=1)
        through = np.flatnonzero(lost & (many == 2) & third)
        passed = found.corners[through, :2], start[through]
        return self._joined(found, points, radius, node, sites, lost, *passed)

    def _one(
        self,
        points: Array,
        sites: list[tuple[int, ...]],
        triangles: Ints,
        raised: Bools,
        lost: Bools,
    ) -> Ints:
        """Edges (k, 2) between vertices at one place, or of which one has joined the other's sites.

        Args:
            points, sites: of the vertices.
            triangles: (t, 3).
            raised: (v,) vertices inside that others' sites have joined.
            lost: (v,) vertices that are not in their places.
        """
        sides = np.sort(triangles[:, SIDES].reshape(-1, 2), axis=1)
        edges = np.unique(sides, axis=0)
        edges = edges[~lost[edges].any(axis=1)]
        length = norm(points[edges[:, 0]] - points[edges[:, 1]])
        same = length <= CLOSE_VERTICES * self._size
        done = np.array(~raised)
        for row in np.argsort(length, kind="stable").tolist():
            a, b = edges[row].tolist()
            if (
                not (done[a] and done[b])
                and sites[a] == sites[b]
                and not self._flat(sites[a], points[a])
            ):
                same[row] = True
                done[[a, b]] = True
        return np.asarray(edges[same])

    @staticmethod
    def _reach(points: Array, corners: Ints) -> Array:
        """The longest edge (v,) between the corners of each vertex."""
        at = points[np.where(corners >= 0, corners, corners[:, :1])]
        return np.asarray(norm(at[:, :, None] - at[:, None]).max(axis=(1, 2)))

    def _start(
        self,
        nodes: Array,
        labels: Labels,
        found: Walls,
        node: Ints,
        points: Array,
        sites: list[tuple[int, ...]],
    ) -> None:
        """Put vertices roughly in their places."""
        many = (found.corners >= 0).sum(axis=1)
        on_edges = np.flatnonzero((many == 2) & (node < 0))
        ends = found.corners[on_edges, :2]
        made = crossings(self._queries, nodes[ends], labels.site[ends])
        points[on_edges] = made.points
        for row in np.flatnonzero(made.third >= 0).tolist():
            vertex = int(on_edges[row])
            sites[vertex] = tuple(sorted({*sites[vertex], int(made.third[row])}))
        edge = {tuple(row[:2]): k for k, row in enumerate(found.corners.tolist()) if row[2] < 0}
        for vertex in np.flatnonzero((many > 2) & (node < 0)).tolist():
            own = [c for c in found.corners[vertex].tolist() if c >= 0]
            around = [edge[pair] for pair in combinations(own, 2) if pair in edge]
            points[vertex] = points[around].mean(axis=0)

    def _settle(
        self,
        free: Ints,
        points: Array,
        sites: list[tuple[int, ...]],
        radius: Array,
        lost: Bools,
        reach: Array,
    ) -> None:
        """Place vertices exactly; sites that are nearer join in."""
        start = np.array(points)
        left = free
        for _ in range(MOST_SITES):
            groups: dict[tuple[int, ...], list[int]] = {}
            for vertex in left.tolist():
                groups.setdefault(self._active(sites[vertex], start[vertex]), []).append(vertex)
            for own, members in groups.items():
                rows = np.array(members, dtype=np.int64)
                placed = self._placer.place(own, start[rows])
                good = placed.good & (
                    norm(placed.points - start[rows]) <= FARTHEST_MOVE * reach[rows]
                )
                points[rows] = np.where(good[:, None], placed.points, start[rows])
                radius[rows] = placed.radius
                lost[rows] = ~good
            again = []
            found = self._queries.nearest(points[left])
            gap = np.abs(radius[left] - found.distance)
            for row in np.flatnonzero(gap > SITE_NEARER * self._size).tolist():
                vertex, nearer = int(left[row]), int(found.site[row])
                if self._flat(sites[vertex], points[vertex]):
                    continue
                if nearer < 0:
                    # outside, beside a hollow face: the edge between two sites is nearest
                    nearer = self._placer.between(sites[vertex], points[vertex])
                crowded = len(sites[vertex]) >= MOST_SITES
                if nearer < 0 or lost[vertex] or nearer in sites[vertex] or crowded:
                    lost[vertex] = True
                else:
                    sites[vertex] = tuple(sorted({*sites[vertex], nearer}))
                    again.append(vertex)
            left = np.array(again, dtype=np.int64)
            if not len(left):
                break
        lost[left] = True
        flat = [vertex for vertex in free.tolist() if self._flat(sites[vertex], points[vertex])]
        radius[flat] = self._queries.depth(points[flat])[1]

    def _flat(self, sites: tuple[int, ...], point: Array) -> bool:
        """Whether all sites of a point (3,) share one foot, so that there is no skeleton."""
        return len(self._placer.contacts(sites, point, LOOSE)) == 1

    def _active(self, sites: tuple[int, ...], point: Array) -> tuple[int, ...]:
        """The sites that a vertex is placed between.

        Where all share a foot only what parts the cells of different faces counts. On the normal
        of a face at a vertex of it that and the edges there meet.
        """
        if len(sites) <= 2 or not self._flat(sites, point):
            return sites
        placer = self._placer
        if any(placer.normals.on_normal(a, b) for a, b in combinations(sites, 2)):
            return placer.normals.at_vertex(sites, point)
        for k, a in enumerate(sites):
            for b in sites[k + 1 :]:
                if self._owner[a] != self._owner[b] and placer.normals.takes_over(a, b):
                    return (a, b)
        return sites

    def _joined(
        self,
        found: Walls,
        points: Array,
        radius: Array,
        node: Ints,
        sites: list[tuple[int, ...]],
        lost: Bools,
        passed: Ints,
        passing: Array,
    ) -> Extracted:
        """Make vertices one that are one node, and contract what has no width."""
        first: dict[int, int] = {}
        top = np.arange(len(points))
        for vertex in np.flatnonzero(node >= 0).tolist():
            top[vertex] = first.setdefault(int(node[vertex]), vertex)
        triangles = top[found.triangles]
        a, b, c = triangles.T
        kept = np.flatnonzero((a != b) & (b != c) & (c != a))
        triangles = triangles[kept]
        narrow = thin(points, sites, triangles, self._placer)
        between = found.between[kept]
        linked = links(self._placer, self._owner, points, radius, sites, node, triangles, between)
        # what lies between two sites may be missing from the labels, but the two do not touch
        narrow |= (linked[:, 0] >= 0) & (linked != between).any(axis=1)
        raised = (found.corners >= 0).sum(axis=1) < np.array([len(own) for own in sites])
        short = self._one(points, sites, triangles, raised & (node < 0) & ~lost, lost)
        # what has no place of its own becomes one with what has, if that lies on all walls there
        sides = np.unique(np.sort(triangles[:, SIDES].reshape(-1, 2), axis=1), axis=0)
        short = np.concatenate([short, sides[lost[sides].any(axis=1)]])
        whole = Extracted(
            points,
            radius,
            node,
            sites,
            triangles,
            between,
            linked,
            found.tet[kept],
            lost,
            np.zeros_like(lost),
            passed,
            passing,
        )
        return contracted(whole, narrow, short, ONE_VERTEX * self._size, self._placer)
