"""Where a smooth function of two variables vanishes: chains of points from a grid's cells."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from decomp.vectors import Array, Bools, Ints

ROUNDS = 80
AT_REST = 1e-16
"""Parts of an edge of a cell that are shorter are points."""


@dataclass(frozen=True, eq=False)
class Contour:
    """Points at which a function vanishes, on the sides of a grid's cells.

    Args:
        spots: (k, 2).
        links: (m, 2) pairs of points between which the contour runs through one cell.
    """

    spots: Array
    links: Ints


def contour(values: Array, at: tuple[Array, Array], miss: Callable[[Array], Array]) -> Contour:
    """Find the zeros of a function on the sides of a grid.

    Cells that two contours pass are left without links.

    Args:
        values: (n, m) at the nodes; not finite where it is not known.
        at: coordinates (n,) and (m,) of the nodes.
        miss: the function of spots (k, 2).
    """
    grid = np.stack(np.meshgrid(*at, indexing="ij"), axis=-1)
    number = np.full((2, *values.shape), -1, dtype=np.int64)
    low, high, count = [], [], 0
    for axis in (0, 1):
        one = (slice(None, -1), slice(None)) if axis == 0 else (slice(None), slice(None, -1))
        two = (slice(1, None), slice(None)) if axis == 0 else (slice(None), slice(1, None))
        changes = (values[one] > 0) != (values[two] > 0)
        changes &= np.isfinite(values[one]) & np.isfinite(values[two])
        low.append(grid[one][changes])
        high.append(grid[two][changes])
        numbered = np.full(changes.shape, -1, dtype=np.int64)
        numbered[changes] = count + np.arange(int(changes.sum()))
        number[(axis, *one)] = numbered
        count += int(changes.sum())
    spots = _zeros(np.concatenate(low), np.concatenate(high), miss)
    sides = np.stack(
        [number[0, :-1, :-1], number[0, :-1, 1:], number[1, :-1, :-1], number[1, 1:, :-1]], axis=-1
    ).reshape(-1, 4)
    passed = np.sort(sides[(sides >= 0).sum(axis=1) == 2], axis=1)
    return Contour(spots, passed[:, 2:])


def _zeros(low: Array, high: Array, miss: Callable[[Array], Array]) -> Array:
    """Zeros between spots at which a function has different signs: regula falsi (Illinois)."""
    if not len(low):
        return low
    a, b = np.zeros(len(low)), np.ones(len(low))

    def at(share: Array) -> Array:
        return miss(low + share[:, None] * (high - low))

    fa, fb = at(a), at(b)
    best = np.where(np.abs(fa) <= np.abs(fb), a, b)
    least = np.minimum(np.abs(fa), np.abs(fb))
    side = np.zeros(len(low))
    for _ in range(ROUNDS):
        flat = fa == fb
        c = np.where(flat, (a + b) / 2, (a * fb - b * fa) / np.where(flat, 1.0, fb - fa))
        c = np.clip(c, np.minimum(a, b), np.maximum(a, b))
        f = at(c)
        better = np.abs(f) < least
        best, least = np.where(better, c, best), np.where(better, np.abs(f), least)
        as_b: Bools = (f > 0) == (fb > 0)
        fa = np.where(as_b & (side == 1), fa / 2, fa)
        fb = np.where(~as_b & (side == -1), fb / 2, fb)
        a, fa = np.where(as_b, a, c), np.where(as_b, fa, f)
        b, fb = np.where(as_b, c, b), np.where(as_b, f, fb)
        side = np.where(as_b, 1, -1)
        if (least == 0).all() or float(np.abs(b - a).max()) <= AT_REST:
            break
    return np.asarray(low + best[:, None] * (high - low))


def chains(links: Ints, count: int) -> list[tuple[list[int], bool]]:
    """Chains of points that links (m, 2) join, each point in at most two, and whether it closes.

    Points without links are chains of one.
    """
    near: list[list[int]] = [[] for _ in range(count)]
    for a, b in links.tolist():
        near[a].append(b)
        near[b].append(a)
    left = set(range(count))
    found = []
    for start in sorted(left, key=lambda k: (len(near[k]) > 1, k)):
        if start not in left:
            continue
        chain = [start]
        left.remove(start)
        while ahead := [k for k in near[chain[-1]] if k in left]:
            chain.append(ahead[0])
            left.remove(ahead[0])
        found.append((chain, len(chain) > 2 and start in near[chain[-1]]))
    return found
