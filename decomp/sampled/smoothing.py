"""Walls without folds: vertices are moved to the middle of their neighbours, and placed again.

What lies on a line moves along it; the boundary's edges and the ends of lines stay.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from decomp.complex.errors_of import triangle_normals
from decomp.complex.model import Complex, LineKind
from decomp.complex.refine_elements import Elements
from decomp.errors import GeometryError
from decomp.vectors import Array, Bools, Ints, dot

ALONG = 12
"""Rounds in which only what is on lines moves, so that it comes to stand in order."""
ROUNDS, LEAST = 6, 3
"""Rounds at most, and at least."""
SIDES = np.array([[0, 1], [1, 2], [2, 0]])


def unfolded(given: Complex, first: int, pinned: Ints) -> tuple[Complex, Ints]:
    """Smooth a complex until no triangle is folded, or for so many rounds.

    Returns:
        the complex, and triangles (k, 3) of walls that are still folded.

    Args:
        given: with all its vertices in their places.
        first: the number of the first patch that is a wall's.
        pinned: points that stay where they are.
    """
    elements = Elements(given)
    triangles = np.concatenate([patch.triangles for patch in given.patches])
    patch = np.repeat(np.arange(len(given.patches)), [len(p.triangles) for p in given.patches])
    element, pairs = _movable(given, elements, triangles, patch)
    element[pinned] = -1
    points = np.array(given.points)
    numbers = elements.of_patch[patch]
    for _ in range(ALONG):
        _move(elements, element, np.flatnonzero(element >= elements.first_curve), points, pairs)
    for round_ in range(ROUNDS):
        if round_ >= LEAST and not _folded(elements, numbers, points[triangles]).any():
            break
        _move(elements, element, np.flatnonzero(element >= 0), points, pairs)
    bad = _folded(elements, numbers, points[triangles]) & (patch >= first)
    return replace(given, points=points), triangles[bad]


def _move(elements: Elements, element: Ints, moving: Ints, points: Array, pairs: Ints) -> None:
    """Move some points to the middle of their neighbours, on their elements."""
    if not len(moving):
        return
    wanted = _middles(points, pairs)[moving]
    try:
        points[moving] = elements.place(element[moving], wanted)
    except GeometryError:
        # one that has no place there keeps all others from moving: each for itself
        for row, node in enumerate(moving.tolist()):
            points[node] = _one(elements, int(element[node]), wanted[row], points[node])


def _one(elements: Elements, element: int, wanted: Array, before: Array) -> Array:
    try:
        return np.asarray(elements.place(np.array([element]), wanted[None])[0])
    except GeometryError:
        return before


def _folded(elements: Elements, numbers: Ints, corners: Array) -> Bools:
    """Whether triangles (k, 3, 3) oppose their surfaces' normals at their corners."""
    normals = elements.normal(np.repeat(numbers, 3), corners.reshape(-1, 3)).reshape(-1, 3, 3)
    return np.asarray(dot(normals.mean(axis=1), triangle_normals(corners)) <= 0)


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
