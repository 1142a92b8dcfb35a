"""Walk through a network of arcs and turn it into traced curves."""

from __future__ import annotations

import numpy as np

from decomp.carriers import Carrier
from decomp.curves.intersect.arcs import End, Network
from decomp.curves.newton import cross_direction, onto_pair
from decomp.curves.traced import TracedCurve, sample_tangents
from decomp.vectors import Array, dot, norm

SAMPLES_TURN = 0.1
"""Angle in radians by which neighbouring samples may turn."""

SPACING_ROUNDS = 12
MOST_SAMPLES = 20_000
OTHER_NAPPE = 1e-6
"""Samples farther off a carrier than this part of the size are on a cone's other nappe."""
REPEATED = 1e-12
"""A sample is the one before again if they are closer than this part of the whole curve."""


def chains(net: Network, a: Carrier, b: Carrier, size: float) -> list[TracedCurve]:
    """One traced curve per closed loop, and per piece between nodes, apex and border."""
    left = set(range(len(net.arcs)))
    for number in list(left):
        middle = net.arcs[number][len(net.arcs[number]) // 2]
        if abs(float(b.signed_distance(middle))) > OTHER_NAPPE * size:
            left.discard(number)  # on the other nappe of a cone
    curves = []
    ends = [(n, side) for n in sorted(left) for side in (0, 1)]
    leads = {end: net.joints[end].to for end in ends}
    starts = [end for end, to in leads.items() if to is None or to[0] not in left]
    for start in starts:
        if start[0] in left:
            curves.append(_walk(net, start, left, a, b))
    for start in ends:
        if start[0] in left:
            curves.append(_walk(net, start, left, a, b))
    return [c for c in curves if c is not None]


def _walk(net: Network, start: End, left: set[int], a: Carrier, b: Carrier) -> TracedCurve | None:
    """Follow the joints from one end until a last point, or round to the start."""
    pieces: list[Array] = []
    first = net.joints[start]
    singular = [False, False]
    if first.to is None:
        assert first.point is not None
        pieces.append(first.point[None])
        singular[0] = first.singular
    end, closed = start, False
    while True:
        number, side = end
        left.discard(number)
        arc = net.arcs[number]
        pieces.append(arc if side == 0 else arc[::-1])
        joint = net.joints[(number, 1 - side)]
        if joint.point is not None:
            pieces.append(joint.point[None])
        if joint.to is None:
            singular[1] = joint.singular
            break
        end = joint.to
        if end == start:
            closed = True
            break
        if end[0] not in left:
            break
    return traced(a, b, np.concatenate(pieces), closed, (singular[0], singular[1]))


def traced(
    a: Carrier, b: Carrier, p: Array, closed: bool, singular: tuple[bool, bool]
) -> TracedCurve | None:
    """Bring rough samples onto both carriers, space them by turning, and make the curve."""
    step = norm(np.diff(p, axis=0))
    p = p[np.concatenate([[True], step > REPEATED * step.sum()])]
    if len(p) < 3:
        return None
    fixed = np.zeros(len(p), dtype=bool)
    fixed[0], fixed[-1] = singular[0] and not closed, singular[1] and not closed
    free = ~fixed
    along, _ = cross_direction(a, b, p[free])
    p = p.copy()
    p[free] = onto_pair(a, b, p[free], along)
    p = _thinned(a, b, p, closed, singular)
    for _ in range(SPACING_ROUNDS):
        t = _tangents(a, b, p, closed, singular)
        wide = _wide(p, t, closed)
        if not wide.any() or len(p) > MOST_SAMPLES:
            break
        p = _halved(a, b, p, t, closed, wide)
    if len(p) < 3:
        return None
    t = _tangents(a, b, p, closed, singular)
    return TracedCurve(a, b, p, closed=closed, tangents=t, singular=singular)


def _tangents(a: Carrier, b: Carrier, p: Array, closed: bool, singular: tuple[bool, bool]) -> Array:
    return sample_tangents(a, b, p, closed, singular)


def _wide(p: Array, t: Array, closed: bool) -> Array:
    """Whether a chord's ends turn away from it by too much."""
    q, v = (np.roll(p, -1, axis=0), np.roll(t, -1, axis=0)) if closed else (p[1:], t[1:])
    p, t = (p, t) if closed else (p[:-1], t[:-1])
    chord = q - p
    chord = chord / norm(chord)[:, None]
    bend = np.maximum(norm(chord - t), norm(chord - v))
    return np.asarray((bend > SAMPLES_TURN / 2) | (norm(t - v) > SAMPLES_TURN))


def _halved(a: Carrier, b: Carrier, p: Array, t: Array, closed: bool, wide: Array) -> Array:
    """Insert a sample into each wide interval."""
    q, v = (np.roll(p, -1, axis=0), np.roll(t, -1, axis=0)) if closed else (p[1:], t[1:])
    i = np.nonzero(wide)[0]
    chord = q[i] - p[i]
    h = norm(chord)[:, None]
    guess = (p[i] + q[i]) / 2 + h / 8 * (t[i] - v[i])
    along = 1.5 * chord / h - (t[i] + v[i]) / 4
    along = along / norm(along)[:, None]
    middle = onto_pair(a, b, guess, along, steps=10)
    return np.insert(p, i + 1, middle, axis=0)


def _thinned(a: Carrier, b: Carrier, p: Array, closed: bool, singular: tuple[bool, bool]) -> Array:
    """Leave out samples that stand much closer than the turning asks for."""
    t = _tangents(a, b, p, closed, singular)
    step = norm(np.diff(p, axis=0))
    turn = np.arccos(np.clip(dot(t[1:], t[:-1]), -1.0, 1.0))
    measure = np.concatenate(
        [[0.0], np.cumsum(np.maximum(turn / SAMPLES_TURN, 12 * step / step.sum()))]
    )
    level = np.floor(1.25 * measure)
    keep = np.concatenate([[True], np.diff(level) > 0])
    keep[-1] = not closed
    if not closed and len(p) > 2:
        last = np.nonzero(keep[:-1])[0][-1]
        if last > 0 and float(measure[-1] - measure[last]) < 0.3:
            keep[last] = False
    return np.asarray(p[keep])
