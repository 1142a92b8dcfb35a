"""The edges of all regions cut into pieces that are shared wherever regions touch.

An edge is cut at every vertex of any region that lies on it, and where it crosses an edge of
another region. Pieces of two regions on one curve are then the same or disjoint.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import combinations, pairwise

import numpy as np

from decomp.boundary.points import PointTable
from decomp.boundary.topology import Edge
from decomp.csg.halfspaces import HalfSpaceForm
from decomp.curves import crossings
from decomp.curves.base import Curve
from decomp.geometry import Geometry
from decomp.tolerance import ENLARGED, SAME_PARAMETER
from decomp.vectors import Array, Ints, norm

WELD = 10
"""Points closer than this many tolerances are one, as in the boundary itself."""
SAME_CUT = 1e-6
"""Cuts of a curve at one node are one if they are closer than this part of its period."""


@dataclass(frozen=True, eq=False)
class Piece:
    """A part of a curve between two nodes, or a whole closed curve without one.

    Args:
        curve: the untrimmed curve.
        start, end: parameters, start < end; `end` may pass the end of a closed curve's domain.
        ends: the nodes at start and end, None for a closed piece.
        carriers: all that contain the piece, ascending.
    """

    curve: Curve
    start: float
    end: float
    ends: tuple[int, int] | None
    carriers: tuple[int, ...]

    @property
    def closed(self) -> bool:
        """Whether the piece is a loop without a node."""
        return self.ends is None

    def point(self, t: Array) -> Array:
        """Points (..., 3) at parameters (...) between start and end."""
        return self.curve.point(self.curve.wrapped(t))

    def between(self, t0: float, t1: float) -> float:
        """A parameter halfway between two neighbouring samples."""
        return (t0 + t1) / 2

    def place(self, points: Array) -> Array:
        """Points (k, 3) near the piece brought onto its curve."""
        return self.curve.point(self.curve.parameter(points))


@dataclass(frozen=True, eq=False)
class Pieces:
    """The pieces of all edges of a model.

    Args:
        nodes: (n, 3) where pieces end; also apexes, and vertices that lie on no edge.
        pieces: pairwise different.
        of_edge: for each region and each of its edges the (piece, +1 or -1: along the piece or
            against it) that it consists of, in order.
        of_vertex: for each region the nodes of its vertices.
    """

    nodes: Array
    pieces: tuple[Piece, ...]
    of_edge: tuple[tuple[tuple[tuple[int, int], ...], ...], ...]
    of_vertex: tuple[tuple[int, ...], ...]


@dataclass(frozen=True, eq=False)
class _Use:
    """An edge of a region on a curve."""

    region: int
    index: int
    edge: Edge


def boundary_pieces(geometry: Geometry, more: Iterable[Array] = ()) -> Pieces:
    """Cut the edges of all regions of a model into shared pieces.

    Args:
        geometry: of the model.
        more: points (3,) on edges at which they are to be cut too.
    """
    form = geometry.boundaries.form
    table = PointTable(WELD * form.tolerance)
    of_vertex = tuple(
        tuple(table.add(vertex.point) for vertex in region.vertices) for region in geometry.regions
    )
    uses = _by_curve(geometry)
    if len(geometry.regions) > 1:
        for point in _edge_crossings(uses, form):
            table.add(point)
    for point in more:
        table.add(point)
    nodes = table.points()

    pieces: list[Piece] = []
    of_edge: list[list[tuple[tuple[int, int], ...]]] = [
        [()] * len(region.edges) for region in geometry.regions
    ]
    for on_curve in uses:
        curve = on_curve[0].edge.curve
        cuts, at = _cuts(on_curve, nodes, of_vertex, WELD * form.tolerance)
        known: dict[int, int] = {}
        for use in on_curve:
            run = []
            for first, t0, t1, ends in _run(use, of_vertex, cuts, at):
                if first not in known:
                    known[first] = len(pieces)
                    pieces.append(Piece(curve, t0, t1, ends, _containing(form, curve, t0, t1)))
                run.append((known[first], 1))
            of_edge[use.region][use.index] = tuple(run)
    return Pieces(nodes, tuple(pieces), tuple(tuple(edges) for edges in of_edge), of_vertex)


def _by_curve(geometry: Geometry) -> list[list[_Use]]:
    """The edges of all regions, those on one curve together."""
    found: dict[int, list[_Use]] = defaultdict(list)
    for r, region in enumerate(geometry.regions):
        for k, edge in enumerate(region.edges):
            found[id(edge.curve)].append(_Use(r, k, edge))
    return list(found.values())


def _edge_crossings(uses: Sequence[Sequence[_Use]], form: HalfSpaceForm) -> list[Array]:
    """Points at which edges of different regions on different curves meet."""
    boxes = []
    for on_curve in uses:
        samples = np.concatenate([use.edge.samples for use in on_curve])
        low, high = samples.min(axis=0), samples.max(axis=0)
        # between samples, 5 degrees apart, a curve leaves their box by less than this
        slack = 0.05 * float(norm(high - low)) + WELD * form.tolerance
        boxes.append((low - slack, high + slack))
    regions = [{use.region for use in on_curve} for on_curve in uses]
    found = []
    for i, j in combinations(range(len(uses)), 2):
        if len(regions[i] | regions[j]) < 2:
            continue
        if (boxes[i][0] > boxes[j][1]).any() or (boxes[j][0] > boxes[i][1]).any():
            continue
        first, second = uses[i][0].edge, uses[j][0].edge
        for point in _curve_crossings(first, second, form):
            if all(_on_some(point, uses[k], WELD * form.tolerance) for k in (i, j)):
                found.append(point)
    return found


def _curve_crossings(first: Edge, second: Edge, form: HalfSpaceForm) -> Array:
    """Points (k, 3) of the first edge's curve on a carrier of the second."""
    for k in second.carriers:
        met = crossings(first.curve, form.carriers[k], form.tolerance)
        if not met.contained:
            return first.curve.point(met.parameters)
    return np.empty((0, 3))


def _on_some(point: Array, uses: Sequence[_Use], tolerance: float) -> bool:
    """Whether a point lies on one of the edges of a curve."""
    curve = uses[0].edge.curve
    t = float(curve.parameter(point))
    if float(norm(curve.point(np.array(t)) - point)) > tolerance:
        return False
    slack = SAME_PARAMETER * curve.period
    shifts = (-curve.period, 0.0, curve.period) if curve.closed else (0.0,)
    return any(
        use.edge.closed or use.edge.start - slack <= t + s <= use.edge.end + slack
        for use in uses
        for s in shifts
    )


def _cuts(
    uses: Sequence[_Use], nodes: Array, of_vertex: Sequence[Sequence[int]], tolerance: float
) -> tuple[Array, Ints]:
    """Parameters (k,) in the curve's domain where it is cut, ascending, and the nodes there."""
    curve = uses[0].edge.curve
    found: list[tuple[float, int]] = []
    for use in uses:
        if use.edge.vertices is not None:
            ends = curve.wrapped(np.array([use.edge.start, use.edge.end]))
            found += [
                (float(t), of_vertex[use.region][v])
                for t, v in zip(ends, use.edge.vertices, strict=True)
            ]
    centre, radius = curve.bounding_ball()
    near = np.flatnonzero(norm(nodes - centre) <= radius * (1 + ENLARGED) + tolerance)
    t = np.atleast_1d(curve.parameter(nodes[near])) if len(near) else np.empty(0)
    on = norm(curve.point(t) - nodes[near]) <= tolerance
    found += list(zip(t[on].tolist(), near[on].tolist(), strict=True))

    same = SAME_CUT * curve.period
    kept: list[tuple[float, int]] = []
    for t0, node in found:
        gaps = [abs(t0 - t1) for t1, other in kept if other == node]
        if not any(g <= same or (curve.closed and curve.period - g <= same) for g in gaps):
            kept.append((t0, node))
    kept.sort()
    return np.array([t for t, _ in kept]), np.array([n for _, n in kept], dtype=np.int64)


def _run(
    use: _Use, of_vertex: Sequence[Sequence[int]], cuts: Array, at: Ints
) -> list[tuple[int, float, float, tuple[int, int] | None]]:
    """The parts of an edge between cuts: (first cut, start, end, nodes)."""
    edge = use.edge
    curve = edge.curve
    if not len(cuts):
        return [(-1, edge.start, edge.end, None)]
    if edge.vertices is None:
        stops = [(float(t), int(n), k) for k, (t, n) in enumerate(zip(cuts, at, strict=True))]
        stops.append((stops[0][0] + curve.period, stops[0][1], 0))
    else:
        same = SAME_CUT * curve.period
        turns = (-1, 0, 1, 2) if curve.closed else (0,)
        inner = sorted(
            (float(t) + turn * curve.period, int(n), k)
            for k, (t, n) in enumerate(zip(cuts, at, strict=True))
            for turn in turns
            if edge.start + same < t + turn * curve.period < edge.end - same
        )
        first, last = (of_vertex[use.region][v] for v in edge.vertices)
        stops = [
            (edge.start, first, _nearest(curve, cuts, at, edge.start, first)),
            *inner,
            (edge.end, last, -1),
        ]
    return [(a[2], a[0], b[0], (a[1], b[1])) for a, b in pairwise(stops)]


def _nearest(curve: Curve, cuts: Array, at: Ints, t: float, node: int) -> int:
    """The cut at a parameter."""
    gap = np.abs(cuts - float(curve.wrapped(np.array(t))))
    if curve.closed:
        gap = np.minimum(gap, curve.period - gap)
    return int(np.argmin(np.where(at == node, gap, np.inf)))


def _containing(form: HalfSpaceForm, curve: Curve, start: float, end: float) -> tuple[int, ...]:
    """The carriers that hold a part of a curve."""
    t = start + (end - start) * np.array([0.0, 0.173, 0.391, 0.632, 0.845, 1.0])
    distances = form.table.distances(curve.point(curve.wrapped(t)))
    held = (np.abs(distances) <= WELD * form.tolerance).all(axis=1)
    return tuple(np.flatnonzero(held).tolist())
