"""Carriers that coincide are made one before anything is computed.

They coincide within the tolerance, and within what the digits of their file's numbers leave open: a
plane that was turned by a matrix of six digits may lie a little off the one that it is meant to
be. Between carriers that were moved together, or by exact numbers, only the tolerance counts.
"""

from __future__ import annotations

from bisect import bisect_left, insort
from collections.abc import Sequence

import numpy as np

from decomp.carriers import Carrier
from decomp.similarity import Similarity
from decomp.tolerance import TOLERANCE


def merged(
    carriers: Sequence[Carrier], scale: float, steps: Sequence[tuple[Similarity, ...]]
) -> tuple[list[int], list[int], list[Carrier]]:
    """Find coincident carriers.

    Args:
        carriers: n of them.
        scale: the model's diagonal.
        steps: the inexact moves of each, the outermost first.

    Returns:
        For each carrier the index of the surface that represents it and whether their insides
        agree (+1) or are opposite (-1); and the representatives, the least doubtful of each.
    """
    representatives: list[Carrier] = []
    index, sign = [0] * len(carriers), [0] * len(carriers)
    doubts = np.array([doubt(chain, scale) for chain in steps])
    chains: list[tuple[Similarity, ...]] = []
    # Coincident carriers have nearly equal features, so nearly equal keys: one fixed projection.
    sorted_keys: dict[type[Carrier], list[tuple[float, int]]] = {}
    slack = 100 * (TOLERANCE + 2 * float(doubts.max(initial=0.0)) / scale)
    # what is certain comes first, and keeps its place
    for at in np.argsort(doubts, kind="stable"):
        carrier = carriers[at]
        features = carrier.features(scale)
        key = float(features @ np.sqrt(np.arange(2, 2 + len(features))))
        known = sorted_keys.setdefault(type(carrier), [])
        start = bisect_left(known, (key - slack * (1 + abs(key)), -1))
        match, orientation = -1, 0
        for other_key, candidate in known[start:]:
            if other_key > key + slack * (1 + abs(key)):
                break
            near = TOLERANCE * scale + _doubt_between(steps[at], chains[candidate], scale)
            orientation = representatives[candidate].coincides(carrier, near, scale)
            if orientation:
                match = candidate
                break
        if match < 0:
            match, orientation = len(representatives), 1
            representatives.append(carrier)
            chains.append(steps[at])
            insort(known, (key, match))
        index[at], sign[at] = match, orientation
    return index, sign, representatives


def doubt(steps: Sequence[Similarity], scale: float) -> float:
    """How far off moves may put what they move."""
    return sum(step.doubt * scale + step.shift for step in steps)


def _doubt_between(
    one: tuple[Similarity, ...], other: tuple[Similarity, ...], scale: float
) -> float:
    """How far off each other: outer moves that both have put both off alike."""
    if not one and not other:
        return 0.0
    common = 0
    while common < min(len(one), len(other)) and _same(one[common], other[common]):
        common += 1
    return doubt(one[common:], scale) + doubt(other[common:], scale)


def _same(one: Similarity, other: Similarity) -> bool:
    return one is other or (
        one.scale == other.scale
        and np.array_equal(one.rotation, other.rotation)
        and np.array_equal(one.offset, other.offset)
    )
