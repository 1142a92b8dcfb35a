"""The arrangement of all carriers along their intersection curves.

Every pair of carriers gives curves; every curve is cut where a further carrier crosses or touches
it. Between two cuts the signs of all other carriers are constant, so one point decides an arc.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial
from itertools import pairwise

import numpy as np

from decomp.boundary.shared_lines import SharedLines, StraightPart
from decomp.boundary.tangencies import Tangencies
from decomp.csg.extents import BOX_SLACK, EVERYTHING, overlap
from decomp.csg.halfspaces import HalfSpaceForm
from decomp.curves import (
    Intersection,
    crossing_candidates,
    crossings,
    intersect,
    meeting_pairs,
)
from decomp.curves.base import Curve
from decomp.curves.line import Line
from decomp.curves.straight import line_crossings
from decomp.tolerance import PARALLEL
from decomp.vectors import Array, Ints, norm

CURVE_PROBES = 23
"""Points of a curve that tell whether a carrier holds it."""
TOUCH_KNOWN = 1e-6
"""Where carriers touch, and nodes, are double points: they are located to the square root of the
working precision, as a part of the scale."""


@dataclass(frozen=True, eq=False)
class Arc:
    """A piece of an intersection curve between two cuts.

    Args:
        curve: index into `Arrangement.curves`.
        start, end: parameters, start < end; `end` may pass the end of a closed curve's domain.
        whole: whether it is a closed curve that nothing cuts.
    """

    curve: int
    start: float
    end: float
    whole: bool


@dataclass(frozen=True, eq=False)
class Contact:
    """An isolated point where two carriers touch without crossing."""

    carriers: tuple[int, int]
    point: Array


@dataclass(frozen=True, eq=False)
class Arrangement:
    """Curves with the carriers that hold them, their arcs, and point contacts.

    Args:
        form: the carriers and their program.
        radius: everything within this distance of `form.centre` was looked at.
        curves: pairwise different curves.
        carriers: for each curve the carriers that contain it, two or more, ascending.
        arcs: the curves' pieces.
        contacts: isolated touches.
    """

    form: HalfSpaceForm
    radius: float
    curves: tuple[Curve, ...]
    carriers: tuple[tuple[int, ...], ...]
    arcs: tuple[Arc, ...]
    contacts: tuple[Contact, ...]

    def leaves_window(self, point: Array) -> bool:
        """Whether a curve's end is there only because the window ends."""
        return float(norm(point - self.form.centre)) > 0.999 * self.radius


def arrange(form: HalfSpaceForm, radius: float) -> Arrangement:
    """Intersect all pairs of carriers within `radius` of the form's centre."""
    builder = _Arranger(form, radius)
    boxes = form.carrier_boxes
    met: list[tuple[int, int, Intersection]] = []
    for i, j in meeting_pairs(form.carriers, form.centre, radius, form.tolerance):
        if overlap(boxes[i], boxes[j]):
            one, other = form.carriers[i], form.carriers[j]
            met.append((i, j, intersect(one, other, form.centre, radius, form.tolerance)))
            builder.tangencies.add(*met[-1])
    for pair in met:
        builder.add_pair(*pair)
    builder.finish()
    arcs = [arc for index in range(len(builder.curves)) for arc in builder.cut(index)]
    return Arrangement(
        form,
        radius,
        tuple(builder.curves),
        tuple(builder.carriers),
        tuple(arcs),
        tuple(builder.contacts),
    )


class _Arranger:
    """Collects curves without repeating those that lie on three or more carriers."""

    def __init__(self, form: HalfSpaceForm, radius: float) -> None:
        self.form, self.radius = form, radius
        self.curves: list[Curve] = []
        self.carriers: list[tuple[int, ...]] = []
        self.contacts: list[Contact] = []
        self._cuts_of: list[Array] = []
        self._shared: dict[tuple[int, ...], list[int]] = {}
        self._lines = SharedLines(10 * form.tolerance)
        self.tangencies = Tangencies(TOUCH_KNOWN * form.scale)

    def add_pair(self, i: int, j: int, found: Intersection) -> None:
        """Add the curves of two carriers; straight ones wait for `finish`."""
        form = self.form
        self.contacts.extend(Contact((i, j), point) for point in found.contacts)
        box = np.array(_common(form.carrier_boxes[i], form.carrier_boxes[j]))
        for piece in found.curves:
            curve = _clipped(piece.curve, *box)
            if curve is None:
                continue
            contained, cuts = self._cuts(curve, (i, j), box)
            key = tuple(sorted([i, j, *contained]))
            if isinstance(curve, Line):
                self._lines.add(StraightPart(curve, key, found.nodes, cuts))
            else:
                self._add(curve, key, cuts, found.nodes)

    def finish(self) -> None:
        """Add the lines, each as long as any pair of its carriers asks for."""
        for line in self._lines.waiting():
            if line.cuts is not None:
                self._add(line.line, line.carriers, line.cuts, line.nodes)
                continue
            contained, cuts = self._cuts(line.line, line.carriers, EVERYTHING)
            key = tuple(sorted([*line.carriers, *contained]))
            # what more carriers hold may be one with other parts
            self._lines.add(StraightPart(line.line, key, line.nodes, cuts))

    def _add(self, curve: Curve, key: tuple[int, ...], cuts: Array, nodes: Array) -> None:
        self.curves.append(curve)
        self.carriers.append(key)
        self._cuts_of.append(np.concatenate([cuts, self._parameters_of(curve, nodes)]))
        self._shared.setdefault(key, []).append(len(self.curves) - 1)

    def cut(self, index: int) -> list[Arc]:
        """The arcs of one curve."""
        curve, tolerance = self.curves[index], self.form.tolerance
        low, high = curve.domain
        cuts = self._cuts_of[index]
        if len(self.carriers[index]) > 2:
            cuts = np.concatenate([cuts, self._ends_on(index)])
        if curve.closed:
            cuts = _distinct(curve, low + np.mod(cuts - low, high - low), tolerance, high - low)
            if not len(cuts):
                known = self._is_known(index, (low + high) / 2)
                return [] if known else [Arc(index, low, high, True)]
            ends = np.append(cuts, cuts[0] + high - low)
        else:
            ends = _distinct(curve, np.concatenate([[low], cuts, [high]]), tolerance, None)
        return [
            Arc(index, float(a), float(b), False)
            for a, b in pairwise(ends)
            if self._matters(index, (a + b) / 2) and not self._is_known(index, (a + b) / 2)
        ]

    def _cuts(self, curve: Curve, holding: tuple[int, ...], box: Array) -> tuple[list[int], Array]:
        """Which carriers besides `holding` hold the curve, and where others cut it in a box."""
        form = self.form
        if isinstance(curve, Line):
            ends = curve.point(np.array(curve.domain))
            around = np.array(_common(np.array([ends.min(axis=0), ends.max(axis=0)]), box))
            others = self._candidates(curve, around, holding)
            met = line_crossings(
                curve,
                form.table,
                others,
                form.tolerance,
                lambda k, points: self.tangencies.at(k, holding, points),
            )
            return met.contained.tolist(), met.parameters
        # what holds a curve is told from all of it, so that all its pairs agree
        centre, radius = curve.bounding_ball()
        ball = np.array([centre - radius, centre + radius])
        others = self._candidates(curve, ball, holding)
        points = curve.point(np.linspace(*curve.domain, CURVE_PROBES))
        gaps = np.abs(form.table.distances(points, others)).max(axis=1)
        held = gaps <= form.tolerance
        near = overlap(form.carrier_boxes[others], np.array(_common(ball, box)))
        contained, cuts = others[held].tolist(), [np.empty(0)]
        for k in others[near & ~held].tolist():
            touches = partial(self.tangencies.at, k, holding)
            crossed = crossings(curve, form.carriers[k], form.tolerance, touches)
            cuts.append(crossed.parameters)
        return contained, np.concatenate(cuts)

    def _candidates(self, curve: Curve, box: Array, holding: tuple[int, ...]) -> Ints:
        """Carriers but those that hold it that may cut a curve inside a box."""
        chosen = np.zeros(len(self.form.carriers), dtype=np.bool_)
        chosen[crossing_candidates(curve, self.form.table)] = True
        chosen[list(holding)] = False
        return np.flatnonzero(chosen & overlap(self.form.carrier_boxes, box))

    def _matters(self, index: int, parameter: float) -> bool:
        """Whether a point of a curve lies where two of its carriers can be faces.

        The boxes are wider than needed by a slack; a point within that is not inside.
        """
        curve = self.curves[index]
        point = curve.point(curve.wrapped(np.array(parameter)))
        boxes = self.form.carrier_boxes[list(self.carriers[index])]
        inside = overlap(boxes, np.array([point, point]))
        margin = 0.9 * BOX_SLACK * self.form.scale
        tight = overlap(boxes, np.array([point + margin, point - margin]))
        return int((inside & tight).sum()) >= 2

    def _before(self, index: int) -> list[Curve]:
        """Curves on the same carriers that came before this one."""
        same = self._shared[self.carriers[index]]
        return [self.curves[k] for k in same[: same.index(index)]]

    def _ends_on(self, index: int) -> Array:
        """Parameters of a curve at which earlier curves on its carriers end."""
        known = [curve for curve in self._before(index) if not curve.closed]
        ends = [curve.point(np.array(curve.domain)) for curve in known]
        curve = self.curves[index]
        found = [t for pair in ends for t in self._parameters_of(curve, pair)]
        return np.array(found, dtype=np.float64)

    def _is_known(self, index: int, parameter: float) -> bool:
        """Whether an earlier curve on the same carriers runs through a point of a curve."""
        curve = self.curves[index]
        point = curve.point(curve.wrapped(np.array([parameter])))
        return any(
            float(norm(other.point(other.parameter(point)) - point)[0]) <= 10 * self.form.tolerance
            for other in self._before(index)
        )

    def _parameters_of(self, curve: Curve, points: Array) -> Array:
        """Parameters of those points that lie on the curve."""
        if not len(points):
            return np.empty(0)
        parameters = np.atleast_1d(curve.parameter(points))
        gap = norm(curve.point(parameters) - points)
        return np.asarray(parameters[gap <= TOUCH_KNOWN * self.form.scale])


def _common(a: Array, b: Array) -> tuple[Array, Array]:
    """Corners of the box that two boxes share."""
    return np.maximum(a[0], b[0]), np.minimum(a[1], b[1])


def _clipped(curve: Curve, low: Array, high: Array) -> Curve | None:
    """The part of a straight line inside a box; other curves whole, if they may enter it."""
    if not isinstance(curve, Line):
        centre, radius = curve.bounding_ball()
        enters = overlap(np.array([centre - radius, centre + radius]), np.array([low, high]))
        return curve if enters else None
    first, last = curve.domain
    for k in range(3):
        slope = curve.direction[k]
        if abs(slope) < PARALLEL:
            if not low[k] <= curve.origin[k] <= high[k]:
                return None
            continue
        ends = sorted(((low[k] - curve.origin[k]) / slope, (high[k] - curve.origin[k]) / slope))
        first, last = max(first, ends[0]), min(last, ends[1])
    return replace(curve, domain=(float(first), float(last))) if first < last else None


def _distinct(curve: Curve, cuts: Array, tolerance: float, period: float | None) -> Array:
    """Sort parameters and drop those whose points coincide; the first and last are kept."""
    cuts = np.sort(cuts)
    if len(cuts) < 2:
        return cuts
    points = curve.point(cuts)
    middle = curve.point((cuts[1:] + cuts[:-1]) / 2)
    near = (norm(points[1:] - points[:-1]) <= 10 * tolerance) & (
        norm(middle - points[:-1]) <= 10 * tolerance
    )
    keep = np.ones(len(cuts), dtype=np.bool_)
    keep[1:] = ~near
    if period is None:
        last = cuts[-1]
        cuts = cuts[keep]
        cuts[-1] = last
    else:
        cuts = cuts[keep]
        around = np.array([cuts[0], (cuts[-1] + cuts[0] + period) / 2, cuts[-1]])
        wrap = curve.point(curve.wrapped(around))
        if len(cuts) > 1 and norm(wrap - wrap[0]).max() <= 10 * tolerance:
            cuts = cuts[:-1]
    return cuts
