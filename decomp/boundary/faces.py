"""Which loops bound one face, and which carriers are faces as a whole."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from decomp.boundary.edges import RawEdge
from decomp.boundary.loops import HalfEdge, LoopSet
from decomp.boundary.member import Member
from decomp.boundary.rays import Walker
from decomp.boundary.torus_loops import Winding, encloses_nothing, winding
from decomp.carriers import Carrier, Torus
from decomp.curves.base import Curve
from decomp.errors import ContactError
from decomp.vectors import Array, Ints, norm

RAYS_PER_LOOP = 16


@dataclass(frozen=True, eq=False)
class RawFace:
    """A face before it has a name and an area.

    Args:
        carrier, outward: as in `Face`.
        loops: its bounding loops.
        point: a point (3,) inside.
    """

    carrier: int
    outward: int
    loops: tuple[tuple[HalfEdge, ...], ...]
    point: Array


def raw_faces(
    edges: Sequence[RawEdge], sets: Sequence[LoopSet], member: Member, reach: float
) -> list[RawFace]:
    """Group loops into faces and add the carriers that are faces without an edge."""
    faces: list[RawFace] = []
    for loop_set in sets:
        walker = Walker(member, edges, loop_set, reach)
        for group in _groups(walker):
            loops = tuple(loop_set.loops[k] for k in group)
            point = interior_point(walker, loops)
            faces.append(RawFace(loop_set.carrier, loop_set.outward, loops, point))
    bounded = {loop_set.carrier for loop_set in sets}
    for index, carrier in enumerate(member.form.carriers):
        if index not in bounded and carrier.closed:
            face = _whole_carrier(index, carrier, member)
            if face is not None:
                faces.append(face)
    return sorted(faces, key=lambda face: face.carrier)


def face_at(
    edges: Sequence[RawEdge],
    sets: Sequence[LoopSet],
    faces: Sequence[RawFace],
    member: Member,
    reach: float,
    carrier: int,
    points: Array,
) -> Ints:
    """Indices (n,) of the faces that hold points (n, 3) of one carrier, -1 where there is none.

    Exact but slow where the carrier has several faces: every point walks to the nearest loop.
    """
    result = np.full(len(points), -1, dtype=np.int64)
    for outward in (1, -1):
        here = [k for k, f in enumerate(faces) if (f.carrier, f.outward) == (carrier, outward)]
        if not here:
            continue
        on = np.flatnonzero(member.is_face(carrier, outward, points))
        if len(here) == 1:
            result[on] = here[0]
            continue
        loop_set = next(s for s in sets if (s.carrier, s.outward) == (carrier, outward))
        walker = Walker(member, edges, loop_set, reach)
        owner = {loop: k for k in here for loop in faces[k].loops}
        for index in on:
            loop = _loop_reached(walker, points[index])
            if loop is not None:
                result[index] = owner[loop_set.loops[loop]]
    return result


def interior_point(walker: Walker, loops: Sequence[Sequence[HalfEdge]]) -> Array:
    """A point inside a face: a short walk from the middle of its longest edges.

    Raises:
        ContactError: the face is narrower than the tolerance everywhere it was tried.
    """
    carrier = walker.member.form.carriers[walker.loops.carrier]
    halves = [half for loop in loops for half in loop]
    lengths = [float(norm(np.diff(walker.edges[h.edge].sampled(9), axis=0)).sum()) for h in halves]
    for index in np.argsort(lengths)[::-1][:8]:
        edge = walker.edges[halves[index].edge]
        flank = next(
            f
            for f in edge.flanks
            if f.carrier == walker.loops.carrier and f.direction_of_loop == halves[index].direction
        )
        for step in 10.0 ** -np.arange(1, 10) * lengths[index]:
            if step < walker.member.form.tolerance:
                break
            way = np.linspace(0.02, 1.0, 25)[:, None] * step * flank.direction
            path = carrier.project(edge.point + way)
            if walker.on_face(path).all():
                return np.asarray(path[-1])
    raise ContactError(
        f"region {walker.member.name!r}: a face on "
        f"{walker.member.form.carrier_name(walker.loops.carrier)} near "
        "{at} is too narrow to resolve",
        at=walker.edges[halves[0].edge].point,
    )


def _groups(walker: Walker) -> list[list[int]]:
    """Indices of loops, those of one face together."""
    count = len(walker.loops.loops)
    parent = list(range(count))

    def root(k: int) -> int:
        while parent[k] != k:
            k = parent[k]
        return k

    if count > 1:
        carrier = walker.member.form.carriers[walker.loops.carrier]
        apart = count
        for index, loop in enumerate(walker.loops.loops):
            for other in _reached_from(walker, carrier, loop):
                if root(index) != root(other):
                    parent[root(index)] = root(other)
                    apart -= 1
                if apart == 1:
                    break
        if isinstance(carrier, Torus):
            _join_outer_torus_loops(walker, parent, root)
    groups: dict[int, list[int]] = {}
    for k in range(count):
        groups.setdefault(root(k), []).append(k)
    return list(groups.values())


def _reached_from(walker: Walker, carrier: Carrier, loop: Sequence[HalfEdge]) -> Iterator[int]:
    """Loops of the same face that rays from a loop arrive at.

    From a hole's highest point the way up lies in the face and meets a loop that reaches higher,
    so the rays from all holes lead on to the face's one outer loop.
    """
    # without the vertices, where another face of the same carrier may touch
    parts = [walker.edges[half.edge].sampled(67)[1:-1] for half in loop]
    samples = np.concatenate(parts)
    owner = [half for half, part in zip(loop, parts, strict=True) for _ in part]
    rays: Iterator[tuple[HalfEdge, Curve]]
    if isinstance(carrier, Torus):
        rows = range(0, len(samples), max(1, len(samples) // RAYS_PER_LOOP))
        rays = ((owner[k], ray) for k in rows for ray in walker.around_torus(samples[k]))
    else:
        highest = int(np.argmax(walker.height(samples)))
        upward = walker.upward(samples[highest])
        rays = ((owner[highest], ray) for ray in (upward,) if ray is not None)
    for half, ray in rays:
        if not walker.may_enter(half, ray):
            continue
        reached = walker.first_loop(ray, from_edge=True)
        if reached is not None:
            yield reached


def _loop_reached(walker: Walker, point: Array) -> int | None:
    """A loop of the face that holds a point."""
    ray = walker.upward(walker.clear_of_vertices(point))
    rays = walker.around_torus(point) if ray is None else [ray]
    for candidate in rays:
        loop = walker.first_loop(candidate, from_edge=False)
        if loop is not None:
            return loop
    return None


def _join_outer_torus_loops(walker: Walker, parent: list[int], root: Callable[[int], int]) -> None:
    """Loops that enclose nothing and go around neither way all bound the torus's one big face."""
    carrier = walker.member.form.carriers[walker.loops.carrier]
    assert isinstance(carrier, Torus)
    windings: list[Winding] = [
        winding(carrier, walker.edges, loop, walker.loops.outward) for loop in walker.loops.loops
    ]
    members: dict[int, list[int]] = {}
    for k in range(len(windings)):
        members.setdefault(root(k), []).append(k)
    big = [
        key for key, group in members.items() if all(encloses_nothing(windings[k]) for k in group)
    ]
    for key in big[1:]:
        parent[root(key)] = root(big[0])


def _whole_carrier(index: int, carrier: Carrier, member: Member) -> RawFace | None:
    """The face that covers a carrier which no edge crosses."""
    samples = carrier.project(_samples(carrier))
    gaps = np.abs(member.form.signed_distances(samples))
    gaps[:, index] = np.inf
    point = samples[int(np.argmax(gaps.min(axis=1)))]
    for outward in (1, -1):
        if bool(member.is_face(index, outward, point)):
            return RawFace(index, outward, (), point)
    return None


def _samples(carrier: Carrier) -> Array:
    """Points scattered around a closed carrier."""
    rng = np.random.default_rng(0)
    directions = rng.normal(size=(64, 3))
    directions /= norm(directions)[:, None]
    return np.asarray(carrier.packed()[:3] + carrier.width * directions)
