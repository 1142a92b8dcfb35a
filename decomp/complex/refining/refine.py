"""Refining a complex until its chord error is within tolerance, with few triangles.

1. Segments of lines are split at exact points, so that parts come out equal, until each is close
   to its curve; after each batch edges are flipped.
2. Edges inside patches, the worst first, are split likewise.
3. Patches that touch along chords are parted.
4. Vertices inside patches are removed where that leaves the error within tolerance.
5. Errors close to the tolerance are measured again, more thoroughly.
"""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
from typing import Final, TypeAlias

import numpy as np

from decomp.complex.model import Complex
from decomp.complex.refining.changing_mesh import Mesh
from decomp.complex.refining.collapse import collapse
from decomp.complex.refining.flips import flip
from decomp.complex.refining.split import (
    FOLDED,
    split_inside,
    split_leaning,
    split_lines,
    split_twins,
)
from decomp.errors import GeometryError
from decomp.vectors import Array, Ints, positive

Progress: TypeAlias = Callable[[int], None]

SPLITTING_BATCHES: Final = 300
"""Batches of splits after which a surface counts as one that cannot be followed."""
THOROUGH_ROUNDS: Final = 4
"""So often a lenient mesh is measured thoroughly."""
LEANING_ROUNDS: Final = 12
"""So often triangles that only lean are split."""
GROWING: Final = 12
"""Where folds have grown in so many batches in a row, with the largest error as it was, it is
without end."""


def refine(given: Complex, tolerance: float | Array, progress: Progress | None = None) -> Complex:
    """A conforming complex whose chord error is at most `tolerance`, with few triangles.

    Args:
        given: conforming, with exact vertices; it may be coarse.
        tolerance: largest distance of triangles and segments from their surfaces and curves, in
            model units; one for all patches, or (p,) one for each.
        progress: told the number of triangles after each batch of changes.

    Raises:
        InputError: the tolerance is not positive.
        GeometryError: the complex is not valid, or a surface or curve cannot be followed; the
            message says where.
    """
    return refined(given, tolerance, progress)[0]


def refined(
    given: Complex,
    tolerance: float | Array,
    progress: Progress | None = None,
    lenient: bool = False,
) -> tuple[Complex, Ints]:
    """As `refine`, with the new number of each given point.

    It is -1 for a point inside a patch that was removed; the others keep their order. Points on
    lines, and points in no triangle, are never removed. If `lenient`, what cannot be followed, or
    stays folded, is left as it is.
    """
    for each in np.unique(tolerance):
        positive(each, "tolerance")
    mesh = Mesh(
        given, np.broadcast_to(np.asarray(tolerance, np.float64), len(given.patches)), lenient
    )
    _check(mesh)
    _split(mesh, progress)
    collapse(mesh)
    left = THOROUGH_ROUNDS
    while mesh.check() and (not lenient or left):
        left -= 1
        _split(mesh, progress)
    return mesh.result()


def _split(mesh: Mesh, progress: Progress | None) -> None:
    """Split and flip until all errors are within the limit and no triangle leans."""
    patience = LEANING_ROUNDS
    history: list[tuple[int, float]] = []
    for _ in range(SPLITTING_BATCHES):
        flip(mesh)
        if not mesh.lenient:
            _check_growth(mesh, history)
        if progress is not None:
            progress(len(mesh.triangles))
        if split_lines(mesh) or split_inside(mesh):
            continue
        if not mesh.lenient:
            _check_folds(mesh, FOLDED if patience > 0 else 0.0)
        leaning = split_leaning(mesh) if patience > 0 else 0
        patience -= 1
        if not (leaning or split_twins(mesh)):
            return
    if mesh.lenient:
        return
    worst = int(np.nanargmax(mesh.error))
    name = mesh.elements.names[int(mesh.surface[worst])]
    at = mesh.points[mesh.triangles[worst]].mean(axis=0)
    raise GeometryError(f"the {name} cannot be followed to the tolerance near {{at}}", at=at)


def _check_growth(mesh: Mesh, history: list[tuple[int, float]]) -> None:
    """See that folds do not only grow: each split of one then makes two, without end.

    Args:
        history: the number of folded triangles and the largest error of each batch so far; those
            of this one are added.
    """
    folded = np.flatnonzero(mesh.upright < 0)
    history.append((len(folded), float(mesh.error.max(initial=0.0))))
    last = history[-1 - GROWING :]
    grown = all(after[0] > before[0] for before, after in pairwise(last))
    if len(last) > GROWING and grown and last[-1][1] >= last[0][1]:
        worst = int(folded[np.argmax(mesh.error[folded])])
        name = mesh.elements.names[int(mesh.surface[worst])]
        at = mesh.points[mesh.triangles[worst]].mean(axis=0)
        raise GeometryError(f"triangles fold over without end on the {name} at {{at}}", at=at)


def _check_folds(mesh: Mesh, least_upright: float) -> None:
    """Splitting helps a triangle that leans; one that is folded, or stays so, is an error."""
    least = int(np.argmin(mesh.upright)) if len(mesh.upright) else -1
    if least >= 0 and mesh.upright[least] <= least_upright:
        name = mesh.elements.names[int(mesh.surface[least])]
        at = mesh.points[mesh.triangles[least]].mean(axis=0)
        raise GeometryError(f"a triangle stays folded on the {name} at {{at}}", at=at)


def _check(mesh: Mesh) -> None:
    """Each triangle needs three vertices, each segment two, each closed line three."""
    a, b, c = mesh.triangles.T
    bad = np.flatnonzero((a == b) | (b == c) | (c == a))
    if len(bad):
        at = mesh.points[mesh.triangles[bad[0]]].mean(axis=0)
        raise GeometryError("a triangle has the same vertex twice at {at}", at=at)
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
            f"a line on the {name} passes twice through a segment, or it has none, at {{at}}",
            at=mesh.points[ends[first]].mean(axis=0),
        )
