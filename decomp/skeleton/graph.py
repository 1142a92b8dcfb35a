"""The graph of all seams of a region and the points where they end.

Seams start at the convex vertices of the solid and at junctions, whose contacts tell how many leave
and in which directions; so the graph grows until every seam has two ends. Seams that this does not
reach (closed ones above all) are found from the footprint: where, along a path on a face, the site
that the face's maximal balls touch on their far side changes with a jump, a seam is crossed.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np

from decomp.boundary.topology import Convexity, RegionBoundary
from decomp.errors import GeometryError
from decomp.sites import SiteIndex
from decomp.sites.site import SiteKind
from decomp.skeleton.contacts import contacts
from decomp.skeleton.equidistance import equidistant
from decomp.skeleton.fields import site_fields
from decomp.skeleton.local import SeamRay, seam_rays
from decomp.skeleton.seams import SeamEnd, SeamTracer, State, Traced
from decomp.skeleton.seeds import seam_seeds
from decomp.vectors import Array, norm, place

FIRST_STEP = 1e-3
SLACK = 1e-9


@dataclass(frozen=True, eq=False)
class Node:
    """A junction, or a convex vertex of the solid from which a seam leaves.

    Args:
        point: (3,).
        radius: distance to the boundary, 0 at a vertex.
        sites: for each contact all sites that share its foot.
        feet: (m, 3), of the contacts.
        rays: the seams that leave it; their contacts are indices into `sites`.
    """

    point: Array
    radius: float
    sites: tuple[tuple[int, ...], ...]
    feet: Array
    rays: tuple[SeamRay, ...]


@dataclass(frozen=True, eq=False)
class Seam:
    """A curve of points with three or more contacts.

    Args:
        points: (n, 3), exact to rounding; a closed seam does not repeat its first point.
        radius: (n,).
        sites: the site of each contact at every point; it changes at trims.
        ends: the nodes where it begins and ends, None if it is closed.
    """

    points: Array
    radius: Array
    sites: tuple[tuple[int, ...], ...]
    ends: tuple[int, int] | None

    @property
    def length(self) -> float:
        """Length of the polyline."""
        closed = self.points if self.ends else np.concatenate([self.points, self.points[:1]])
        return float(norm(np.diff(closed, axis=0)).sum())


@dataclass(frozen=True, eq=False)
class SeamGraph:
    """Nodes and seams of one region."""

    nodes: tuple[Node, ...]
    seams: tuple[Seam, ...]


def seam_graph(
    index: SiteIndex, boundary: RegionBoundary, region: int, samples: int = 4000, seed: int = 0
) -> SeamGraph:
    """Trace all seams of a region.

    Args:
        index: nearest-site queries of the model.
        boundary: of the region.
        region: its index.
        samples: boundary points from which seams are looked for that no node leads to.
        seed: of the random numbers that place them.

    Raises:
        GeometryError: a seam cannot be followed; says where.
    """
    grower = _Grower(index, boundary, region)
    grower.start_at_vertices()
    grower.grow()
    for sites, point, feet in seam_seeds(index, boundary, region, samples, seed):
        grower.start_inside(sites, point, feet)
        grower.grow()
    return SeamGraph(tuple(grower.nodes), tuple(grower.seams))


class _Grower:
    """Grows the graph from nodes whose rays have not been followed yet."""

    def __init__(self, index: SiteIndex, boundary: RegionBoundary, region: int) -> None:
        self.nodes: list[Node] = []
        self.seams: list[Seam] = []
        self._index, self._boundary, self._region = index, boundary, region
        self._size = boundary.diagonal
        self._tracer = SeamTracer(index, boundary, region)
        self._open: list[tuple[int, int]] = []
        self._taken: set[tuple[int, int]] = set()

    def start_at_vertices(self) -> None:
        """Add every convex vertex that a seam leaves."""
        face_site = {
            site.index: k
            for k, site in enumerate(self._index.sites)
            if site.region == self._region and site.kind is SiteKind.FACE
        }
        for vertex in self._boundary.vertices:
            if vertex.convexity is not Convexity.CONVEX or len(vertex.faces) < 3:
                continue
            faces = [self._boundary.faces[k] for k in vertex.faces]
            inward = np.array(
                [
                    -f.outward * self._boundary.carriers[f.carrier].normal(vertex.point)
                    for f in faces
                ]
            )
            rays = tuple(ray for ray in seam_rays(inward) if ray.slope > SLACK)
            if rays:
                sites = tuple((face_site[k],) for k in vertex.faces)
                self._add(
                    Node(vertex.point, 0.0, sites, np.array([vertex.point] * len(sites)), rays)
                )

    def grow(self) -> None:
        """Follow rays until none is left."""
        while self._open:
            node, ray = self._open.pop()
            if (node, ray) not in self._taken:
                self._taken.add((node, ray))
                self._follow(node, ray)

    def start_inside(self, sites: Sequence[int], point: Array, feet: Array) -> None:
        """Trace the seam through a point, unless it is known."""
        state = self._tracer.state(sites, point, feet, np.array([0.5331, -0.6207, 0.5747]))
        if state is None or not self._tracer.holds(state) or self._is_known(state):
            return
        forward = self._tracer.trace(state)
        if forward.end is SeamEnd.CLOSED:
            self.seams.append(_seam(forward.states[:-1], None))
            return
        back = self._tracer.trace(self._tracer.turned(state))
        ends = (self._end(back), self._end(forward))
        states = (*reversed(back.states[1:]), *forward.states)
        self.seams.append(self._between(states, ends))

    def _follow(self, number: int, ray_number: int) -> None:
        node = self.nodes[number]
        ray = node.rays[ray_number]
        step = FIRST_STEP * (self._size if node.radius == 0 else min(self._size, node.radius))
        ahead = node.point + step * ray.direction
        state = self._tracer.settled(ahead, self._feet(node, ray, ahead), ray.direction)
        traced = self._tracer.trace(state)
        self.seams.append(self._between(traced.states, (number, self._end(traced))))

    def _feet(self, node: Node, ray: SeamRay, ahead: Array) -> Array:
        """Feet (m, 3) of a ray's contacts, as seen from a point a little along it."""
        if node.radius > 0:
            return node.feet[list(ray.contacts)]
        which = np.array([node.sites[k][0] for k in ray.contacts])
        points = np.repeat(ahead[None], len(which), axis=0)
        return site_fields(self._boundary, self._index.sites, which, points, points).foot

    def _end(self, traced: Traced) -> int:
        """The node at the end of a traced seam, its ray there taken."""
        last = traced.states[-1]
        if traced.end is SeamEnd.BOUNDARY:
            number = self._vertex_near(last)
        elif traced.end is SeamEnd.SPLIT:
            number = self._node_at(last.point)
        else:
            number = self._junction(last, traced.intruder)
        self._take(number, -last.tangent, last.sites)
        return number

    def _vertex_near(self, last: State) -> int:
        for number, node in enumerate(self.nodes):
            if node.radius == 0 and float(norm(node.point - last.point)) <= 1e-5 * self._size:
                return number
        raise GeometryError(f"a seam ends on the boundary at {place(last.point)}, not at a vertex")

    def _junction(self, last: State, intruder: int) -> int:
        sites = np.array([[*last.sites, intruder]])
        near = self._index.nearest(last.point[None])
        feet = np.concatenate([last.feet, near.foot])[None]
        found = equidistant(self._boundary, self._index.sites, sites, last.point[None], feet)
        point = found.points[0]
        if float(norm(point - last.point)) > 1e-4 * self._size:
            raise GeometryError(
                f"the junction at the end of a seam near {place(last.point)} is lost"
            )
        return self._node_at(point)

    def _node_at(self, point: Array) -> int:
        """The node at a point, a new one unless it is known."""
        for number, node in enumerate(self.nodes):
            if float(norm(node.point - point)) <= 1e-7 * self._size:
                return number
        touching = contacts(self._index, self._boundary, self._region, point, self._slack)
        rays = [
            found
            for ray in seam_rays(touching.gradients)
            for found in self._resolved(point, touching.feet, ray, touching.radius)
        ]
        return self._add(Node(point, touching.radius, touching.sites, touching.feet, tuple(rays)))

    def _resolved(self, point: Array, feet: Array, ray: SeamRay, radius: float) -> list[SeamRay]:
        """The seams that truly leave along a ray with more than three contacts.

        Either one seam with all these contacts does, or several leave in the same direction and
        part farther on: then each set of fewer contacts is tried a step ahead.
        """
        if len(ray.contacts) == 3:
            return [ray]
        ahead = point + FIRST_STEP * min(self._size, 10 * radius) * ray.direction
        found: list[SeamRay] = []
        for count in range(len(ray.contacts), 2, -1):
            for chosen in combinations(ray.contacts, count):
                if any(set(chosen) <= set(known.contacts) for known in found):
                    continue
                try:
                    self._tracer.settled(ahead, feet[list(chosen)], ray.direction)
                except GeometryError:
                    continue
                found.append(replace(ray, contacts=chosen))
        return found

    def _add(self, node: Node) -> int:
        self.nodes.append(node)
        number = len(self.nodes) - 1
        self._open.extend((number, k) for k in range(len(node.rays)))
        return number

    def _take(self, number: int, direction: Array, sites: Sequence[int]) -> None:
        """Mark the ray of a node along which a seam with some sites has arrived."""
        node = self.nodes[number]
        free = [k for k in range(len(node.rays)) if (number, k) not in self._taken]
        fitting = [k for k in free if float(node.rays[k].direction @ direction) > 0.9]
        if not fitting:
            raise GeometryError(f"a seam arrives at {place(node.point)} where none leaves")

        def fit(k: int) -> tuple[int, float]:
            """How many contacts of a ray are the seam's own, then how well directions agree."""
            ray = node.rays[k]
            shared = sum(bool(set(node.sites[c]) & set(sites)) for c in ray.contacts)
            return 2 * shared - len(ray.contacts), float(ray.direction @ direction)

        self._taken.add((number, max(fitting, key=fit)))

    def _between(self, states: Sequence[State], ends: tuple[int, int]) -> Seam:
        """A seam with its nodes' points put at its ends."""
        first, last = (self.nodes[k] for k in ends)
        inner = [
            s
            for s in states
            if min(float(norm(s.point - n.point)) for n in (first, last)) > 1e-9 * self._size
        ] or list(states[:1])
        return Seam(
            np.array([first.point, *(s.point for s in inner), last.point]),
            np.array([first.radius, *(s.radius for s in inner), last.radius]),
            (inner[0].sites, *(s.sites for s in inner), inner[-1].sites),
            ends,
        )

    def _is_known(self, state: State) -> bool:
        """Whether a known seam with the same sites passes through a point."""
        for seam in self.seams:
            points = seam.points if seam.ends else np.concatenate([seam.points, seam.points[:1]])
            way = np.diff(points, axis=0)
            along = np.einsum("ij,ij->i", state.point - points[:-1], way)
            along = np.clip(along / np.maximum(np.einsum("ij,ij->i", way, way), 1e-300), 0, 1)
            gap = norm(state.point - points[:-1] - along[:, None] * way)
            nearest = int(np.argmin(gap))
            chord = float(norm(way[nearest]))
            known = {s for k in (nearest, nearest + 1) for s in seam.sites[k % len(seam.sites)]}
            if gap[nearest] <= 0.1 * chord and set(state.sites) <= known:
                return True
        return False

    @property
    def _slack(self) -> float:
        return SLACK * self._size


def _seam(states: Sequence[State], ends: tuple[int, int] | None) -> Seam:
    return Seam(
        np.array([s.point for s in states]),
        np.array([s.radius for s in states]),
        tuple(s.sites for s in states),
        ends,
    )
