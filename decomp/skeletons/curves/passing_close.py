"""Curves that pass close to each other are sampled finely there.

Between two curves that pass each other in a gap d, chords are on the right sides of each other as
long as they stand out from their curves by less than d: chords of the order of the root of d. They
are halved there only, as elsewhere so short ones would be many.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations

import numpy as np
from scipy.spatial import cKDTree  # type: ignore[import-untyped]

from decomp.complex.model import CurveElement
from decomp.skeletons.curves.pieces import CurvePiece
from decomp.tolerance import TINY
from decomp.vectors import Array, Bools, Ints, dot, norm

SHARE = 0.25
"""Chords may stand out from their curves by this part of the gap to another one."""
LONGER, THIN = 2.0, 1e-6
"""Chords may be so many times as long as those of the other curve beside them, unless the gap is
wider than this part of their length: triangles between both have no area else."""
ROUNDS = 24
"""So often chords are halved at most."""
ASIDE = 0.5
"""A chord's middle is not placed farther from it than this part of its length."""
ROUNDING = 1e-13
"""What stands out by less than this part of the size does so by rounding."""
PARALLEL = 1e-12
"""Square of the sine of the angle between chords below which they are parallel."""


def parted(
    pieces: Sequence[CurvePiece], samples: Sequence[Array], tolerance: float, size: float
) -> list[Array]:
    """Samples of all pieces, with more of them where two that border one sheet pass closely.

    Those that have a node in common are left alone, see `leaving_together`.

    Args:
        pieces: of a network.
        samples: (n, 3) of each piece in order, its ends included.
        tolerance: by which chords stand out from their curves at most.
        size: of the region.
    """
    found = [np.array(own) for own in samples]
    by_pair: dict[tuple[int, int], list[int]] = {}
    for number, piece in enumerate(pieces):
        for pair in set(piece.pairs):
            by_pair.setdefault(pair, []).append(number)
    boxes = [(line.min(axis=0), line.max(axis=0)) for line in found]
    room = 2 * tolerance / SHARE
    for one, other in sorted({two for group in by_pair.values() for two in combinations(group, 2)}):
        (low, high), (other_low, other_high) = boxes[one], boxes[other]
        if (low > other_high + room).any() or (other_low > high + room).any():
            continue
        if set(pieces[one].ends or ()).isdisjoint(pieces[other].ends or ()):
            curves = pieces[one].element, pieces[other].element
            lines = found[one], found[other]
            found[one], found[other] = _parted(curves, lines, tolerance, ROUNDING * size)
    return found


def _parted(
    curves: tuple[CurveElement, CurveElement],
    lines: tuple[Array, Array],
    tolerance: float,
    rounding: float,
) -> tuple[Array, Array]:
    """The samples of two curves, chords halved that stand out by much of the gap between both."""
    one, other = lines
    reach = tolerance / SHARE
    for _ in range(ROUNDS):
        pairs = _near(one, other, reach)
        if not len(pairs):
            break
        gap = _gaps(one, other, pairs)
        pairs, gap = pairs[gap < reach], gap[gap < reach]
        sides = norm(np.diff(one, axis=0))[pairs[:, 0]], norm(np.diff(other, axis=0))[pairs[:, 1]]
        long = [(gap < THIN * a) & (a > LONGER * b) for a, b in (sides, sides[::-1])]
        one, more = _halved(curves[0], one, pairs[:, 0], gap, long[0], rounding)
        other, others = _halved(curves[1], other, pairs[:, 1], gap, long[1], rounding)
        if not (more or others):
            break
    return one, other


def _near(one: Array, other: Array, reach: float) -> Ints:
    """Pairs (k, 2) of chords of two polylines that may be nearer to each other than a reach."""
    middles, halves = zip(*(_balls(line) for line in (one, other)), strict=True)
    tree = cKDTree(middles[1])
    near = tree.query_ball_point(middles[0], halves[0] + halves[1].max() + reach)
    pairs = np.array([(i, j) for i, own in enumerate(near) for j in own]).reshape(-1, 2)
    pairs = pairs.astype(np.int64)
    gap = norm(middles[0][pairs[:, 0]] - middles[1][pairs[:, 1]])
    return np.asarray(pairs[gap <= halves[0][pairs[:, 0]] + halves[1][pairs[:, 1]] + reach])


def _balls(line: Array) -> tuple[Array, Array]:
    """The middles (k, 3) of a polyline's chords, and half their lengths (k,)."""
    return (line[:-1] + line[1:]) / 2, norm(np.diff(line, axis=0)) / 2


def _gaps(one: Array, other: Array, pairs: Ints) -> Array:
    """The least distances (k,) of pairs of chords of two polylines."""
    p, q = one[pairs[:, 0]], other[pairs[:, 1]]
    u, v = one[pairs[:, 0] + 1] - p, other[pairs[:, 1] + 1] - q
    way = p - q
    uu, vv = np.maximum(dot(u, u), TINY), np.maximum(dot(v, v), TINY)
    uv, uw, vw = dot(u, v), dot(u, way), dot(v, way)
    best = np.full(len(pairs), np.inf)
    square = uu * vv - uv**2
    clear = square > PARALLEL * uu * vv
    s = np.where(clear, (uv * vw - vv * uw) / np.where(clear, square, 1.0), 0.0)
    # inside both, or at one of the four ends
    for first in (s, np.zeros_like(s), np.ones_like(s)):
        first = np.clip(first, 0.0, 1.0)
        second = np.clip((vw + first * uv) / vv, 0.0, 1.0)
        first = np.clip((second * uv - uw) / uu, 0.0, 1.0)
        best = np.minimum(best, norm(way + first[:, None] * u - second[:, None] * v))
    return best


def _halved(
    curve: CurveElement, line: Array, chords: Ints, gap: Array, long: Bools, rounding: float
) -> tuple[Array, bool]:
    """A polyline with chords halved that are too long beside another one; and whether any are.

    Args:
        curve: that the polyline is on.
        line: (n, 3).
        chords: (k,) of it that are near to chords of the other one.
        gap: (k,) between both.
        long: (k,) whether the other one has much shorter chords there.
        rounding: what a chord may stand out from its curve in any case.
    """
    least = np.full(len(line) - 1, np.inf)
    np.minimum.at(least, chords, gap)
    rows = np.flatnonzero(np.isfinite(least))
    middle = (line[rows] + line[rows + 1]) / 2
    placed = curve.place(middle)
    off, length = norm(placed - middle), norm(line[rows + 1] - line[rows])
    coarse: Bools = (off > SHARE * least[rows]) & (off > rounding)
    coarse |= np.isin(rows, chords[long])
    coarse &= off < ASIDE * length
    return np.insert(line, rows[coarse] + 1, placed[coarse], axis=0), bool(coarse.any())
