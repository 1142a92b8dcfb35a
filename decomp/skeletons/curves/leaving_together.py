"""Curves that leave a node together are sampled together.

Where two curves have a tangent and more in common at their node, chords between samples at
different distances from it cross. So each gets samples at the other's distances, as far as they
stay together.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations

import numpy as np

from decomp.skeletons.curves.pieces import CurvePiece
from decomp.vectors import Array, Bools, norm

TOGETHER = 0.1
"""Curves are together as long as they are nearer to each other than this part of the distance from
their node."""
AGAIN = 3
"""So often samples are placed: from a chord's point the curve is found at another distance."""
SAME = 1e-3
"""Samples whose distances from the node differ by less than this part of them are at the same."""


def matched(pieces: Sequence[CurvePiece], samples: Sequence[Array]) -> list[Array]:
    """Samples of all pieces, with more of them where pieces leave a node together.

    Args:
        pieces: of a network.
        samples: (n, 3) of each piece in order, its ends included.
    """
    found = [np.array(own) for own in samples]
    at: dict[int, list[tuple[int, int]]] = {}
    for number, piece in enumerate(pieces):
        if piece.ends is not None and piece.ends[0] != piece.ends[1]:
            for end, node in enumerate(piece.ends):
                at.setdefault(node, []).append((number, end))
    for leaving in at.values():
        for (one, end), (other, far_end) in combinations(leaving, 2):
            if one != other:
                _match(pieces, found, (one, end), (other, far_end))
    return found


def _match(
    pieces: Sequence[CurvePiece], found: list[Array], one: tuple[int, int], other: tuple[int, int]
) -> None:
    """Give two pieces samples at each other's distances from the node at which they start."""
    a, b = _outward(found[one[0]], one[1]), _outward(found[other[0]], other[1])
    ra, rb = norm(a - a[0]), norm(b - b[0])
    first = min(ra[1], rb[1])
    if not _near(a, ra, b, rb, np.array([first]))[0]:
        return
    for (number, end), own, radii, wanted in ((one, a, ra, rb), (other, b, rb, ra)):
        inner = wanted[1:-1][_rising(wanted)[1:-1]]
        inner = inner[inner < radii.max()]
        inner = inner[_near(a, ra, b, rb, inner)]
        gaps = np.abs(radii[None] - inner[:, None]).min(axis=1, initial=np.inf)
        new = inner[gaps > SAME * inner]
        if not len(new):
            continue
        dense = _outward(max(pieces[number].points, found[number], key=len), end)
        along = norm(dense - dense[0])
        stop = int(np.argmin(_rising(along))) if not _rising(along).all() else len(along)
        new = new[new < along[stop - 1]]
        if not len(new):
            continue
        asked = new
        for _ in range(AGAIN):
            placed = pieces[number].element.place(_at(dense[:stop], along[:stop], asked))
            reached = norm(placed - dense[0])
            asked = asked + new - reached
        # beside a locus a curve can place points far from where they are wanted
        clear = np.abs(radii[None] - reached[:, None]).min(axis=1) > SAME * reached
        clear &= reached < radii[_rising(radii)][-1]
        placed, reached = placed[clear], reached[clear]
        every = np.concatenate([own, placed])
        place = np.concatenate([_order(radii), _position(radii, reached)])
        order = np.argsort(place, kind="stable")
        whole = every[order]
        found[number] = whole if end == 0 else whole[::-1]


def _outward(points: Array, end: int) -> Array:
    """Points of a piece in order from one of its ends."""
    return points if end == 0 else points[::-1]


def _rising(radii: Array) -> Bools:
    """Up to where distances from the node grow."""
    return np.asarray(np.cumsum(np.append(False, np.diff(radii) <= 0)) == 0)


def _at(points: Array, radii: Array, wanted: Array) -> Array:
    return np.stack([np.interp(wanted, radii, points[:, k]) for k in range(3)], axis=1)


def _near(a: Array, ra: Array, b: Array, rb: Array, radii: Array) -> Bools:
    """Whether two curves are together at distances (k,) from the node."""
    up_a, up_b = _rising(ra), _rising(rb)
    gap = norm(_at(a[up_a], ra[up_a], radii) - _at(b[up_b], rb[up_b], radii))
    within = radii < min(ra[up_a][-1], rb[up_b][-1])
    return np.asarray(within & (gap <= TOGETHER * radii))


def _order(radii: Array) -> Array:
    return np.arange(len(radii), dtype=np.float64)


def _position(radii: Array, new: Array) -> Array:
    """Where new samples stand among known ones, as fractions of their numbers."""
    up = _rising(radii)
    return np.interp(new, radii[up], np.flatnonzero(up).astype(np.float64))
