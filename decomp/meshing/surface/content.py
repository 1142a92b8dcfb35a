"""Volumes inside surfaces of a complex, with the bending of its triangles reckoned in."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from decomp.complex.many_elements import Elements
from decomp.complex.model import Complex
from decomp.meshes.faces import TRIANGLE_EDGES
from decomp.vectors import Array, Ints, cross, dot

# a rule of degree 4 on the triangle (Strang and Fix 1973): barycentric orbits and weights
_A, _B = 0.445948490915965, 0.091576213509771
RULE = np.array(
    [
        [1 - 2 * _A, _A, _A],
        [_A, 1 - 2 * _A, _A],
        [_A, _A, 1 - 2 * _A],
        [1 - 2 * _B, _B, _B],
        [_B, 1 - 2 * _B, _B],
        [_B, _B, 1 - 2 * _B],
    ]
)
WEIGHTS = np.repeat([0.223381589678011, 0.109951743655322], 3)


def contents(mesh: Complex, surfaces: Sequence[Sequence[tuple[int, int]]]) -> Array:
    """Volumes inside closed surfaces, each given by its sides (patch, sign).

    Triangles count as quadratic ones through exact points beside the middles of their edges.
    """
    flux = _fluxes(mesh, mesh.points.mean(axis=0))
    return np.array([sum(sign * flux[patch] for patch, sign in sides) for sides in surfaces])


def midpoints(mesh: Complex) -> tuple[dict[tuple[int, int], int], Array]:
    """An exact point for each edge: on a line's curve, else on the patch's surface.

    Returns:
        the number of each edge, lower vertex first, and the points.
    """
    elements = Elements(mesh)
    ends: list[Ints] = []
    numbers: list[Ints] = []
    for line, number in zip(mesh.lines, elements.of_line, strict=True):
        ends.append(np.stack([line.vertices[:-1], line.vertices[1:]], axis=1))
        numbers.append(np.full(len(line.vertices) - 1, number))
    for patch, number in zip(mesh.patches, elements.of_patch, strict=True):
        ends.append(patch.triangles[:, TRIANGLE_EDGES].reshape(-1, 2))
        numbers.append(np.full(3 * len(patch.triangles), number))
    every = np.sort(np.concatenate(ends), axis=1)
    edges, first = np.unique(every, axis=0, return_index=True)
    middles = mesh.points[edges].mean(axis=1)
    placed = elements.place(np.concatenate(numbers)[first], middles)
    return {(int(a), int(b)): k for k, (a, b) in enumerate(edges)}, placed


def _fluxes(mesh: Complex, origin: Array) -> Array:
    """A third of the flux of the position through each patch."""
    number, placed = midpoints(mesh)
    points = mesh.points - origin
    placed = placed - origin
    found = np.zeros(len(mesh.patches))
    for k, patch in enumerate(mesh.patches):
        edges = np.sort(patch.triangles[:, TRIANGLE_EDGES], axis=2).reshape(-1, 2)
        rows = np.array([number[a, b] for a, b in edges.tolist()], dtype=np.int64)
        corners, middles = points[patch.triangles], placed[rows].reshape(-1, 3, 3)
        found[k] = _through(corners, middles)
    return found


def _through(corners: Array, middles: Array) -> float:
    """A third of the flux through quadratic triangles (m, 3, 3) with edge nodes (m, 3, 3)."""
    nodes = np.concatenate([corners, middles], axis=1)
    total = 0.0
    for (a, b, c), weight in zip(RULE, WEIGHTS, strict=True):
        value = np.array(
            [a * (2 * a - 1), b * (2 * b - 1), c * (2 * c - 1), 4 * a * b, 4 * b * c, 4 * c * a]
        )
        # derivatives along b and c, with a = 1 - b - c
        along_b = np.array([1 - 4 * a, 4 * b - 1, 0, 4 * (a - b), 4 * c, -4 * c])
        along_c = np.array([1 - 4 * a, 0, 4 * c - 1, -4 * b, 4 * b, 4 * (a - c)])
        x, u, v = (np.einsum("k,mkd->md", w, nodes) for w in (value, along_b, along_c))
        total += weight / 2 * float(dot(x, cross(u, v)).sum())
    return total / 3
