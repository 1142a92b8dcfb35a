"""Refining a complex until its chord error is within tolerance, with few triangles.

1. Segments of lines are split at the exact middle until each is close to its curve; after each
   batch edges are flipped.
2. Edges inside patches, the worst first, are split likewise.
3. Patches that touch along chords are parted.
4. Vertices inside patches are removed where that leaves the error within tolerance.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Final, TypeAlias

import numpy as np

from decomp.complex.flips import flip
from decomp.complex.model import Complex
from decomp.complex.refine_mesh import Mesh
from decomp.complex.refine_split import split_inside, split_lines, split_twins
from decomp.errors import GeometryError
from decomp.vectors import Ints, place

Progress: TypeAlias = Callable[[int], None]

MARGIN: Final = 0.95
"""Errors are kept this much below the tolerance, as they are measured at a few points only."""

ROUNDS: Final = 400


def refine(given: Complex, tolerance: float, progress: Progress | None = None) -> Complex:
    """A conforming complex whose chord error is at most `tolerance`, with few triangles.

    Args:
        given: conforming, with exact vertices; it may be coarse.
        tolerance: largest distance of triangles and segments from their surfaces and curves.
        progress: told the number of triangles after each batch of changes.

    Raises:
        GeometryError: the complex is not valid, or a surface or curve cannot be followed; the
            message says where.
    """
    return refined(given, tolerance, progress)[0]


def refined(
    given: Complex, tolerance: float, progress: Progress | None = None
) -> tuple[Complex, Ints]:
    """As `refine`, with the new number of each given point.

    It is -1 for a point inside a patch that was removed; the others keep their order. Points on
    lines, and points in no triangle, are never removed.
    """
    mesh = Mesh(given, MARGIN * tolerance)
    _check(mesh)
    for _ in range(ROUNDS):
        flip(mesh)
        if progress is not None:
            progress(len(mesh.triangles))
        if not (split_lines(mesh) or split_inside(mesh) or split_twins(mesh)):
            return mesh.result()
    worst = np.nanargmax(mesh.error)
    centre = mesh.points[mesh.triangles[worst]].mean(axis=0)
    raise GeometryError(f"the tolerance cannot be reached at {place(centre)}")


def _check(mesh: Mesh) -> None:
    """Each triangle needs three vertices, each segment two, each closed line three."""
    a, b, c = mesh.triangles.T
    bad = np.flatnonzero((a == b) | (b == c) | (c == a))
    if len(bad):
        at = mesh.points[mesh.triangles[bad[0]]].mean(axis=0)
        raise GeometryError(f"a triangle has the same vertex twice at {place(at)}")
    at, curve = mesh.segments()
    ends = np.sort(np.stack([mesh.path[at], mesh.path[at + 1]], axis=1), axis=1)
    bad = np.flatnonzero(ends[:, 0] == ends[:, 1])
    key = np.column_stack([mesh.path_line[at], ends])
    order = np.lexsort(key.T)
    twice = np.flatnonzero((np.diff(key[order], axis=0) == 0).all(axis=1))
    if len(bad) or len(twice):
        first = bad[0] if len(bad) else order[twice[0]]
        name = mesh.elements.names[int(curve[first])]
        raise GeometryError(
            f"a line on the {name} passes twice through a segment, or it has none, at "
            f"{place(mesh.points[ends[first]].mean(axis=0))}"
        )
