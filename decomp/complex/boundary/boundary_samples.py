"""Samples of pieces: as few points as keep a polyline near its curve, and the vertices they are."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from decomp.complex.boundary.boundary_pieces import Piece, Pieces
from decomp.vectors import Array, Ints, norm

CURVE_TURN = np.radians(60)
"""The most that a curve turns from one sample to the next."""
DENSE = 257
NO_MORE = 1e-6
"""For an excess below this part of all that is to be sampled there is no further sample."""


@dataclass(frozen=True, eq=False)
class Samples:
    """Sampled pieces.

    Args:
        parameters: for each piece ascending, from its start to its end, both included.
        vertices: for each piece the indices of points; a closed piece repeats its first.
        points: (n, 3), the nodes first.
    """

    parameters: tuple[Array, ...]
    vertices: tuple[Ints, ...]
    points: Array

    @property
    def segments(self) -> tuple[Ints, ...]:
        """For each piece its segments (k, 2)."""
        return tuple(np.stack([v[:-1], v[1:]], axis=1) for v in self.vertices)


def sample_pieces(pieces: Pieces, tolerance: float) -> Samples:
    """Sample all pieces so that every segment has a sagitta below the tolerance."""
    return numbered(pieces, [piece_samples(piece, tolerance) for piece in pieces.pieces])


def numbered(pieces: Pieces, parameters: Sequence[Array]) -> Samples:
    """Give vertices to samples: nodes are theirs already, inner samples follow piece by piece."""
    points, vertices, count = [pieces.nodes], [], len(pieces.nodes)
    for piece, t in zip(pieces.pieces, parameters, strict=True):
        inner = t[:-1] if piece.closed else t[1:-1]
        fresh = np.arange(count, count + len(inner))
        first, last = (fresh[0], fresh[0]) if piece.ends is None else piece.ends
        body = fresh[1:] if piece.closed else fresh
        vertices.append(np.array([first, *body, last], dtype=np.int64))
        points.append(piece.point(inner))
        count += len(inner)
    return Samples(tuple(parameters), tuple(vertices), np.concatenate(points))


def refined(
    pieces: Pieces, samples: Samples, split: Iterable[tuple[int, int]]
) -> tuple[Array, ...]:
    """Parameters with a new sample halfway along each of the given (piece, segment)."""
    parameters = list(samples.parameters)
    new: dict[int, list[float]] = {}
    for k, segment in split:
        t0, t1 = parameters[k][segment : segment + 2]
        new.setdefault(k, []).append(pieces.pieces[k].between(float(t0), float(t1)))
    for k, more in new.items():
        parameters[k] = np.unique(np.concatenate([parameters[k], more]))
    return tuple(parameters)


def piece_samples(piece: Piece, tolerance: float) -> Array:
    """Parameters (k,) from start to end at equal quantiles of the integral of sqrt(curvature)."""
    if piece.curve.kind == "line":
        return np.array([piece.start, piece.end])
    t = np.linspace(piece.start, piece.end, DENSE)
    points = piece.point(t)
    tangents = piece.curve.derivative(piece.curve.wrapped(t))
    tangents = tangents / norm(tangents)[:, None]
    step = norm(np.diff(points, axis=0))
    turn = 2 * np.arcsin(np.clip(norm(np.diff(tangents, axis=0)) / 2, 0.0, 1.0))
    # a chord of length h has the sagitta curvature h^2 / 8
    weight = np.maximum(np.sqrt(turn * step / (8 * tolerance)), turn / CURVE_TURN)
    total = np.concatenate([[0.0], np.cumsum(weight)])
    least = 3 if piece.closed else 1
    count = max(least, int(np.ceil(total[-1] * (1 - NO_MORE))))
    while True:
        found = np.interp(np.linspace(0, total[-1], count + 1), total, t)
        found[[0, -1]] = piece.start, piece.end
        if count >= DENSE or _sagitta(piece, found) <= tolerance * 1.0001:
            return found
        count = max(count + 1, int(1.05 * count))


def straight(piece: Piece) -> bool:
    """Whether more samples change nothing."""
    return piece.curve.kind == "line"


def _sagitta(piece: Piece, t: Array) -> float:
    """The largest distance of a segment's middle, by parameter, from the segment."""
    middle = np.array([piece.between(a, b) for a, b in pairwise(t.tolist())])
    points, bulge = piece.point(t), piece.point(middle)
    chord = np.diff(points, axis=0)
    length = norm(chord)
    along = chord / np.where(length > 0, length, 1.0)[:, None]
    away = bulge - points[:-1]
    return float(norm(away - (away * along).sum(axis=1)[:, None] * along).max())
