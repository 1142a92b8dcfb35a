"""How far a complex is from its exact surfaces and curves, and which triangles are folded.

The chord error of an edge is the distance of points on it from where its element places them; of a
triangle the same at points inside it. Segments of lines are held against their curve and against
the surface of every patch that they border.
"""

from __future__ import annotations

import numpy as np

from decomp.complex.model import Complex
from decomp.complex.refine_elements import Elements
from decomp.vectors import Array, Ints, cross, dot, norm

INSIDE = np.array(
    [
        [1 / 3, 1 / 3, 1 / 3],
        [0.8, 0.1, 0.1],
        [0.1, 0.8, 0.1],
        [0.1, 0.1, 0.8],
        [0.45, 0.45, 0.1],
        [0.1, 0.45, 0.45],
        [0.45, 0.1, 0.45],
    ]
)
"""Barycentric coordinates (7, 3) at which triangles are measured: centre, corners, sides.

Corners themselves are left out: the surface may have no normal there, as a cone at its apex.
"""

UPRIGHT = 4
"""At so many of the first points of `INSIDE` normals are compared."""


def triangle_normals(corners: Array) -> Array:
    """Unit normals (k, 3) of triangles (k, 3, 3); zero where a triangle has no area.

    A triangle counts as having none when its height is below 1e-9 of its longest side.
    """
    sides = np.roll(corners, -1, axis=1) - corners
    double = cross(sides[:, 0], sides[:, 1])
    size = norm(double)
    longest = dot(sides, sides).max(axis=1)
    real = size > 1e-9 * longest
    return np.where(real[:, None], double / np.where(real, size, 1.0)[:, None], 0.0)


def triangle_errors(elements: Elements, numbers: Ints, corners: Array) -> tuple[Array, Array]:
    """Chord errors (k,) of triangles (k, 3, 3), and how upright (k,) they stand.

    The latter is the least inner product of the triangle's normal and the surface's: 1 on a plane,
    negative when folded.
    """
    count = len(corners)
    if count == 0:
        return np.empty(0), np.empty(0)
    flat = np.einsum("sj,kjx->skx", INSIDE, corners)
    points = flat.reshape(-1, 3)
    placed = elements.place(np.tile(numbers, len(INSIDE)), points)
    error = norm(placed - points).reshape(len(INSIDE), count).max(axis=0)
    normals = elements.normal(np.tile(numbers, UPRIGHT), placed[: UPRIGHT * count])
    upright = dot(normals.reshape(UPRIGHT, count, 3), triangle_normals(corners)).min(axis=0)
    return error, upright


def edge_errors(
    elements: Elements, numbers: Ints, ends: Array, limit: float
) -> tuple[Array, Array]:
    """Chord errors (k,) of edges (k, 2, 3), and their midpoints (k, 3) placed.

    An edge whose error at its midpoint exceeds `limit` is not measured elsewhere.
    """
    middle = ends.mean(axis=1)
    placed = elements.place(numbers, middle)
    error = norm(placed - middle)
    good = np.flatnonzero(error <= limit)
    if len(good):
        a, b = ends[good, 0], ends[good, 1]
        points = np.concatenate([0.75 * a + 0.25 * b, 0.25 * a + 0.75 * b])
        quarter = elements.gap(np.tile(numbers[good], 2), points).reshape(2, -1).max(axis=0)
        error[good] = np.maximum(error[good], quarter)
    return error, placed


def chord_error(given: Complex, samples: int = 6) -> float:
    """Largest distance of the complex's triangles and segments from their surfaces and curves.

    Args:
        given: whose vertices are exact.
        samples: in how many parts each side is divided; triangles are measured at all points of
            the lattice that this makes, their sides included.
    """
    elements = Elements(given)
    numbers, points = [np.empty(0, dtype=np.int64)], [np.empty((0, 3))]
    i, j = np.mgrid[: samples + 1, : samples + 1]
    lattice = np.stack([i, j, samples - i - j], axis=-1)[(i + j <= samples) & (i + j > 0)]
    weights = lattice[(lattice < samples).all(axis=1)] / samples
    for number, patch in zip(elements.of_patch, given.patches, strict=True):
        inside = np.einsum("sj,kjx->skx", weights, given.points[patch.triangles])
        points.append(inside.reshape(-1, 3))
        numbers.append(np.full(len(points[-1]), number))
    steps = (np.arange(1, samples) / samples)[:, None, None]
    for number, line in zip(elements.of_line, given.lines, strict=True):
        at = given.points[line.vertices]
        points.append(((1 - steps) * at[:-1] + steps * at[1:]).reshape(-1, 3))
        numbers.append(np.full(len(points[-1]), number))
    return float(elements.gap(np.concatenate(numbers), np.concatenate(points)).max(initial=0.0))


def flipped(given: Complex) -> int:
    """Number of triangles whose normal opposes their surface's, or that have no area."""
    elements = Elements(given)
    numbers = [
        np.full(len(patch.triangles), number)
        for number, patch in zip(elements.of_patch, given.patches, strict=True)
    ]
    corners = [given.points[patch.triangles] for patch in given.patches]
    if not corners:
        return 0
    _, upright = triangle_errors(elements, np.concatenate(numbers), np.concatenate(corners))
    return int((upright <= 0.0).sum())
