"""The legs of an edge that can be nearest to a point, where samples do not tell which of them is.

An edge that winds about a point, as one on a cylinder about its axis, is about as near on several
legs: its nearest sample can be on another one than its nearest place.
"""

from __future__ import annotations

import numpy as np

from decomp.vectors import Array, Ints, norm

BLOCK = 4096


def legs(samples: Array, closed: bool, points: Array) -> tuple[Ints, Ints]:
    """Samples that are nearer than their neighbours, on all legs that can hold the nearest place.

    Points whose nearest place is on one leg for certain are left out, and so are an edge's ends.

    Args:
        samples: (n, 3) of an edge, in order; a closed one's first may come again as its last.
        closed: whether the edge is.
        points: (k, 3).

    Returns:
        the point (m,) of each, ascending, and its number (m,) among the samples.
    """
    if closed and (samples[0] == samples[-1]).all():
        samples = samples[:-1]
    none = np.empty(0, dtype=np.int64)
    if len(samples) < 3:
        return none, none
    # between two samples no place is nearer than the nearer one by more than half their way
    around = np.concatenate([samples[-1:], samples, samples[:1]])
    ways = norm(np.diff(around, axis=0))
    if not closed:
        ways[0] = ways[-1] = 0.0
    reach = np.maximum(ways[:-1], ways[1:]) / 2
    rows, found = [none], [none]
    for start in range(0, len(points), BLOCK):
        away = norm(points[start : start + BLOCK, None] - samples)
        before, after = np.roll(away, 1, axis=1), np.roll(away, -1, axis=1)
        bottoms = (away <= before) & (away < after)
        if not closed:
            bottoms[:, [0, -1]] = False
        bottoms &= away - reach <= away.min(axis=1)[:, None]
        bottoms &= bottoms.sum(axis=1)[:, None] > 1
        row, sample = np.nonzero(bottoms)
        rows.append(row + start)
        found.append(sample)
    return np.concatenate(rows), np.concatenate(found)
