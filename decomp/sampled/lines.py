"""Where patches meet, as lines of one complex."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from decomp.complex.model import SIDES
from decomp.vectors import Ints


@dataclass(frozen=True)
class Chain:
    """A line along which the same patches meet.

    Args:
        vertices: in order; a closed one repeats its first.
        patches: that meet along it, as often as they do, ascending.
        closed: whether it ends where it begins without a node.
    """

    vertices: tuple[int, ...]
    patches: tuple[int, ...]
    closed: bool


def chains(triangles: Ints, patch: Ints, extra: Sequence[tuple[int, int]] = ()) -> list[Chain]:
    """All lines of a complex.

    Args:
        triangles: (m, 3).
        patch: (m,) of each.
        extra: edges, lower vertex first, that are lines though no patches meet there.
    """
    sides = np.sort(triangles[:, SIDES].reshape(-1, 2), axis=1)
    edges, which = np.unique(sides, axis=0, return_inverse=True)
    order = np.lexsort((np.repeat(patch, 3), which.reshape(-1)))
    around = np.split(np.repeat(patch, 3)[order], np.cumsum(np.bincount(which.reshape(-1)))[:-1])
    kinds: dict[tuple[int, int], tuple[int, ...]] = {}
    for edge, own in zip(edges.tolist(), around, strict=True):
        if len(own) != 2 or own[0] != own[1]:
            kinds[edge[0], edge[1]] = tuple(own.tolist())
    for pair in extra:
        kinds.setdefault(pair, ())
    at: dict[int, list[tuple[int, int]]] = {}
    for pair in kinds:
        for vertex in pair:
            at.setdefault(vertex, []).append(pair)
    nodes = {
        vertex
        for vertex, pairs in at.items()
        if len(pairs) != 2 or kinds[pairs[0]] != kinds[pairs[1]]
    }
    left = dict.fromkeys(kinds)
    found = []
    for start in sorted(nodes):
        for pair in at[start]:
            if pair in left:
                found.append(_followed(start, pair, at, kinds, left, nodes))
    while left:
        pair = next(iter(left))
        found.append(_followed(pair[0], pair, at, kinds, left, nodes))
    return found


def _followed(
    start: int,
    pair: tuple[int, int],
    at: dict[int, list[tuple[int, int]]],
    kinds: dict[tuple[int, int], tuple[int, ...]],
    left: dict[tuple[int, int], None],
    nodes: set[int],
) -> Chain:
    """Follow a line to its end."""
    patches, path = kinds[pair], [start]
    while True:
        del left[pair]
        path.append(pair[1] if pair[0] == path[-1] else pair[0])
        if path[-1] in nodes or path[-1] == start:
            return Chain(tuple(path), patches, start not in nodes)
        pair = next(p for p in at[path[-1]] if p != pair)
