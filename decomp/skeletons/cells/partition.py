"""The cells of a region, put together from its boundary faces, sheets and trim surfaces.

Every face owns a face cell: the points nearest to it, and those nearest to the reentrant edges and
vertices that it owns. What borders a cell borders it on one known side, so a cell needs no search:
it is the list of all patches that name its face. Skeleton cells are face cells joined across trim
surfaces, where the nearest point passes from one face to the next without a jump.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from scipy.sparse import coo_array  # type: ignore[import-untyped]
from scipy.sparse.csgraph import connected_components  # type: ignore[import-untyped]

from decomp.boundary.topology import RegionBoundary
from decomp.complex.model import Complex
from decomp.skeletons.cells.surface import volume
from decomp.skeletons.model import Cell, Sheet, TrimSurface

NAMED_BY_FACES = 3
"""A cell with more faces is numbered instead."""


def face_cells(
    mesh: Complex,
    boundary: RegionBoundary,
    face_sides: Sequence[Sequence[tuple[int, int]]],
    sheets: Iterable[Sheet],
    trims: Iterable[TrimSurface],
    owner: Mapping[int, int],
) -> tuple[Cell, ...]:
    """One cell for each face of a region, in their order.

    Args:
        mesh: that holds all patches.
        boundary: of the region.
        face_sides: for each face its patches, +1 where the patch's normal points out of the region.
        sheets: of the region.
        trims: of the region; those inside one cell bound nothing.
        owner: the face that owns each site of the region: a face site's is the face itself.
    """
    sides = [list(own) for own in face_sides]
    for sheet in sheets:
        _part(sides, sheet.patch, owner[sheet.sites[0]], owner[sheet.sites[1]])
    for trim in trims:
        if trim.faces[0] != trim.faces[1]:
            _part(sides, trim.patch, *trim.faces)
    names = [face.name for face in boundary.faces]
    return tuple(
        _cell(mesh, boundary, f"{boundary.name}/{name}", (name,), own)
        for name, own in zip(names, sides, strict=True)
    )


def skeleton_cells(
    mesh: Complex,
    boundary: RegionBoundary,
    cells: Sequence[Cell],
    trims: Sequence[TrimSurface],
) -> tuple[Cell, ...]:
    """Join the face cells (one for each face) of a region across its trim surfaces."""
    dropped = {trim.patch for trim in trims}
    groups: dict[int, list[Cell]] = {}
    for cell, group in zip(cells, _groups(len(cells), trims), strict=True):
        groups.setdefault(group, []).append(cell)
    result, numbered = [], 0
    for members in groups.values():
        faces = tuple(name for cell in members for name in cell.faces)
        if len(faces) <= NAMED_BY_FACES:
            name = "+".join(faces)
        else:
            numbered += 1
            name = f"cell-{numbered}"
        sides = [side for cell in members for side in cell.sides if side[0] not in dropped]
        result.append(_cell(mesh, boundary, f"{boundary.name}/{name}", faces, sides))
    return tuple(result)


def _part(sides: list[list[tuple[int, int]]], patch: int, before: int, behind: int) -> None:
    """Put a patch between two cells; its normal leads out of the first into the second."""
    sides[before].append((patch, 1))
    sides[behind].append((patch, -1))


def _groups(count: int, trims: Sequence[TrimSurface]) -> list[int]:
    """The group of each face, where trims join faces."""
    rows, columns = [t.faces[0] for t in trims], [t.faces[1] for t in trims]
    joined = coo_array(([1] * len(trims), (rows, columns)), shape=(count, count))
    return [int(k) for k in connected_components(joined, directed=False)[1]]


def _cell(
    mesh: Complex,
    boundary: RegionBoundary,
    name: str,
    faces: tuple[str, ...],
    sides: Sequence[tuple[int, int]],
) -> Cell:
    content = volume(mesh, sides, boundary.bounds.mean(axis=0))
    return Cell(name, faces, tuple(sides), content)
