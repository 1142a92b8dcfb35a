"""The graph of all seams of a region and the points where they end.

Seams start at the convex vertices of the solid and at junctions, whose contacts tell how many leave
and in which directions; so the graph grows until every seam has two ends. Seams that this does not
reach (closed ones above all) are found from the footprint: where, along a path on a face, the site
that the face's maximal balls touch on their far side changes with a jump, a seam is crossed.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import product

import numpy as np

from decomp.boundary.topology import Convexity, RegionBoundary
from decomp.errors import GeometryError
from decomp.sites import SiteIndex
from decomp.sites.site import SiteKind
from decomp.tracing.departures import departures
from decomp.tracing.equidistance import balanced
from decomp.tracing.fields import site_fields
from decomp.tracing.known_seams import KnownSeams
from decomp.tracing.local import SeamRay, seam_rays
from decomp.tracing.loci import on_locus
from decomp.tracing.seam_graph_model import Node, Piece, Seam, SeamGraph
from decomp.tracing.seams import SLACK, SeamEnd, SeamTracer, State, Traced
from decomp.tracing.seeds import Seeds, seam_seeds
from decomp.tracing.supports import support_table
from decomp.vectors import Array, Ints, norm, place

__all__ = ["Node", "Piece", "Seam", "SeamGraph", "missed_seams", "seam_graph"]

ROUNDS = 8
WELD = 1e-7
"""Nodes nearer than this part of the size are one."""
CELL = 1e-3
ENDING = 1e-5
LEAST_SLOPE = 1e-9
LOCUS = 1e-7
"""Points nearer to a reflexive locus than this part of the size lie on it."""
FIRST_STEPS = (1e-3, 1e-4, 1e-5, 1e-2)


def seam_graph(
    index: SiteIndex, boundary: RegionBoundary, region: int, samples: int = 1000, seed: int = 0
) -> SeamGraph:
    """Trace all seams of a region.

    Args:
        index: nearest-site queries of the model.
        boundary: of the region.
        region: its index.
        samples: boundary points from which seams are looked for that no node leads to; again with
            others until no more are found.
        seed: of the random numbers that place them.

    Raises:
        GeometryError: a seam cannot be followed; says where.
    """
    grower = _Grower(index, boundary, region)
    grower.start_at_vertices()
    grower.grow()
    for turn in range(ROUNDS):
        seeds = seam_seeds(index, boundary, region, samples, seed + turn)
        if not grower.start_at(seeds):
            break
    return grower.graph


def missed_seams(
    index: SiteIndex,
    boundary: RegionBoundary,
    region: int,
    graph: SeamGraph,
    samples: int,
    seed: int,
) -> Array:
    """Points (k, 3) on seams that a graph lacks, as seen from random boundary points."""
    grower = _Grower(index, boundary, region)
    seeds = seam_seeds(index, boundary, region, samples, seed)
    seams = KnownSeams(support_table(boundary, index.sites), boundary.diagonal, graph.seams)
    unknown = grower.unknown(seeds, seams)
    return np.array([s.point for s in grower.settled(seeds, unknown)]).reshape(-1, 3)


class _Grower:
    """Grows the graph from nodes whose rays have not been followed yet."""

    def __init__(self, index: SiteIndex, boundary: RegionBoundary, region: int) -> None:
        self._nodes: list[Node] = []
        self._index, self._boundary, self._region = index, boundary, region
        self._size = boundary.diagonal
        self._tracer = SeamTracer(index, boundary, region)
        self._seams = KnownSeams(self._tracer.table, self._size)
        self._places: dict[tuple[int, ...], list[int]] = {}
        self._open: list[tuple[int, int]] = []
        self._starts: dict[tuple[int, int], State] = {}
        self._taken: dict[tuple[int, int], int] = {}
        self._unforeseen: set[int] = set()
        self._count = 0

    @property
    def graph(self) -> SeamGraph:
        """What has been found."""
        return SeamGraph(tuple(self._nodes), self._seams.seams)

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
            rays = [ray for ray in seam_rays(inward) if ray.slope > LEAST_SLOPE]
            sites = tuple((face_site[k],) for k in vertex.faces)
            feet = np.array([vertex.point] * len(sites))
            reach = min(self._size, *(self._boundary.edges[k].length for k in vertex.edges))
            found = [(ray, self._from_vertex(vertex.point, sites, ray, reach)) for ray in rays]
            if found:
                self._add(Node(vertex.point, 0.0, sites, feet, tuple(rays)), [s for _, s in found])

    def _from_vertex(
        self, point: Array, sites: tuple[tuple[int, ...], ...], ray: SeamRay, reach: float
    ) -> State:
        which = np.array([sites[k][0] for k in ray.contacts])
        for part in FIRST_STEPS:
            ahead = point + part * reach * ray.direction
            points = np.repeat(ahead[None], len(which), axis=0)
            feet = site_fields(self._boundary, self._index.sites, which, points, points).foot
            state = self._tracer.settled(ahead, feet, ray.direction)
            if state is not None:
                return state
        raise GeometryError(f"the seam from {place(point)} cannot be followed")

    def grow(self) -> None:
        """Follow rays until none is left."""
        while self._open:
            node, ray = self._open.pop()
            if (node, ray) not in self._taken:
                traced = self._trace(self._starts[node, ray])
                number = self._new_number()
                self._taken[node, ray] = number
                seam = self._between(traced, (node, self._end(traced, number)))
                self._seams.add(number, seam)

    def start_at(self, seeds: Seeds) -> int:
        """Trace the seams through seeds that are not known; return how many."""
        count, left = 0, self.unknown(seeds, self._seams)
        while len(left):
            before = self._count
            for state in self.settled(seeds, left[:1]):
                self._start_inside(state)
                count += 1
            new = [k for k in range(before + 1, self._count + 1) if k in self._seams]
            left = left[1:]
            left = left[~self._seams.hold(seeds.points[left], seeds.feet[left], new)]
        return count

    def unknown(self, seeds: Seeds, seams: KnownSeams) -> Ints:
        """Numbers of the seeds that are not on given seams."""
        return np.flatnonzero(~seams.hold(seeds.points, seeds.feet))

    def settled(self, seeds: Seeds, which: Ints) -> list[State]:
        """Exact points of seams near seeds."""
        along = np.array([0.5331, -0.6207, 0.5747])
        states = (self._tracer.settled(seeds.points[k], seeds.feet[k], along) for k in which)
        return [state for state in states if state is not None]

    def _start_inside(self, state: State) -> None:
        """Trace the seam through a point, unless sheets only meet there in a reflexive point."""
        if self._on_locus(state.sites, state.point):
            return
        touching = self._tracer.contacts.at(state.point, SLACK * self._size)
        if len(touching.feet) > len(state.sites):
            whole = self._tracer.settled(state.point, touching.feet, state.tangent)
            if whole is None:
                self._node_at(state.point)
                self.grow()
                return
            state = whole
        number = self._new_number()
        forward = self._trace(state)
        if forward.end is SeamEnd.CLOSED:
            self._seams.add(number, _seam(forward, None))
            return
        back = self._trace(state.turned())
        ends = (self._end(back, number), self._end(forward, number))
        self._seams.add(number, self._between(_joined(back, forward), ends))
        self.grow()

    def _on_locus(self, sites: Sequence[int], point: Array) -> bool:
        """Whether a point is a centre of curvature of a face that is touched from it."""
        return bool(on_locus(self._boundary, self._index.sites, sites, point[None], LOCUS)[0])

    def _trace(self, start: State) -> Traced:
        return self._tracer.trace(start, lambda point: self._known_node(point) is not None)

    def _end(self, traced: Traced, number: int) -> int:
        """The node at the end of a traced seam, its ray there taken by the seam."""
        last = traced.last
        if traced.end is SeamEnd.BOUNDARY:
            node = self._vertex_near(last)
        elif traced.end in (SeamEnd.SPLIT, SeamEnd.FIN):
            node = self._node_at(last.point, traced.end is SeamEnd.FIN)
        else:
            node = self._junction(last, traced.intruder, traced.foot)
        self._take(node, last, number)
        return node

    def _vertex_near(self, last: State) -> int:
        """The node where a seam's radius vanishes.

        If it is no convex vertex that seams are known to leave, it is another vertex, or a point of
        an edge where the faces' angle vanishes; its rays are the seams that arrive.
        """
        for number, node in enumerate(self._nodes):
            if node.radius == 0 and float(norm(node.point - last.point)) <= ENDING * self._size:
                return number
        vertices = np.array([v.point for v in self._boundary.vertices]).reshape(-1, 3)
        gaps = norm(vertices - last.point)
        if len(gaps) and gaps.min() <= ENDING * self._size:
            point = vertices[int(np.argmin(gaps))]
        else:
            point = last.point + last.radius / -last.slope * last.tangent
            if not float(norm(point - last.point)) <= ENDING * self._size:
                raise GeometryError(
                    f"the end of a seam on the boundary near {place(point)} is lost"
                )
        number = self._add(Node(point, 0.0, (), np.empty((0, 3)), ()), [])
        self._unforeseen.add(number)
        return number

    def _junction(self, last: State, intruder: int, foot: Array) -> int:
        which = np.array([[*last.sites, intruder]])
        feet = np.concatenate([last.feet, foot[None]])[None]
        found = balanced(self._tracer.table, self._size, which, last.point[None], feet)
        point = found.points[0]
        if not float(norm(point - last.point)) <= 1e-4 * self._size:
            raise GeometryError(
                f"the junction at the end of a seam near {place(last.point)} is lost"
            )
        return self._node_at(point)

    def _node_at(self, point: Array, fin: bool = False) -> int:
        """The node at a point, a new one unless it is known.

        A fin can end on a reflexive locus, from which a whole arc of a face is as near. No seam
        leaves with a contact there, which is only one point of the arc.
        """
        known = self._known_node(point)
        if known is not None:
            return known
        touching = self._tracer.contacts.at(point, SLACK * self._size)
        rays, states = [], []
        arcs = {k for k, sites in enumerate(touching.sites) if fin and self._on_locus(sites, point)}
        for ray in seam_rays(touching.gradients):
            if arcs & set(ray.contacts):
                continue
            for contacts, state in departures(self._tracer, point, touching, ray):
                rays.append(replace(ray, contacts=contacts))
                states.append(state)
        node = Node(point, touching.radius, touching.sites, touching.feet, tuple(rays))
        return self._add(node, states)

    def _add(self, node: Node, states: Sequence[State]) -> int:
        """Add a node with the first points of its rays."""
        number = len(self._nodes)
        self._nodes.append(node)
        reach = 2 * WELD * self._size
        corners = [node.point + reach * np.array(c) for c in product((-1.0, 1.0), repeat=3)]
        for cell in {_cell(corner, self._size) for corner in corners}:
            self._places.setdefault(cell, []).append(number)
        for k, state in enumerate(states):
            self._starts[number, k] = state
            self._open.append((number, k))
        if node.radius > 0:
            self._cut_at(node)
        return number

    def _cut_at(self, node: Node) -> None:
        """Give up seams that pass a new node: they are traced again, from there."""
        for number in self._seams.through(node.point):
            self._seams.remove(number)
            for ray in [ray for ray, owner in self._taken.items() if owner == number]:
                del self._taken[ray]
                self._open.insert(0, ray)

    def _known_node(self, point: Array) -> int | None:
        """The node at a point; nodes are kept by the cells of a grid that they are close to."""
        for number in self._places.get(_cell(point, self._size), []):
            if float(norm(self._nodes[number].point - point)) <= WELD * self._size:
                return number
        return None

    def _take(self, number: int, last: State, seam: int) -> None:
        """Mark the ray of a node along which a seam has arrived."""
        node = self._nodes[number]
        if node.radius > 0:
            gaps = norm(last.feet[:, None] - node.feet[None])
            contacts = sorted(np.argmin(gaps, axis=1).tolist())
        else:
            node = self._with_sites(number, last.sites)
            contacts = [k for k, sites in enumerate(node.sites) if set(sites) & set(last.sites)]
        fitting = [
            k
            for k, ray in enumerate(node.rays)
            if (number, k) not in self._taken
            and sorted(ray.contacts) == contacts
            and float(ray.direction @ -last.tangent) > 0.9
        ]
        if not fitting and (len(set(contacts)) < len(contacts) or number in self._unforeseen):
            self._add_fin(number, last, contacts, seam)
            return
        if not fitting:
            raise GeometryError(f"a seam arrives at {place(node.point)} where none leaves")
        best = max(fitting, key=lambda k: float(node.rays[k].direction @ -last.tangent))
        self._taken[number, best] = seam

    def _with_sites(self, number: int, sites: Sequence[int]) -> Node:
        """A node on the boundary; one that was not foreseen is given the sites that arrive."""
        node = self._nodes[number]
        known = {site for group in node.sites for site in group}
        new = [site for site in sites if site not in known]
        if number in self._unforeseen and new:
            node = replace(
                node,
                sites=(*node.sites, *((site,) for site in new)),
                feet=np.concatenate([node.feet, np.repeat(node.point[None], len(new), axis=0)]),
            )
            self._nodes[number] = node
        return node

    def _add_fin(self, number: int, last: State, contacts: list[int], seam: int) -> None:
        """Add a ray for a seam that has arrived where none was foreseen, and mark it."""
        node = self._nodes[number]
        ray = SeamRay(-last.tangent, tuple(contacts), -last.slope)
        self._taken[number, len(node.rays)] = seam
        self._starts[number, len(node.rays)] = last.turned()
        self._nodes[number] = replace(node, rays=(*node.rays, ray))

    def _between(self, traced: Traced, ends: tuple[int, int]) -> Seam:
        """A seam with its nodes' points put at its ends."""
        plain = _seam(traced, ends)
        first, last = (self._nodes[k] for k in ends)
        near = np.minimum(norm(plain.points - first.point), norm(plain.points - last.point))
        inner = np.flatnonzero(near > 1e-9 * self._size)
        if not len(inner):
            inner = np.array([len(plain.points) // 2])
        a, b = inner[0], inner[-1]
        return Seam(
            np.concatenate([first.point[None], plain.points[inner], last.point[None]]),
            np.concatenate([[first.radius], plain.radius[inner], [last.radius]]),
            (plain.sites[a], *(plain.sites[k] for k in inner), plain.sites[b]),
            np.concatenate(
                [
                    _feet_at(first, plain.feet[a])[None],
                    plain.feet[inner],
                    _feet_at(last, plain.feet[b])[None],
                ]
            ),
            ends,
        )

    def _new_number(self) -> int:
        self._count += 1
        return self._count


def _cell(point: Array, size: float) -> tuple[int, ...]:
    """The cell of a grid that holds a point."""
    return tuple(int(x) for x in np.floor(point / (CELL * size)))


def _feet_at(node: Node, feet: Array) -> Array:
    """The feet (m, 3) at a node that continue those of a seam."""
    return np.asarray(node.feet[np.argmin(norm(feet[:, None] - node.feet[None]), axis=1)])


def _joined(back: Traced, forward: Traced) -> Traced:
    """One trace out of two that start at the same point."""
    turned = [
        replace(run, points=run.points[::-1], radius=run.radius[::-1], feet=run.feet[::-1])
        for run in reversed(back.runs)
    ]
    meeting, start = turned[-1], forward.runs[0]
    middle = replace(
        start,
        points=np.concatenate([meeting.points, start.points[1:]]),
        radius=np.concatenate([meeting.radius, start.radius[1:]]),
        feet=np.concatenate([meeting.feet, start.feet[1:]]),
    )
    return replace(forward, runs=(*turned[:-1], middle, *forward.runs[1:]))


def _seam(traced: Traced, ends: tuple[int, int] | None) -> Seam:
    """A seam of all runs; a closed one without the last point, which lies past its first."""
    runs = [run for run in traced.runs if len(run.points)]
    points = np.concatenate([run.points for run in runs])
    radius = np.concatenate([run.radius for run in runs])
    feet = np.concatenate([run.feet for run in runs])
    sites = tuple(run.sites for run in runs for _ in range(len(run.points)))
    # two runs with the same sites share a point that need not stand twice
    keep = np.ones(len(points), dtype=np.bool_)
    for k in range(1, len(points)):
        keep[k] = sites[k] != sites[k - 1] or bool((points[k] != points[k - 1]).any())
    if ends is None:
        keep[-1] = False
    rows = np.flatnonzero(keep)
    return Seam(points[rows], radius[rows], tuple(sites[k] for k in rows), feet[rows], ends)
