"""Choosing changes that do not get in each other's way."""

from __future__ import annotations

import numpy as np

from decomp.vectors import Bools, Ints


def independent(count: int, items: Ints, things: Ints, rank: Ints) -> Bools:
    """Choose items no two of which touch the same thing, those of low rank first.

    Args:
        count: of items.
        items, things: (k,) pairs of an item and a thing that it touches.
        rank: (count,) distinct numbers.

    Returns:
        Which items (count,) are chosen. An item that is not chosen touches a thing of one that is,
        but for a few at the end of long chains.
    """
    chosen = np.zeros(count, dtype=bool)
    if count == 0:
        return chosen
    alive = np.ones(count, dtype=bool)
    size = int(things.max()) + 1
    for _ in range(8):
        use = alive[items]
        items, things = items[use], things[use]
        if len(items) == 0:
            break
        best = np.full(size, np.iinfo(np.int64).max)
        np.minimum.at(best, things, rank[items])
        beaten = np.zeros(count, dtype=bool)
        beaten[items[best[things] != rank[items]]] = True
        won = alive & ~beaten
        chosen |= won
        taken = np.zeros(size, dtype=bool)
        taken[things[won[items]]] = True
        alive[items[taken[things]]] = False
    return chosen


def ranks(*keys: np.ndarray) -> Ints:
    """Distinct ranks by the first key, then the second, and so on, least first."""
    rank = np.empty(len(keys[0]), dtype=np.int64)
    rank[np.lexsort(keys[::-1])] = np.arange(len(keys[0]))
    return rank
