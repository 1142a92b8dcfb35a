"""The graph of all seams of a region and the points where they end.

Seams start at the convex vertices of the solid and at junctions, whose contacts tell how many leave
and in which directions; so the graph grows until every seam has two ends. Seams that this does not
reach (closed ones above all) are found from the footprint: where, along a path on a face, the site
that the face's maximal balls touch on their far side changes with a jump, a seam is crossed.
"""

from __future__ import annotations

import numpy as np

from decomp.attempts import Way, first_of
from decomp.boundary.topology import Convexity
from decomp.errors import GeometryError
from decomp.sites.site import SiteKind
from decomp.skeletons.balls.fields import site_fields
from decomp.skeletons.balls.region_context import RegionContext
from decomp.skeletons.seams.graph_nodes import GraphNodes, OversteppedError
from decomp.skeletons.seams.known_seams import KnownSeams
from decomp.skeletons.seams.leaving.local import SeamRay, seam_rays
from decomp.skeletons.seams.meeting_seams import SeamMeetings
from decomp.skeletons.seams.seam_graph_model import Node, Piece, Seam, SeamGraph
from decomp.skeletons.seams.seams import SeamTracer
from decomp.skeletons.seams.seeds import Seeds, seam_seeds
from decomp.skeletons.seams.steps.points import SeamPoints
from decomp.skeletons.seams.steps.states import SeamEnd, State, Traced
from decomp.skeletons.seams.traced_seams import joined, seam_between, seam_of
from decomp.vectors import Array, Ints, norm

__all__ = ["Node", "Piece", "Seam", "SeamGraph", "missed_seams", "seam_graph"]

ROUNDS = 8
LEAST_SLOPE = 1e-9
BESIDE = 1e-2
"""Seams that pass a point nearer than this part of its radius may be the one that was meant."""
APART = 1e-3
"""Feet nearer than this part of the radius are one."""
MERGED = 1e-6
"""Where exact feet are nearer than this part of the radius two sites share a contact: a trim."""
LONGEST = (0.05, 5e-3, 1e-3)
"""The longest steps along seams, as parts of the size: a step can lead past a short stretch in
which a seam has other sites. What then fails is tried again with shorter ones; the shortest are for
seams of which two arrive where one does."""
FIRST_STEPS = (1e-3, 1e-4, 1e-5, 1e-2)


def seam_graph(context: RegionContext, samples: int = 1000, seed: int = 0) -> SeamGraph:
    """Trace all seams of a region.

    Args:
        context: of the region.
        samples: boundary points from which seams are looked for that no node leads to; again with
            others until no more are found.
        seed: of the random numbers that place them.

    Raises:
        GeometryError: a seam cannot be followed; says where.
    """

    def way(longest: float, *after: type[GeometryError]) -> Way[SeamGraph]:
        def run() -> SeamGraph:
            return _seam_graph(_Grower(context, longest), samples, seed)

        return Way(f"steps of at most {longest:g} of the size", run, after)

    # whatever it is, a step too long can be why
    long, middle, short = LONGEST
    return first_of(
        [way(long, GeometryError), way(middle, OversteppedError), way(short)],
    )


def _seam_graph(grower: _Grower, samples: int, seed: int) -> SeamGraph:
    grower.start_at_vertices()
    grower.grow()
    for turn in range(ROUNDS):
        if not (grower.start_at(grower.seeds(samples, seed + turn)) or grower.start_at_crossings()):
            break
    grower.check()
    return grower.graph


def missed_seams(context: RegionContext, graph: SeamGraph, samples: int, seed: int) -> Array:
    """Points (k, 3) on seams that a graph lacks, as seen from random boundary points."""
    grower = _Grower(context, LONGEST[0])
    seeds = grower.seeds(samples, seed)
    seams = KnownSeams(context.table, context.size, graph.seams)
    unknown = grower.unknown(seeds, seams)
    return np.array([s.point for s in grower.settled(seeds, unknown)]).reshape(-1, 3)


EARLIER = 1e-4
"""How far before its end, as a part of the radius, a seam into a ball's centre is looked at."""


class _Grower:
    """Grows the graph from nodes whose rays have not been followed yet."""

    def __init__(self, context: RegionContext, longest: float) -> None:
        self._context, self._boundary = context, context.boundary
        self._size = context.size
        self._points = SeamPoints(context)
        self._tracer = SeamTracer(self._points, longest)
        self._seams = KnownSeams(self._points.table, self._size)
        self._nodes = GraphNodes(self._points, self._seams)
        self._lost: list[tuple[Array, Array]] = []
        self._count = 0

    @property
    def graph(self) -> SeamGraph:
        """What has been found."""
        return SeamGraph(tuple(self._nodes.nodes), self._seams.seams)

    def seeds(self, samples: int, seed: int) -> Seeds:
        """Places of seams, as seen from random boundary points."""
        return seam_seeds(self._context, samples, seed)

    def start_at_vertices(self) -> None:
        """Add every convex vertex that a seam leaves."""
        face_site = {
            site.index: k
            for k, site in enumerate(self._context.sites)
            if site.region == self._context.region and site.kind is SiteKind.FACE
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
                self._nodes.add(
                    Node(vertex.point, 0.0, sites, feet, tuple(rays)), [s for _, s in found]
                )

    def _from_vertex(
        self, point: Array, sites: tuple[tuple[int, ...], ...], ray: SeamRay, reach: float
    ) -> State:
        which = np.array([sites[k][0] for k in ray.contacts])
        for part in FIRST_STEPS:
            ahead = point + part * reach * ray.direction
            points = np.repeat(ahead[None], len(which), axis=0)
            feet = site_fields(self._context, which, points, points).foot
            state = self._points.settled(ahead, feet, ray.direction)
            if state is not None:
                return state
        raise GeometryError("the seam from {at} cannot be followed", at=point)

    def grow(self) -> None:
        """Follow rays until none is left."""
        while self._nodes.open:
            node, ray = self._nodes.open.pop()
            if (node, ray) not in self._nodes.taken:
                traced = self._trace(self._nodes.starts[node, ray])
                number = self._new_number()
                self._nodes.taken[node, ray] = number
                seam = self._between(traced, (node, self._end(traced, number, node)))
                self._seams.add(number, seam)

    def start_at(self, seeds: Seeds) -> int:
        """Trace the seams through seeds that are not known; return how many."""
        count, left = 0, self.unknown(seeds, self._seams)
        while len(left):
            before = self._count
            for state in self.settled(seeds, left[:1]):
                self._start_inside(state)
                count += 1
            new = {k for k in range(before + 1, self._count + 1) if k in self._seams}
            left = left[1:]
            left = left[~self._seams.hold(seeds.points[left], seeds.feet[left], new)]
        return count

    def start_at_crossings(self) -> int:
        """Trace seams anew from where two of them cross unnoticed; return how many such places."""
        runs = [run for seam in self._seams.seams for run in seam.runs]
        slack, count = self._points.tolerances.same, 0
        for meeting in SeamMeetings(self._context).of(runs):
            if meeting.dip > slack and self._nodes.known(meeting.point) is None:
                self._grow_from(meeting.point)
                count += 1
        return count

    def unknown(self, seeds: Seeds, seams: KnownSeams) -> Ints:
        """Numbers of the seeds that are not on given seams."""
        return np.flatnonzero(~seams.hold(seeds.points, seeds.feet))

    def settled(self, seeds: Seeds, which: Ints) -> list[State]:
        """Exact points of seams near seeds."""
        along = np.array([0.5331, -0.6207, 0.5747])
        states = []
        for k in which:
            point, feet = seeds.points[k], seeds.feet[k]
            state = self._points.settled(point, feet, along)
            if state is not None and _apart(state.point, state.feet, MERGED):
                states.append(state)
            elif _apart(point, feet):
                self._lost.append((point, feet))
        return states

    def check(self) -> None:
        """See that no seam passes near a seed that could not be settled, without being known.

        Seeds whose feet have run together are on no seam: there a far foot only moved fast.

        Raises:
            GeometryError: there is one; says where.
        """
        for point, feet in self._lost:
            if self._is_on_locus(point, feet):
                continue
            if not self._seams.near(point, BESIDE * float(norm(point - feet[0]))):
                raise GeometryError("the seam near {at} cannot be found exactly", at=point)

    def _is_on_locus(self, point: Array, feet: Array) -> bool:
        """Whether a point is a centre of curvature of a face that it touches.

        Feet can then be anywhere on its carrier; at an end of the face it shares another's contact.
        """
        if self._points.on_locus(self._points.touched(point, feet), point):
            return True
        return self._nodes.is_on_locus(point)

    def _start_inside(self, state: State) -> None:
        """Trace the seam through a point, unless sheets only meet there in a reflexive point.

        From a node all seams have been traced, and feet of seeds can be too far off to know them.
        """
        known = self._seams.hold(state.point[None], state.feet[None])[0]
        if known or self._nodes.known(state.point) is not None:
            return
        if self._points.on_locus(state.sites, state.point) or self._nodes.is_centre(state):
            return
        touching = self._points.contacts.at(state.point, self._points.tolerances.same)
        if len(touching.feet) > len(state.sites):
            whole = self._points.settled(state.point, touching.feet, state.tangent)
            if whole is None:
                self._grow_from(state.point)
                return
            state = whole
        forward = self._trace(state)
        if forward.end is SeamEnd.SPLIT and (forward.last.point == state.point).all():
            self._grow_from(state.point)
            return
        number = self._new_number()
        if forward.end is SeamEnd.CLOSED:
            self._seams.add(number, seam_of(forward, None))
            return
        back = self._trace(state.turned())
        ends = (self._end(back, number), self._end(forward, number))
        self._seams.add(number, self._between(joined(back, forward), ends))
        self.grow()

    def _grow_from(self, point: Array) -> None:
        """Trace the seams that leave a point at which more meet than its seed has contacts."""
        self._nodes.at(point)
        self.grow()

    def _trace(self, start: State) -> Traced:
        return self._tracer.trace(start, lambda point: self._nodes.known(point) is not None)

    def _end(self, traced: Traced, number: int, start: int = -1) -> int:
        """The node at the end of a traced seam, its ray there taken by the seam.

        One that comes back to its `start` ends there.

        Raises:
            OversteppedError: it started at no node and closes one way round only.
        """
        last = traced.last
        if traced.end is SeamEnd.CLOSED:
            if start < 0:
                raise OversteppedError("the seam through {at} is closed one way", at=last.point)
            node = start
        elif traced.end is SeamEnd.BOUNDARY:
            node = self._nodes.on_boundary(last)
        elif traced.end in (SeamEnd.SPLIT, SeamEnd.FIN):
            node = self._nodes.end(last)
        else:
            node = self._nodes.junction(last, traced.intruder, traced.foot)
        if self._nodes.is_centre(last):
            last = self._before(traced)
        self._nodes.take(node, last, number)
        return node

    def _before(self, traced: Traced) -> State:
        """The last point of a seam but a little earlier.

        At a ball's centre, from which whole circles are as near, rounding tells on which side of it
        the seam ends, and so whether its feet are those ahead of it.
        """
        last, run = traced.last, traced.runs[-1]
        away = norm(run.points - last.point)
        clear = np.flatnonzero(away > EARLIER * last.radius)
        if not len(clear):
            return last
        feet = run.feet[clear[-1]]
        earlier = last.point - EARLIER * last.radius * last.tangent
        state = self._points.state(run.sites, earlier, feet, last.tangent)
        return last if state is None else state

    def _between(self, traced: Traced, ends: tuple[int, int]) -> Seam:
        first, last = (self._nodes.nodes[k] for k in ends)
        return seam_between(traced, ends, first, last, self._size)

    def _new_number(self) -> int:
        self._count += 1
        return self._count


def _apart(point: Array, feet: Array, within: float = APART) -> bool:
    """Whether the feet (m, 3) of a seed are pairwise different: by a part of its radius."""
    one, other = np.triu_indices(len(feet), 1)
    gaps = norm(feet[one] - feet[other])
    return bool((gaps > within * float(norm(point - feet[0]))).all())
