"""What surrounds a point of an intersection curve: half-sheets, wedges, and who fills them.

In the plane across the curve every carrier that holds it shows as two half-sheets. Sorted by
angle they bound wedges; in each wedge the carriers' signs are known, so the Boolean program tells
which regions fill it, however many carriers share the curve and whether they cross or touch.
Half-sheets that leave in the same direction (tangent carriers) are sorted by how they bend: a
carrier with signed-distance Hessian H runs at height -s^2/2 e.He along its normal, at distance s
from the curve in direction e.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from decomp.boundary.arcs import Arc, Arrangement
from decomp.csg.extents import overlap
from decomp.errors import ContactError
from decomp.vectors import Array, Bools, cross, norm

SAME_DIRECTION = 1e-7
"""Half-sheets whose directions differ by less than this angle leave tangentially."""

CERTAIN_SIGN = 1e-12
"""A signed distance above this part of the scale has a certain sign: points are exact to 1e-15."""

ARCS_AT_ONCE = 1024
"""Arcs that are looked at together: memory grows with this times the number of carriers."""


@dataclass(frozen=True, eq=False)
class HalfSheet:
    """One side of one carrier at a curve.

    Args:
        carrier: index.
        direction: unit vector (3,) in the carrier's tangent plane, across the curve.
        angle: in [0, 2 pi) about the curve's tangent.
        entering: whether turning by growing angle here enters the inside of the carrier.
        leftward: whether the half-sheet lies left of the curve, seen along the carrier's normal.
    """

    carrier: int
    direction: Array
    angle: float
    entering: bool
    leftward: bool


@dataclass(frozen=True, eq=False)
class Star:
    """The half-sheets around one arc and what fills the wedges between them.

    Args:
        arc: index into the arrangement's arcs.
        point: (3,), on the arc.
        sheets: m half-sheets in order of angle.
        filled: (m, n_regions): which regions fill the wedge after each half-sheet.
    """

    arc: int
    point: Array
    sheets: tuple[HalfSheet, ...]
    filled: Bools


def stars(arrangement: Arrangement) -> list[Star]:
    """The surroundings of every arc."""
    blocks = range(0, len(arrangement.arcs), ARCS_AT_ONCE)
    return [star for first in blocks for star in _block_of_stars(arrangement, first)]


def _block_of_stars(arrangement: Arrangement, first: int) -> list[Star]:
    """The surroundings of up to BLOCK arcs from number `first` on."""
    arcs = arrangement.arcs[first : first + ARCS_AT_ONCE]
    points = np.array([_clear_point(arrangement, arc) for arc in arcs])
    inside = arrangement.form.signed_distances(points) < 0
    rings = [_half_sheets(arrangement, arc, point) for arc, point in zip(arcs, points, strict=True)]
    rows = [_wedge_signs(ring, row) for ring, row in zip(rings, inside, strict=True)]
    filled = arrangement.form.program.evaluate(np.concatenate(rows))
    ends = np.cumsum([len(ring) for ring in rings])
    return [
        Star(first + k, points[k], tuple(ring), filled[end - len(ring) : end])
        for k, (ring, end) in enumerate(zip(rings, ends, strict=True))
    ]


def _clear_point(arrangement: Arrangement, arc: Arc) -> Array:
    """A point of the arc that keeps away from all carriers which do not hold it."""
    form = arrangement.form
    holding = arrangement.carriers[arc.curve]
    curve = arrangement.curves[arc.curve]
    for fractions in ([0.5], np.linspace(0.03, 0.97, 21)):
        parameters = arc.start + np.asarray(fractions) * (arc.end - arc.start)
        points = curve.point(curve.wrapped(parameters))
        gaps = np.abs(form.signed_distances(points))
        gaps[:, holding] = np.inf
        # carriers do not matter outside their boxes
        gaps[~overlap(form.carrier_boxes, np.stack([points, points], axis=1)[:, None])] = np.inf
        clear = gaps.min(axis=1)
        best = int(np.argmax(clear))
        if clear[best] > CERTAIN_SIGN * form.scale:
            return np.asarray(points[best])
    blocker = int(np.argmin(gaps[best]))
    raise ContactError(
        f"{form.carrier_name(blocker)} runs along the curve in which "
        f"{' and '.join(form.carrier_name(k) for k in holding)} meet, closer than the "
        f"resolution {CERTAIN_SIGN * form.scale:.3g} but not along all of it, near {{at}}",
        at=points[best],
    )


def _half_sheets(arrangement: Arrangement, arc: Arc, point: Array) -> list[HalfSheet]:
    curve = arrangement.curves[arc.curve]
    tangent = np.asarray(curve.derivative(curve.parameter(point)))
    tangent = tangent / norm(tangent)
    base = np.zeros(3)
    ring: list[tuple[float, float, HalfSheet]] = []
    for index in arrangement.carriers[arc.curve]:
        carrier = arrangement.form.carriers[index]
        normal = carrier.normal(point)
        across = cross(normal, tangent)
        across = across / norm(across)
        if not base.any():
            base = across
            third = cross(tangent, base)
        for side in (1.0, -1.0):
            direction = side * across
            angle = float(np.arctan2(direction @ third, direction @ base)) % (2 * np.pi)
            turning = cross(tangent, direction)
            rising = float(normal @ turning)
            bend = -float(carrier.normal_curvature(point, direction)) * rising
            sheet = HalfSheet(index, direction, angle, rising < 0, side > 0)
            ring.append((angle, bend, sheet))
    return _sorted_ring(ring)


def _sorted_ring(ring: list[tuple[float, float, HalfSheet]]) -> list[HalfSheet]:
    """Sort by angle, and by bend where angles agree."""
    ring.sort(key=lambda item: item[0])
    # start behind a gap, so that a bundle of tangent half-sheets is not torn apart at angle 0
    angles = np.array([item[0] for item in ring])
    gaps = np.mod(angles - np.roll(angles, 1), 2 * np.pi)
    first = int(np.argmax(gaps > SAME_DIRECTION))
    ring = ring[first:] + ring[:first]
    result: list[HalfSheet] = []
    bundle: list[tuple[float, float, HalfSheet]] = []
    for item in ring:
        if bundle and (item[0] - bundle[-1][0]) % (2 * np.pi) > SAME_DIRECTION:
            result.extend(entry[2] for entry in sorted(bundle, key=lambda entry: entry[1]))
            bundle = []
        bundle.append(item)
    result.extend(entry[2] for entry in sorted(bundle, key=lambda entry: entry[1]))
    return result


def _wedge_signs(ring: Sequence[HalfSheet], inside: Bools) -> Bools:
    """Insides (m, n_carriers) in the wedge after each half-sheet."""
    rows = np.repeat(inside[None, :], len(ring), axis=0)
    current = inside.copy()
    for _ in range(2):  # the first round only brings the signs before the first half-sheet
        for k, sheet in enumerate(ring):
            current[sheet.carrier] = sheet.entering
            rows[k] = current
    return rows
