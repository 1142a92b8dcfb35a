"""Loops: the edges of one carrier chained end to end, the face on their left."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from decomp.boundary.edges import Flank, RawEdge
from decomp.boundary.member import Member
from decomp.carriers import Carrier
from decomp.errors import ContactError
from decomp.places import place
from decomp.tolerance import TINY
from decomp.vectors import Array, frame, norm

SAME_RAY = 1e-12
"""Two edges along one arc leave a vertex at angles that differ by less."""
FIRST_STEP = 1e-6
"""The way from the end of an edge to a point at a given distance begins with this part of it."""


@dataclass(frozen=True)
class HalfEdge:
    """An edge as a face runs along it: `direction` +1 with the curve, -1 against it.

    The face lies on the left, seen from outside the region.
    """

    edge: int
    direction: int


@dataclass(frozen=True, eq=False)
class LoopSet:
    """All loops on one side of one carrier.

    Args:
        carrier: index.
        outward: +1 if the region lies inside the carrier, -1 if outside.
        loops: each a closed chain of half-edges.
    """

    carrier: int
    outward: int
    loops: tuple[tuple[HalfEdge, ...], ...]


Umbrellas = tuple[frozenset[tuple[int, bool]], ...]
"""Edge ends (edge, whether it starts there) at a vertex, those together that one comes by from face
to face over the edges. A region with several of them at a vertex touches itself there."""


def loop_sets(
    edges: Sequence[RawEdge], points: Array, member: Member
) -> tuple[list[LoopSet], list[Umbrellas]]:
    """Chain edges into loops, for each carrier and each of its sides.

    Returns:
        the loops, and the umbrellas at each of the points.

    Raises:
        ContactError: edges do not close.
    """
    groups: dict[tuple[int, int], list[HalfEdge]] = defaultdict(list)
    for index, edge in enumerate(edges):
        for flank in edge.flanks:
            groups[flank.carrier, flank.outward].append(HalfEdge(index, flank.direction_of_loop))
    result = []
    following: dict[tuple[int, int, HalfEdge], HalfEdge] = {}
    for (carrier, outward), halves in sorted(groups.items()):
        linker = _Linker(edges, points, member, carrier, outward)
        links = linker.link(halves)
        following.update({(carrier, outward, a): b for a, b in links.items()})
        result.append(LoopSet(carrier, outward, _cycles(halves, links)))
    return result, _umbrellas(edges, len(points), following)


class _Linker:
    """Finds, at each vertex, which half-edge continues a loop on one carrier."""

    def __init__(
        self,
        edges: Sequence[RawEdge],
        points: Array,
        member: Member,
        carrier: int,
        outward: int,
    ) -> None:
        self._edges, self._points, self._member = edges, points, member
        self._carrier = member.form.carriers[carrier]
        self._carrier_index, self._outward = carrier, outward

    def link(self, halves: Sequence[HalfEdge]) -> dict[HalfEdge, HalfEdge]:
        """The half-edge that follows each half-edge with a vertex."""
        arriving: dict[int, list[HalfEdge]] = defaultdict(list)
        leaving: dict[int, list[HalfEdge]] = defaultdict(list)
        for half in halves:
            ends = self._edges[half.edge].ends
            if ends is not None:
                forward = half.direction > 0
                leaving[ends[0 if forward else 1]].append(half)
                arriving[ends[1 if forward else 0]].append(half)
        links: dict[HalfEdge, HalfEdge] = {}
        for vertex in sorted(set(arriving) | set(leaving)):
            into, out = arriving[vertex], leaving[vertex]
            if len(into) != len(out):
                raise self._unresolved(vertex)
            if len(into) == 1:
                links[into[0]] = out[0]
            else:
                links.update(self._linked_by_angle(vertex, into, out))
        return links

    def _linked_by_angle(
        self, vertex: int, into: list[HalfEdge], out: list[HalfEdge]
    ) -> dict[HalfEdge, HalfEdge]:
        """Each arriving half-edge goes on along the next ray clockwise, keeping its face left.

        The last one is the way that it came, where the region touches itself along it.
        """
        point = self._points[vertex]
        x, y = frame(self._outward * _normal(self._carrier, point))
        reach = 1e-3 * min(_chord(self._edges[half.edge]) for half in (*into, *out))

        def angle(half: HalfEdge, at_start: bool) -> float:
            ray = _point_near_end(self._edges[half.edge], at_start, reach) - point
            return float(np.arctan2(ray @ y, ray @ x))

        rays = [(angle(half, half.direction > 0), half) for half in out]
        links: dict[HalfEdge, HalfEdge] = {}
        for half in into:
            back = angle(half, half.direction < 0)
            turns = [
                ((back - ray - SAME_RAY) % (2 * np.pi), index)
                for index, (ray, _) in enumerate(rays)
            ]
            links[half] = rays[min(turns)[1]][1]
        # two that go on along one edge would leave the loops of the others open for ever
        if len(set(links.values())) < len(links):
            raise self._unresolved(vertex)
        return links

    def _unresolved(self, vertex: int) -> ContactError:
        return ContactError(
            f"region {self._member.name!r}: the edges on "
            f"{self._member.form.carrier_name(self._carrier_index)} do not close at "
            "{at}; carriers touch there in a way that is not "
            f"resolved: move one part by more than the tolerance {self._member.form.tolerance:.3g}",
            at=self._points[vertex],
        )


def _cycles(
    halves: Sequence[HalfEdge], links: dict[HalfEdge, HalfEdge]
) -> tuple[tuple[HalfEdge, ...], ...]:
    loops: list[tuple[HalfEdge, ...]] = []
    done: set[HalfEdge] = set()
    for first in halves:
        if first in done:
            continue
        loop = [first]
        while (following := links.get(loop[-1], first)) != first:
            loop.append(following)
        done.update(loop)
        loops.append(tuple(loop))
    return tuple(loops)


def touches_at(
    edges: Sequence[RawEdge], points: Array, member: Member, umbrellas: Sequence[Umbrellas]
) -> list[str]:
    """Says at which vertices a region touches itself."""
    found = []
    for point, around in zip(points, umbrellas, strict=True):
        if len(around) > 1:
            carriers = {f.carrier for own in around for i, _ in own for f in edges[i].flanks}
            names = sorted({member.form.carrier_name(k) for k in carriers})
            found.append(
                f"region {member.name!r} touches itself at the point {place(point)}, "
                f"where {', '.join(names)} meet: leave a gap or let the parts overlap"
            )
    return found


def _umbrellas(
    edges: Sequence[RawEdge],
    count: int,
    following: dict[tuple[int, int, HalfEdge], HalfEdge],
) -> list[Umbrellas]:
    """The umbrellas at each of so many points."""
    tips: list[set[tuple[int, bool]]] = [set() for _ in range(count)]
    for index, edge in enumerate(edges):
        if edge.ends is not None:
            tips[edge.ends[0]].add((index, True))
            tips[edge.ends[1]].add((index, False))
    found: list[Umbrellas] = []
    for left in tips:
        around = []
        while left:
            own = _umbrella(edges, min(left), following)
            around.append(own)
            left -= own
        found.append(tuple(around))
    return found


def _umbrella(
    edges: Sequence[RawEdge],
    first: tuple[int, bool],
    following: dict[tuple[int, int, HalfEdge], HalfEdge],
) -> frozenset[tuple[int, bool]]:
    """The edge ends that one comes by from face to face over the edges, from a first one on."""
    seen = {first}
    index, at_start = first
    flank = _arriving(edges[index], at_start)
    while True:
        half = HalfEdge(index, -1 if at_start else 1)
        onward = following[flank.carrier, flank.outward, half]
        index, at_start = onward.edge, onward.direction > 0
        if (index, at_start) in seen:
            return frozenset(seen)
        seen.add((index, at_start))
        flank = _arriving(edges[index], at_start)


def _arriving(edge: RawEdge, at_start: bool) -> Flank:
    """The flank whose loop arrives at the given end of an edge."""
    direction = -1 if at_start else 1
    return next(flank for flank in edge.flanks if flank.direction_of_loop == direction)


def _normal(carrier: Carrier, point: Array) -> Array:
    """A direction to look from: the outward normal, at a cone's apex against its axis."""
    tip, inward = carrier.tip, carrier.tip_axis
    if tip is not None and inward is not None and float(norm(point - tip)) <= TINY:
        return -inward
    return carrier.normal(point)


def _chord(edge: RawEdge) -> float:
    return float(norm(np.diff(edge.sampled(5), axis=0)).sum())


def _point_near_end(edge: RawEdge, at_start: bool, reach: float) -> Array:
    """A point of the edge at about distance `reach` from one end."""
    end, sign = (edge.start, 1.0) if at_start else (edge.end, -1.0)
    tip = edge.at(np.array(end))
    step = FIRST_STEP * (edge.end - edge.start)
    while float(norm(edge.at(np.array(end + sign * step)) - tip)) < reach:
        step *= 1.2
        if step > edge.end - edge.start:
            break
    return np.asarray(edge.at(np.array(end + sign * step)))
