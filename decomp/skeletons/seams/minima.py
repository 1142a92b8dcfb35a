"""Where functions that are never negative come down to zero, for many intervals together.

Each interval is cut into parts and narrowed to the two beside the least value, again and again. One
whose function hardly grows from its least value to the next ones has no zero and is given up: from
a zero it would grow at least like a root, that is by more than half the value nearest to it.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from decomp.vectors import Array, Ints

PARTS = 16
GROWTH = 0.5


def least_values(
    function: Callable[[Ints, Array], Array], low: Array, high: Array, part: float
) -> tuple[Array, Array]:
    """The least value in each interval, exactly only where it is zero.

    Args:
        function: its values (m,), of the numbers (m,) of intervals and places (m,) in them.
        low, high: (k,) the intervals' ends.
        part: of an interval, to which places of zeros are told.

    Returns:
        the places (k,), and the values there (k,).
    """
    low, high = np.array(low, dtype=np.float64), np.array(high, dtype=np.float64)
    at, value = (low + high) / 2, np.full(len(low), np.inf)
    enough = part * (high - low)
    rows: Ints = np.arange(len(low))
    first = True
    while len(rows):
        shares = np.linspace(0.0, 1.0, PARTS + 1)
        places = low[rows, None] + shares * (high - low)[rows, None]
        found = function(np.repeat(rows, PARTS + 1), places.ravel()).reshape(places.shape)
        one = np.arange(len(rows))
        best = found.argmin(axis=1)
        before, after = np.maximum(best - 1, 0), np.minimum(best + 1, PARTS)
        at[rows], value[rows] = places[one, best], found[one, best]
        low[rows], high[rows] = places[one, before], places[one, after]
        next_ones = np.maximum(found[one, before], found[one, after])
        hopeless = (next_ones < (1 + GROWTH) * value[rows]) & (not first)
        rows = rows[~hopeless & ((high - low)[rows] > enough[rows])]
        first = False
    return at, value
