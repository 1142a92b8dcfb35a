"""Arcs v(u) between neighbouring events, and how their ends join.

Between events the number of zeros is constant and they keep their order. What happens at an
event then decides by order alone which ends belong together.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from decomp.carriers import Carrier
from decomp.curves.intersect.charts import Chart
from decomp.curves.intersect.events import Event, Kind, UnresolvedError
from decomp.curves.intersect.isolines import zeros
from decomp.curves.intersect.pulled import Pulled
from decomp.vectors import Array

AT_ONCE = 1e-9
"""Events whose angles differ by no more than this happen at once."""

INTERIOR = 10
PER_TURN = 40
OFFSET = 1e-6
GENERIC = 0.4637
"""Where between events the zeros are counted: not half-way, where symmetry puts contacts."""

End = tuple[int, int]
"""Arc number and end: 0 where u is least, 1 where it is greatest."""


@dataclass(eq=False)
class Joint:
    """Where an end leads: to another end (through a point, if given), or to a last point."""

    to: End | None
    point: Array | None
    singular: bool = False


@dataclass(eq=False)
class Network:
    """All arcs with their joints."""

    arcs: list[Array] = field(default_factory=list)
    joints: dict[End, Joint] = field(default_factory=dict)


def network(f: Pulled, chart: Chart, b: Carrier, events: list[Event]) -> Network:
    """Sample the arcs and join their ends.

    Raises:
        UnresolvedError: the ends do not match.
    """
    turn = 2 * np.pi
    groups = _groups([*events, Event(Kind.CUT, 0.0, 0.0, np.zeros(3))])
    at = [float(np.mean([e.u for e in g])) for g in groups]
    at[0] = 0.0
    result = Network()
    spans = []
    for i, start in enumerate(at):
        stop = at[i + 1] if i + 1 < len(at) else turn
        spans.append(_span(f, chart, start, stop, (groups[i], groups[(i + 1) % len(at)]), result))
    for i, group in enumerate(groups):
        _join(group, spans[i - 1][1], spans[i][0], chart, result)
    return result


def _groups(events: list[Event]) -> list[list[Event]]:
    """Events in order of u, those at one angle together; the first group holds u = 0."""
    turn = 2 * np.pi
    ordered = sorted(events, key=lambda e: 0.0 if turn - e.u % turn < AT_ONCE else e.u % turn)
    groups: list[list[Event]] = []
    last = -1.0
    for e in ordered:
        u = 0.0 if turn - e.u % turn < AT_ONCE else e.u % turn
        if groups and u - last <= AT_ONCE:
            groups[-1].append(e)
        else:
            groups.append([e])
        last = u
    return groups


Ends = list[tuple[float, End]]


def _span(
    f: Pulled,
    chart: Chart,
    start: float,
    stop: float,
    groups: tuple[list[Event], list[Event]],
    result: Network,
) -> tuple[Ends, Ends]:
    """Sample the arcs between two events; return their first and last ends with v near there."""
    width = stop - start
    n = INTERIOR + int(PER_TURN * width / (2 * np.pi))
    s = (np.arange(n) + GENERIC) * np.pi / n
    u = (start + stop) / 2 - width / 2 * np.cos(s)
    offsets = [min(max([OFFSET * width, *(3 * e.zone for e in g)]), width / 4) for g in groups]
    count = len(zeros(f, np.array([start + GENERIC * width]), chart.low, chart.high)[0])
    if count == 0:
        return [], []
    inner = u[(u > start + offsets[0]) & (u < stop - offsets[1])]
    probe = np.concatenate([[start + offsets[0]], inner, [stop - offsets[1]]])
    rows = zeros(f, probe, chart.low, chart.high, count)
    if any(len(row) != count for row in rows):
        raise UnresolvedError
    v = np.array(rows)
    first: Ends = []
    last: Ends = []
    for k in range(count):
        number = len(result.arcs)
        result.arcs.append(chart.point(probe[1:-1], v[1:-1, k]))
        first.append((float(v[0, k]), (number, 0)))
        last.append((float(v[-1, k]), (number, 1)))
    return first, last


def _join(group: list[Event], left: Ends, right: Ends, chart: Chart, result: Network) -> None:
    """Join the ends before (left) and after (right) an angle by the events there."""
    left, right = list(left), list(right)
    joints = result.joints

    def link(one: End, two: End, point: Array | None = None) -> None:
        joints[one], joints[two] = Joint(two, point), Joint(one, point)

    for e in group:
        if e.kind in (Kind.LOW, Kind.HIGH) and chart.round:
            if not left or not right:
                raise UnresolvedError
            one = left.pop(-1 if e.rising else 0)
            two = right.pop(0 if e.rising else -1)
            link(one[1], two[1])
        elif e.kind in (Kind.LOW, Kind.HIGH):
            leaving = e.rising == (e.kind is Kind.HIGH)
            ends = left if leaving else right
            if not ends:
                raise UnresolvedError
            end = ends.pop(-1 if e.kind is Kind.HIGH else 0)[1]
            joints[end] = Joint(None, e.point, e.singular)
    for e in group:
        if e.kind is Kind.FOLD:
            ends = right if e.rising else left
            if len(ends) < 2:
                raise UnresolvedError
            off = [_gap(end[0], e.v, chart) for end in ends]
            pairs = [max(off[k], off[k + 1]) for k in range(len(ends) - 1)]
            k = int(np.argmin(pairs))
            if chart.round and len(ends) > 2 and max(off[0], off[-1]) < pairs[k]:
                one, two = ends.pop(-1), ends.pop(0)
            else:
                one, two = ends.pop(k), ends.pop(k)
            link(one[1], two[1], e.point)
    for e in group:
        if e.kind is Kind.NODE:
            every = [(_gap(v, e.v, chart), 0, (v, end)) for v, end in left]
            every += [(_gap(v, e.v, chart), 1, (v, end)) for v, end in right]
            every.sort()
            if len(every) < 4 or every[3][0] > 0.1:
                raise UnresolvedError
            for _, side, item in every[:4]:
                (left, right)[side].remove(item)
                joints[item[1]] = Joint(None, e.point, singular=True)
    if len(left) != len(right):
        raise UnresolvedError
    for one, two in zip(left, right, strict=True):
        if _gap(one[0], two[0], chart) > 0.5:
            raise UnresolvedError
        v = (one[0] + two[0]) / 2
        split = [e for e in group if e.kind is Kind.SPLIT and _gap(e.v, v, chart) < 1e-3]
        if split:
            joints[one[1]] = Joint(None, split[0].point, singular=True)
            joints[two[1]] = Joint(None, split[0].point, singular=True)
        else:
            link(one[1], two[1])


def _gap(v: float, w: float, chart: Chart) -> float:
    gap = abs(v - w)
    return min(gap, 2 * np.pi - gap) if chart.round else gap
