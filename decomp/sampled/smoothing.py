"""Walls without folds: vertices are moved to the middle of their neighbours, and placed again.

What lies on a line moves along it; the boundary's edges and the ends of lines stay.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from decomp.complex.many_elements import Elements
from decomp.complex.model import SIDES, Complex, LineKind
from decomp.complex.refining.errors_of import triangle_errors
from decomp.complex.refining.lenient import LenientElements
from decomp.vectors import Array, Bools, Ints

LINE_ROUNDS = 12
"""Rounds in which only what is on lines moves, so that it comes to stand in order."""
MOST_ROUNDS, LEAST_ROUNDS = 6, 3
"""Rounds at most, and at least."""
RINGS = 2
"""Only so far around some triangles vertices are moved."""


def unfolded(
    given: Complex, first: int, pinned: Ints, near: Ints | None = None
) -> tuple[Complex, Ints]:
    """Smooth a complex until no triangle is folded, or for so many rounds.

    Returns:
        the complex, and triangles (k, 3) of walls that are still folded.

    Args:
        given: with all its vertices in their places.
        first: the number of the first patch that is a wall's.
        pinned: points that stay where they are.
        near: only these points, and what is around them, are moved; if not given, all.
    """
    elements = LenientElements(given)
    triangles = np.concatenate([patch.triangles for patch in given.patches])
    patch = np.repeat(np.arange(len(given.patches)), [len(p.triangles) for p in given.patches])
    element, pairs = _movable(given, elements, triangles, patch)
    element[pinned] = -1
    if near is not None:
        some = np.zeros(len(given.points), dtype=np.bool_)
        some[near] = True
        for _ in range(RINGS):
            some[triangles[some[triangles].any(axis=1)]] = True
        element[~some] = -1
    points = np.array(given.points)
    numbers = elements.of_patch[patch]
    for _ in range(LINE_ROUNDS):
        _move(elements, element, np.flatnonzero(element >= elements.first_curve), points, pairs)
    on_walls = patch >= first
    for round_ in range(MOST_ROUNDS):
        bad = on_walls & _folded(elements, numbers, points[triangles])
        if round_ >= (LEAST_ROUNDS if near is None else 1) and not bad.any():
            break
        _move(elements, element, np.flatnonzero(element >= 0), points, pairs)
    bad = on_walls & _folded(elements, numbers, points[triangles])
    return replace(given, points=points), triangles[bad]


def _move(
    elements: LenientElements, element: Ints, moving: Ints, points: Array, pairs: Ints
) -> None:
    """Move some points to the middle of their neighbours, on their elements, where they can be."""
    if len(moving):
        placed, good = elements.attempt(element[moving], _middles(points, pairs)[moving])
        points[moving[good]] = placed[good]


def _folded(elements: LenientElements, numbers: Ints, corners: Array) -> Bools:
    """Whether triangles (k, 3, 3) oppose their surfaces' normals, as the certificate asks."""
    return np.asarray(triangle_errors(elements, numbers, corners)[1] <= 0)


def _movable(given: Complex, elements: Elements, triangles: Ints, patch: Ints) -> tuple[Ints, Ints]:
    """The element (n,) that each point moves on, -1 for none, and pairs (k, 2): who moves where."""
    element: Ints = np.full(len(given.points), -1, dtype=np.int64)
    element[triangles] = elements.of_patch[patch][:, None]
    on_line = np.zeros(len(given.points), dtype=np.int64)
    along = []
    for number, line in enumerate(given.lines):
        closed = bool(line.vertices[0] == line.vertices[-1])
        on_line[line.vertices[:-1] if closed else line.vertices] += 1
        element[line.vertices] = -1 if line.kind is LineKind.EDGE else elements.of_line[number]
        along.append(np.stack([line.vertices[:-1], line.vertices[1:]], axis=1))
        if not closed:
            on_line[line.vertices[[0, -1]]] = 2
    element[on_line > 1] = -1
    segments = np.concatenate([np.empty((0, 2), dtype=np.int64), *along])
    sides = np.unique(np.sort(triangles[:, SIDES].reshape(-1, 2), axis=1), axis=0)
    inside = np.concatenate([sides, sides[:, ::-1]])
    inside = inside[on_line[inside[:, 0]] == 0]
    return element, np.concatenate([inside, segments, segments[:, ::-1]])


def _middles(points: Array, pairs: Ints) -> Array:
    """The mean (n, 3) of each point's neighbours."""
    total = np.zeros_like(points)
    np.add.at(total, pairs[:, 0], points[pairs[:, 1]])
    many = np.bincount(pairs[:, 0], minlength=len(points))
    return np.asarray(total / np.maximum(many, 1)[:, None])
