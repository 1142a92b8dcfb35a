"""Edges of one region: the arcs along which two of its faces meet, joined where nothing happens."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from decomp.boundary.arcs import Arrangement
from decomp.boundary.member import Member
from decomp.boundary.points import PointTable
from decomp.boundary.topology import Convexity
from decomp.boundary.wedges import SAME_DIRECTION, HalfSheet, Star
from decomp.curves.base import Curve
from decomp.errors import UnboundedRegionError
from decomp.places import place, triple
from decomp.tolerance import SAME_PARAMETER
from decomp.vectors import Array, Bools, Ints, norm

STRAIGHT_STEP = 1e-4
"""Samples count as turned by so much more (radians), so that straight parts get some too."""


@dataclass(frozen=True, eq=False)
class Flank:
    """One of the two faces at an edge.

    Args:
        carrier: index.
        outward: +1 if the region lies inside the carrier there, -1 if outside.
        leftward: whether the face lies left of the edge's curve, seen along the carrier's normal.
        direction: unit vector (3,) from `RawEdge.point` into the face.
    """

    carrier: int
    outward: int
    leftward: bool
    direction: Array

    @property
    def direction_of_loop(self) -> int:
        """+1 if the face lies left of the curve seen from outside the region, else -1."""
        return self.outward if self.leftward else -self.outward


@dataclass(frozen=True, eq=False)
class RawEdge:
    """An edge before its faces are known.

    Args:
        curve, start, end: as in `Arc`.
        ends: indices of its end points in the point table, None for a closed edge.
        flanks: the two faces' sides.
        convexity: CONVEX, REENTRANT or SMOOTH.
        point: a point (3,) inside the edge.
    """

    curve: Curve
    curve_index: int
    start: float
    end: float
    ends: tuple[int, int] | None
    flanks: tuple[Flank, Flank]
    convexity: Convexity
    point: Array

    def at(self, t: Array) -> Array:
        """Points (..., 3) at parameters in [start, end]."""
        return self.curve.point(self.curve.wrapped(t))

    def sampled(self, count: int) -> Array:
        """Points (count, 3) evenly spaced in the parameter, ends included."""
        return self.at(np.linspace(self.start, self.end, count))

    def samples(self) -> Array:
        """Points (k, 3) from start to end, at most about 5 degrees of turning apart."""
        if self.curve.kind == "line":
            return self.sampled(2)
        t = np.linspace(self.start, self.end, 257)
        tangents = self.curve.derivative(self.curve.wrapped(t))
        tangents = tangents / norm(tangents)[:, None]
        chords = np.clip((tangents[1:] * tangents[:-1]).sum(axis=1), -1, 1)
        turned = np.concatenate([[0.0], np.cumsum(np.arccos(chords) + STRAIGHT_STEP)])
        count = max(9, int(np.ceil(turned[-1] / np.radians(5))) + 1)
        return self.at(np.interp(np.linspace(0, turned[-1], count), turned, t))

    def holds(self, point: Array, tolerance: float) -> bool:
        """Whether a point lies on the edge."""
        t = float(self.curve.parameter(point))
        if float(norm(self.curve.point(np.array(t)) - point)) > tolerance:
            return False
        if self.ends is None:
            return True
        shifts = (-self.curve.period, 0.0, self.curve.period) if self.curve.closed else (0.0,)
        slack = SAME_PARAMETER * self.curve.period
        return any(self.start - slack <= t + s <= self.end + slack for s in shifts)


def raw_edges(
    arrangement: Arrangement, stars: Sequence[Star], member: Member
) -> tuple[list[RawEdge], Array, list[str]]:
    """Find a region's edges, the points (n, 3) where they end, and where more than two faces meet.

    Where a region touches itself along an arc each of its parts there has an edge of its own.

    Raises:
        UnboundedRegionError: an edge runs out of every window.
    """
    table = PointTable(10 * arrangement.form.tolerance)
    pieces: list[RawEdge] = []
    touches: list[str] = []
    for star in stars:
        after = member.selected(star.filled)
        changing = np.flatnonzero(after != np.roll(after, 1))
        if len(changing) > 2:
            touches.append(_touch(arrangement, star, changing, member))
        around = _flanks(star, after, changing)
        if not around:
            continue
        arc = arrangement.arcs[star.arc]
        curve = arrangement.curves[arc.curve]
        ends = None
        if not arc.whole:
            tips = curve.point(curve.wrapped(np.array([arc.start, arc.end])))
            for tip in tips:
                if arrangement.leaves_window(tip):
                    raise UnboundedRegionError(_unbounded(arrangement, member, tip))
            ends = (table.add(tips[0]), table.add(tips[1]))
        pieces += [
            RawEdge(curve, arc.curve, arc.start, arc.end, ends, flanks, convexity, star.point)
            for flanks, convexity in around
        ]
    return *_joined(pieces, table.points()), touches


def _flanks(
    star: Star, after: Bools, changing: Ints
) -> list[tuple[tuple[Flank, Flank], Convexity]]:
    """The two faces of each part of a region that meet at an arc, and how.

    There is no edge where a part ends in both halves of one carrier.

    Args:
        star: the arc's.
        after: (m,) whether the region fills the wedge after each half-sheet.
        changing: the half-sheets at which that changes.
    """
    found = []
    for row, opens in enumerate(changing.tolist()):
        closes = int(changing[(row + 1) % len(changing)])
        first, last = star.sheets[opens], star.sheets[closes]
        if after[opens] and first.carrier != last.carrier:
            shape = _convexity(_interior_angle(first, last, opens < closes))
            ordered = sorted((opens, closes))
            one, two = (_flank(star.sheets[k], bool(after[k])) for k in ordered)
            found.append(((one, two), shape))
    return found


def _touch(arrangement: Arrangement, star: Star, changing: Ints, member: Member) -> str:
    """Says that a region touches itself along an arc."""
    carriers = {star.sheets[k].carrier for k in changing.tolist()}
    names = sorted({arrangement.form.carrier_name(c) for c in carriers})
    return (
        f"region {member.name!r}: {len(changing)} faces meet along one edge, on "
        f"{', '.join(names)}, near {place(star.point)}; the region touches itself there: "
        "leave a gap or let the parts overlap"
    )


def _interior_angle(first: HalfSheet, last: HalfSheet, in_order: bool) -> float:
    """The angle that the region fills from its first half-sheet to its last, in [0, 2 pi].

    Where both leave in one direction it fills nothing or all of the turn: a cusp, which the order
    of the half-sheets in the ring decides.
    """
    angle = (last.angle - first.angle) % (2 * np.pi)
    if min(angle, 2 * np.pi - angle) > SAME_DIRECTION:
        return angle
    return 0.0 if in_order else 2 * np.pi


def _flank(sheet: HalfSheet, filled_after: bool) -> Flank:
    """`filled_after` tells whether turning on past the sheet enters the region."""
    outward = 1 if filled_after == sheet.entering else -1
    return Flank(sheet.carrier, outward, sheet.leftward, sheet.direction)


def _convexity(angle: float) -> Convexity:
    if abs(angle - np.pi) <= SAME_DIRECTION:
        return Convexity.SMOOTH
    return Convexity.CONVEX if angle < np.pi else Convexity.REENTRANT


def _joined(pieces: list[RawEdge], points: Array) -> tuple[list[RawEdge], Array]:
    """Join consecutive arcs of a curve where no other edge ends and nothing changes."""
    at_point: dict[int, list[int]] = defaultdict(list)
    for index, piece in enumerate(pieces):
        for end in piece.ends or ():
            at_point[end].append(index)
    follower: dict[int, int] = {}
    for point, incident in at_point.items():
        # where a region touches itself along two arcs several pieces run along each
        arcs = {(pieces[k].curve_index, pieces[k].start) for k in incident}
        pairs = [
            (a, b)
            for a in sorted(set(incident))
            for b in sorted(set(incident))
            if _continues(pieces[a], pieces[b], point)
        ]
        if len(arcs) <= 2 and 2 * len(pairs) == len(incident):
            follower.update(pairs)
    followed = set(follower.values())
    result: list[RawEdge] = []
    done: set[int] = set()
    order = [k for k in range(len(pieces)) if k not in followed] + list(range(len(pieces)))
    for first in order:
        if first in done:
            continue
        chain = [first]
        while (following := follower.get(chain[-1], first)) != first:
            chain.append(following)
        done.update(chain)
        result.append(_merged([pieces[k] for k in chain], first in followed))
    used = sorted({end for piece in result for end in piece.ends or ()})
    number = {old: new for new, old in enumerate(used)}
    renumbered = [
        piece
        if piece.ends is None
        else replace(piece, ends=(number[piece.ends[0]], number[piece.ends[1]]))
        for piece in result
    ]
    return renumbered, points[used]


def _continues(a: RawEdge, b: RawEdge, point: int) -> bool:
    """Whether b takes up where a ends, at a point, with the same faces."""
    if a.curve_index != b.curve_index or a.ends is None or b.ends is None:
        return False
    low, high = a.curve.domain
    period = high - low if a.curve.closed else np.inf
    gap = abs(b.start - a.end)
    sides_a = {(f.carrier, f.outward, f.leftward) for f in a.flanks}
    sides_b = {(f.carrier, f.outward, f.leftward) for f in b.flanks}
    return (
        a.ends[1] == point == b.ends[0]
        and min(gap, abs(gap - period)) <= SAME_PARAMETER * (high - low)
        and sides_a == sides_b
        and a.convexity == b.convexity
    )


def _merged(chain: list[RawEdge], cyclic: bool) -> RawEdge:
    first, last = chain[0], chain[-1]
    length = sum(piece.end - piece.start for piece in chain)
    ends = None
    if not cyclic and first.ends is not None and last.ends is not None:
        ends = (first.ends[0], last.ends[1])
    return replace(first, end=first.start + length, ends=ends)


def _unbounded(arrangement: Arrangement, member: Member, tip: Array) -> str:
    away = tip - arrangement.form.centre
    away = away / np.linalg.norm(away)
    return (
        f"region {member.name!r} is unbounded: it reaches infinity in direction {triple(away)}; "
        "intersect it with a block or add half-spaces"
    )
