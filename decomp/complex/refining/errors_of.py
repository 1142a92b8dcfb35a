"""How far a complex is from its exact surfaces and curves, and which triangles are folded.

The chord error of an edge is the distance of points on it from where its element places them; of a
triangle the same at points inside it. Segments of lines are held against their curve and against
the surface of every patch that they border.
"""

from __future__ import annotations

import numpy as np

from decomp.complex.many_elements import Elements
from decomp.complex.model import Complex
from decomp.vectors import Array, Ints, cross, dot, norm

POINTS_INSIDE = np.array(
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

_FIT = np.linalg.pinv(np.roll(POINTS_INSIDE, -1, axis=1) * np.roll(POINTS_INSIDE, 1, axis=1))
NO_AREA = 1e-9
"""A triangle has no normal if its double area is below this part of its longest side squared."""


def _along() -> Array:
    """Displacements at points of an edge (s, 3) from those at 1/4, 3/4 and 1/2.

    They are polynomials of degree 4 that vanish at the ends.
    """
    t, at = np.linspace(0.125, 0.875, 13), np.array([0.25, 0.75, 0.5])
    basis, known = (np.stack([x * (1 - x) * x**k for k in range(3)], axis=1) for x in (t, at))
    return np.asarray(basis @ np.linalg.inv(known))


_ALONG = _along()

NORMALS_COMPARED = 4
"""At so many of the first points of `POINTS_INSIDE` normals are compared."""


def triangle_normals(corners: Array) -> Array:
    """Unit normals (k, 3) of triangles (k, 3, 3); zero where a triangle has no area.

    A triangle counts as having none when its height is below 1e-9 of its longest side.
    """
    sides = np.roll(corners, -1, axis=1) - corners
    double = cross(sides[:, 0], sides[:, 1])
    size = norm(double)
    longest = dot(sides, sides).max(axis=1)
    real = size > NO_AREA * longest
    return np.where(real[:, None], double / np.where(real, size, 1.0)[:, None], 0.0)


def triangle_errors(elements: Elements, numbers: Ints, corners: Array) -> tuple[Array, Array]:
    """Chord errors (k,) of triangles (k, 3, 3), and how upright (k,) they stand.

    The latter is the least inner product of the triangle's normal and the surface's: 1 on a plane,
    negative when folded.
    """
    count = len(corners)
    if count == 0:
        return np.empty(0), np.empty(0)
    flat = np.einsum("sj,kjx->skx", POINTS_INSIDE, corners)
    points = flat.reshape(-1, 3)
    placed = elements.place(np.tile(numbers, len(POINTS_INSIDE)), points)
    away = (placed - points).reshape(len(POINTS_INSIDE), count, 3)
    own = triangle_normals(corners)
    error = np.maximum(norm(away).max(axis=0), _greatest(dot(away, own)))
    normals = elements.normal(
        np.tile(numbers, NORMALS_COMPARED), placed[: NORMALS_COMPARED * count]
    )
    upright = dot(normals.reshape(NORMALS_COMPARED, count, 3), own).min(axis=0)
    return error, upright


def _greatest(heights: Array) -> Array:
    """The greatest height (k,) inside triangles over which a surface has given heights (7, k).

    The heights at `POINTS_INSIDE` are fitted by a sum of q_ij b_i b_j in barycentric coordinates
    b, which vanishes at the corners. It is stationary where b_i is proportional to
    q_jk (q_ij + q_ik - q_jk); with squared sides for q, that is the circumcentre. As the fit is
    not exact, what exceeds the greatest height on the sides is taken a tenth higher.
    """
    p, q, r = _FIT @ heights
    b = np.stack([p * (q + r - p), q * (r + p - q), r * (p + q - r)])
    total = b.sum(axis=0)
    inside = (b * np.sign(total) > 0).all(axis=0)
    b = b / np.where(inside, total, 1.0)
    value = np.abs(p * b[1] * b[2] + q * b[2] * b[0] + r * b[0] * b[1])
    on_sides = np.maximum(np.maximum(np.abs(p), np.abs(q)), np.abs(r)) / 4
    return np.asarray(np.where(inside, value + 0.1 * np.maximum(value - on_sides, 0.0), 0.0))


def edge_errors(
    elements: Elements, numbers: Ints, ends: Array, limit: float | Array
) -> tuple[Array, Array]:
    """Chord errors (k,) of edges (k, 2, 3), and their midpoints (k, 3) placed.

    An edge whose error at its midpoint exceeds its `limit` is not measured elsewhere.
    """
    middle = ends.mean(axis=1)
    placed = elements.place(numbers, middle)
    error = norm(placed - middle)
    good = np.flatnonzero(error <= limit)
    if len(good):
        a, b = ends[good, 0], ends[good, 1]
        points = np.concatenate([0.75 * a + 0.25 * b, 0.25 * a + 0.75 * b])
        away = elements.place(np.tile(numbers[good], 2), points) - points
        away = np.stack([*away.reshape(2, -1, 3), placed[good] - middle[good]])
        error[good] = norm(np.einsum("st,tkx->skx", _ALONG, away)).max(axis=0)
    return error, placed


def thorough_edge_errors(elements: Elements, numbers: Ints, ends: Array) -> Array:
    """Chord errors (k,) of edges (k, 2, 3) at eleven points."""
    t = (np.arange(1, 12) / 12)[:, None, None]
    points = ((1 - t) * ends[:, 0] + t * ends[:, 1]).reshape(-1, 3)
    return np.asarray(elements.gap(np.tile(numbers, 11), points).reshape(11, -1).max(axis=0))


def thorough_errors(
    elements: Elements, numbers: Ints, corners: Array, samples: int = 6, sides: bool = False
) -> Array:
    """Chord errors (k,) of triangles (k, 3, 3) at the points of a lattice inside.

    Args:
        elements: of the complex.
        numbers: (k,) the triangles' elements.
        corners: of the triangles.
        samples: in how many parts the lattice divides each side.
        sides: whether to take points on the sides too.
    """
    i, j = np.mgrid[: samples + 1, : samples + 1]
    lattice = np.stack([i, j, samples - i - j], axis=-1)[i + j <= samples]
    inside = (lattice < samples).all(axis=1) if sides else (lattice > 0).all(axis=1)
    weights = lattice[inside] / samples
    points = np.einsum("sj,kjx->skx", weights, corners).reshape(-1, 3)
    gap = elements.gap(np.tile(numbers, len(weights)), points)
    return np.asarray(gap.reshape(len(weights), -1).max(axis=0, initial=0.0))


def chord_error(given: Complex, samples: int = 6) -> float:
    """Largest distance of the complex's triangles and segments from their surfaces and curves.

    Args:
        given: whose vertices are exact.
        samples: in how many parts each side is divided; triangles are measured at all points of
            the lattice that this makes, their sides included.
    """
    elements = Elements(given)
    numbers, corners = _all_triangles(given, elements)
    inside = float(thorough_errors(elements, numbers, corners, samples, True).max(initial=0.0))
    steps = (np.arange(1, samples) / samples)[:, None, None]
    on_lines, curves = [np.empty((0, 3))], [np.empty(0, dtype=np.int64)]
    for number, line in zip(elements.of_line, given.lines, strict=True):
        at = given.points[line.vertices]
        on_lines.append(((1 - steps) * at[:-1] + steps * at[1:]).reshape(-1, 3))
        curves.append(np.full(len(on_lines[-1]), number))
    gaps = elements.gap(np.concatenate(curves), np.concatenate(on_lines))
    return max(inside, float(gaps.max(initial=0.0)))


def flipped(given: Complex) -> int:
    """Number of triangles whose normal opposes their surface's, or that have no area."""
    elements = Elements(given)
    _, upright = triangle_errors(elements, *_all_triangles(given, elements))
    return int((upright <= 0.0).sum())


def _all_triangles(given: Complex, elements: Elements) -> tuple[Ints, Array]:
    """The elements (m,) and corners (m, 3, 3) of all triangles."""
    numbers = np.repeat(elements.of_patch, [len(patch.triangles) for patch in given.patches])
    triangles = [np.empty((0, 3), dtype=np.int64), *(p.triangles for p in given.patches)]
    return numbers, given.points[np.concatenate(triangles)]
