"""Which segments of a plane, a periodic strip or a flat torus cross or touch each other."""

from __future__ import annotations

from itertools import product

import numpy as np

from decomp.kernels.compiled import inner_kernel, kernel
from decomp.vectors import Array, Bools, Ints

Period = tuple[float | None, float | None]
"""Periods of the two coordinates of a domain, None where there is none."""

PLANE: Period = (None, None)
AREA_ROUNDING = 8 * np.finfo(np.float64).eps
"""Twice a triangle's area counts as zero below this multiple of its terms."""


def crossings(points: Array, segments: Ints, period: Period = PLANE) -> Ints:
    """Find the pairs of segments that have a point in common other than a common end.

    Args:
        points: (n, 2).
        segments: (k, 2) indices of points. Across a period they take the shorter way round.
        period: of the first and second coordinate, None where there is none.

    Returns:
        (m, 2) indices of segments, the lower first. Segments that run into each other from a
        common end count, two with the same two ends do not.
    """
    points = np.asarray(points, dtype=np.float64).reshape(-1, 2)
    segments = np.asarray(segments, dtype=np.int64).reshape(-1, 2)
    k = len(segments)
    if not k:
        return np.empty((0, 2), dtype=np.int64)
    base = np.array([p or 0.0 for p in period])
    cyclic = base > 0
    safe = np.where(cyclic, base, 1.0)
    start, end = points[segments[:, 0]], points[segments[:, 1]]
    home = np.where(cyclic, np.floor(start / safe), 0.0)
    turns = np.where(cyclic, -np.round((end - start) / safe), 0.0)

    # the number of the period that each end lies in tells whether ends are common
    shifts = np.array(list(product(*((-1, 0, 1) if c else (0,) for c in cyclic))), dtype=float)
    cells = np.stack([shifts[:, None] - home, shifts[:, None] - home + turns], axis=2)
    ends = (points[segments] + cells * base).reshape(-1, 4)
    names = np.concatenate(
        [np.broadcast_to(segments[None, :, :, None], (*cells.shape[:3], 1)), cells], axis=3
    )
    vertex = np.unique(names.reshape(-1, 3), axis=0, return_inverse=True)[1].reshape(-1, 2)
    owner = np.tile(np.arange(k), len(shifts))
    middle = np.repeat(~shifts.any(axis=1), k)
    order = np.argsort(np.minimum(ends[:, 0], ends[:, 2]), kind="stable")
    found = np.empty((16 + 4 * k, 2), dtype=np.int64)
    sorted_ends = np.ascontiguousarray(ends[order])
    while True:
        count = _sweep(sorted_ends, vertex[order], owner[order], middle[order], found)
        if count <= len(found):
            break
        found = np.empty((count, 2), dtype=np.int64)
    return np.unique(np.sort(found[:count], axis=1), axis=0)


@kernel
def _sweep(ends: Array, vertex: Ints, owner: Ints, middle: Bools, found: Ints) -> int:
    """Fill `found` with pairs that meet, as far as it reaches; return how many there are."""
    count = 0
    for i in range(len(ends)):
        right = max(ends[i, 0], ends[i, 2])
        low, high = min(ends[i, 1], ends[i, 3]), max(ends[i, 1], ends[i, 3])
        for j in range(i + 1, len(ends)):
            if min(ends[j, 0], ends[j, 2]) > right:
                break
            if owner[i] == owner[j] or not (middle[i] or middle[j]):
                continue
            if min(ends[j, 1], ends[j, 3]) > high or max(ends[j, 1], ends[j, 3]) < low:
                continue
            if _meet(ends[i], ends[j], vertex[i], vertex[j]):
                if count < len(found):
                    found[count, 0], found[count, 1] = owner[i], owner[j]
                count += 1
    return count


@inner_kernel
def _side(ax: float, ay: float, bx: float, by: float, px: float, py: float) -> int:
    """+1, 0 or -1: p lies left of the way from a to b, on it to rounding, or right of it."""
    left, right = (bx - ax) * (py - ay), (by - ay) * (px - ax)
    # coordinates may have been rounded when they were laid side by side
    size = max(abs(ax), abs(ay), abs(bx), abs(by), abs(px), abs(py))
    reach = abs(bx - ax) + abs(by - ay) + abs(px - ax) + abs(py - ay)
    if abs(left - right) <= AREA_ROUNDING * (abs(left) + abs(right) + size * reach):
        return 0
    return 1 if left > right else -1


@inner_kernel
def _within(ax: float, ay: float, bx: float, by: float, px: float, py: float) -> bool:
    """Whether p, on the line through a and b, lies between them."""
    return (px - ax) * (px - bx) + (py - ay) * (py - by) < 0


@inner_kernel
def _meet(a: Array, b: Array, va: Ints, vb: Ints) -> bool:
    """Whether two segments have a point in common other than a common end."""
    common = 0
    for i in range(2):
        for j in range(2):
            if va[i] == vb[j]:
                common += 1
                # the far ends seen from the common one
                px, py = a[2 * i], a[2 * i + 1]
                qx, qy = a[2 - 2 * i], a[3 - 2 * i]
                rx, ry = b[2 - 2 * j], b[3 - 2 * j]
    if common == 2:
        return False
    if common == 1:
        along = (qx - px) * (rx - px) + (qy - py) * (ry - py)
        return along > 0 and _side(px, py, qx, qy, rx, ry) == 0
    s0 = _side(a[0], a[1], a[2], a[3], b[0], b[1])
    s1 = _side(a[0], a[1], a[2], a[3], b[2], b[3])
    t0 = _side(b[0], b[1], b[2], b[3], a[0], a[1])
    t1 = _side(b[0], b[1], b[2], b[3], a[2], a[3])
    if s0 * s1 < 0 and t0 * t1 < 0:
        return True
    if s0 == 0 and _within(a[0], a[1], a[2], a[3], b[0], b[1]):
        return True
    if s1 == 0 and _within(a[0], a[1], a[2], a[3], b[2], b[3]):
        return True
    if t0 == 0 and _within(b[0], b[1], b[2], b[3], a[0], a[1]):
        return True
    return t1 == 0 and _within(b[0], b[1], b[2], b[3], a[2], a[3])
