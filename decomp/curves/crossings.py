"""Where a curve meets a carrier."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from decomp.carriers import Carrier
from decomp.carriers.table import CarrierTable
from decomp.curves.algebraic import conic_roots
from decomp.curves.base import Curve
from decomp.curves.sampled import traced_roots
from decomp.curves.touching import Touching, anywhere
from decomp.curves.traced import TracedCurve
from decomp.tolerance import ENLARGED
from decomp.vectors import Array, Bools, Ints, norm

SPEED_ROUNDED = 1e-12
"""The speed between samples may be larger by this part than at both, for rounding."""


@dataclass(frozen=True, eq=False)
class Crossings:
    """Meeting points of a curve and a carrier.

    Attributes:
        contained: the whole curve lies on the carrier; then there are no parameters.
        parameters: all t (k,), increasing, each point once.
        tangential: (k,) whether the curve touches the carrier there.
    """

    contained: bool
    parameters: Array
    tangential: Bools


def crossings(
    curve: Curve, carrier: Carrier, tolerance: float, touches: Touching = anywhere
) -> Crossings:
    """Find every parameter at which the curve is on the carrier.

    Touches that miss by no more than `tolerance` count. If the curve keeps within
    `tolerance` of the carrier altogether, it is contained.

    Args:
        curve: the curve.
        carrier: the carrier.
        tolerance: lengths below it count as zero.
        touches: whether a curve that dips through the carrier, by no more than the tolerance,
            only touches it at points (n, 3); elsewhere it crosses twice.
    """
    probe = np.linspace(*curve.domain, 23)
    points = curve.point(probe)
    if np.abs(carrier.signed_distance(points)).max() <= tolerance:
        return Crossings(True, np.empty(0), np.empty(0, dtype=bool))
    find = traced_roots if isinstance(curve, TracedCurve) else conic_roots
    t, touch = find(curve, carrier, tolerance, touches)
    on = np.abs(carrier.signed_distance(curve.point(t))) <= tolerance
    t, touch = _once(curve, t[on], touch[on], tolerance)
    return Crossings(False, t, touch)


def may_cross(curve: Curve, *carriers: Carrier) -> Bools:
    """Tell which carriers come within reach of the curve's bounding ball (Lipschitz)."""
    centre, radius = curve.bounding_ball()
    distances = [float(c.signed_distance(centre)) for c in carriers]
    return np.asarray(np.abs(np.array(distances)) <= radius * (1 + ENLARGED))


def crossing_candidates(
    curve: Curve, carriers: Sequence[Carrier] | CarrierTable, tolerance: float = 0.0
) -> Ints:
    """Indices of the carriers that may meet the curve.

    First the bounding ball of the whole curve is used, then a chain of 32 balls about pieces
    of it: a signed distance changes by no more than the way travelled. A `CarrierTable` made
    once saves most of the time.
    """
    table = carriers if isinstance(carriers, CarrierTable) else CarrierTable(carriers)
    centre, radius = curve.bounding_ball()
    slack = ENLARGED * radius + tolerance
    near = np.nonzero(np.abs(table.distances(centre[None])[:, 0]) <= radius + slack)[0]
    if len(near) == 0:
        return near
    t = np.linspace(*curve.domain, 33)
    middle, half = (t[1:] + t[:-1]) / 2, (t[1] - t[0]) / 2
    reach = half * _speed_bound(curve, t)
    close = np.abs(table.distances(curve.point(middle), near)) <= reach + slack
    return np.asarray(near[close.any(axis=1)])


def _speed_bound(curve: Curve, t: Array) -> Array:
    """Bounds of |derivative| between neighbouring t: conics by their ends, padded."""
    if isinstance(curve, TracedCurve):
        return np.full(len(t) - 1, 1.2)
    speed = norm(curve.derivative(t))
    if curve.kind == "ellipse":
        return np.full(len(t) - 1, float(speed.max()) * 1.01)
    return np.asarray(np.maximum(speed[1:], speed[:-1]) * (1 + SPEED_ROUNDED))


def _once(curve: Curve, t: Array, touch: Bools, tolerance: float) -> tuple[Array, Bools]:
    """Sort by t and merge points closer than the tolerance."""
    t = curve.wrapped(t)
    order = np.argsort(t)
    t, touch = t[order], touch[order]
    keep: list[int] = []
    points = curve.point(t)
    for i in range(len(t)):
        same = [j for j in keep if float(norm(points[i] - points[j])) <= tolerance]
        if same:
            touch[same[0]] = touch[same[0]] or touch[i]
        else:
            keep.append(i)
    return t[keep], touch[keep]
