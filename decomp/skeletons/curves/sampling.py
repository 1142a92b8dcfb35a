"""The fewest points on a curve that keep its chords within a tolerance.

A chord of length s on a curve of curvature k lies k s^2 / 8 off it, so the number of chords is the
integral of sqrt(k / (8 tol)) along the curve, and samples go to equal parts of that integral.
"""

from __future__ import annotations

import numpy as np

from decomp.complex.model import CurveElement
from decomp.tolerance import TINY
from decomp.vectors import Array, dot, norm

ROUNDS = 8
FINE = 1 / 16
STRAIGHT = 1e-4
"""A curve that turns by less (radians) is straight."""
NEARLY = 1e-3
"""A part of a chord so short is none."""
EVENNESS = 0.05
"""How much of the measure is length, where all else is curvature."""


def sampled(element: CurveElement, points: Array, tolerance: float, least: int = 1) -> Array:
    """Points (n, 3) on a curve, the first and last of the given ones included.

    Args:
        element: the curve.
        points: (k, 3) on it in order, k at least 3.
        tolerance: for the distance of chords from the curve.
        least: number of chords at least.
    """
    dense = _densified(element, points, FINE * tolerance)
    chords = np.diff(dense, axis=0)
    lengths = norm(chords)
    total = float(lengths.sum())
    along = np.concatenate([[0.0], np.cumsum(lengths)])
    weight = np.sqrt(_curvature(chords, lengths) / (8 * tolerance))
    # weights are known between neighbouring chords; a chord takes the mean of its two ends
    both = np.concatenate([weight[:1], weight, weight[-1:]])
    per_chord = (both[:-1] + both[1:]) / 2 * lengths
    integral = np.concatenate([[0.0], np.cumsum(per_chord)])
    straight = float(integral[-1]) * np.sqrt(8 * tolerance / max(total, TINY)) < STRAIGHT
    count = max(least, 1 if straight else int(np.ceil(integral[-1] - NEARLY)))
    if count == 1:
        return np.asarray(dense[[0, -1]])
    if straight or integral[-1] <= 0:
        integral = along
    # a little evenness keeps samples apart where the curvature vanishes
    measure = integral / integral[-1] + EVENNESS * along / total
    stops = measure[-1] * np.arange(1, count) / count
    where = np.interp(stops, measure, along)
    guess = np.stack([np.interp(where, along, dense[:, k]) for k in range(3)], axis=1)
    return np.concatenate([dense[:1], element.place(guess), dense[-1:]])


def _densified(element: CurveElement, points: Array, tolerance: float) -> Array:
    """Points between which the curve is not farther off than a tolerance.

    Shorter chords stay: where a curve ends in a centre of curvature its place is ill defined.
    """
    dense = points
    for _ in range(ROUNDS):
        long = np.flatnonzero(norm(np.diff(dense, axis=0)) > tolerance)
        middle = (dense[long] + dense[long + 1]) / 2
        placed = element.place(middle)
        rough = norm(placed - middle) > tolerance
        if not rough.any():
            break
        dense = np.insert(dense, long[rough] + 1, placed[rough], axis=0)
    return dense


def _curvature(chords: Array, lengths: Array) -> Array:
    """Curvature (k - 2,) at the inner points of a polyline of k points."""
    directions = chords / np.maximum(lengths, TINY)[:, None]
    cosine = np.clip(dot(directions[:-1], directions[1:]), -1.0, 1.0)
    turn = norm(directions[1:] - directions[:-1])
    turn = np.where(cosine > 0.9, turn, np.arccos(cosine))
    return np.asarray(turn / np.maximum((lengths[:-1] + lengths[1:]) / 2, TINY))
