"""A mesh back from a .msh file, with its groups, its parts and its fields."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from decomp.errors import FileError
from decomp.meshes.about import About
from decomp.meshes.files import read_file
from decomp.meshes.files.finest import finest
from decomp.meshes.files.msh_reader import NONE, SEVERAL, ReadMesh
from decomp.meshes.group import Group, GroupKind
from decomp.meshes.model import TetMesh
from decomp.meshes.parts import Parts, looked_up
from decomp.paths import path_of
from decomp.plain import plain
from decomp.vectors import Array, Ints

WHOLE = ("cell", "nearest", "region")
"""Fields of whole numbers."""


def read(path: str | Path) -> TetMesh:
    """Read a mesh of tetrahedra from a .msh file of Gmsh's format 4.1 or 2.2.

    A file that decomp has written gives back the mesh with all that it knew of groups, regions,
    faces, cells and, but for those that end inside a cell, sheets; wanted lengths are not in it. Of
    another program's file groups are known by their names alone.

    Args:
        path: of the file; it is the mesh's `source`, over which nothing is written.

    Raises:
        FileError: it cannot be read, has another format, or elements other than triangles and
            tetrahedra of order 1 or 2; a tetrahedron is in no physical group, or an element in
            several.
    """
    path = path_of(path, "the mesh's file")
    found = read_file(path)
    _check_groups(found, path)
    rows = found.triangle_tags != NONE
    entities = found.triangle_entities
    found = replace(
        found,
        triangles=found.triangles[rows],
        triangle_tags=found.triangle_tags[rows],
        triangle_entities=None if entities is None else entities[rows],
    )
    known = found.about
    groups = known.groups if known is not None and _same(known, found) else _named(found)
    off = () if known is None else known.unprojected
    result = TetMesh(
        plain(path.stem) if known is None else known.model,
        found.points,
        found.tets,
        found.tet_tags,
        found.triangles,
        found.triangle_tags,
        groups,
        np.array([k for k in off if k < len(found.points)], dtype=np.int64),
        point_data=found.point_data,
        cell_data={name: _whole(name, values) for name, values in found.cell_data.items()},
        source=path,
        lines=found.lines,
        line_tags=found.line_tags,
        nodes=found.nodes,
        node_tags=found.node_tags,
    )
    parts = _parts(found)
    if parts is None:
        return result
    return replace(result, parts=parts, part_rows=np.arange(len(found.triangles)))


def _whole(name: str, values: Array) -> Ints:
    """Numbers of things as whole numbers; another program's field as it is."""
    return np.asarray(np.rint(values).astype(np.int64) if name in WHOLE else values)


def _check_groups(mesh: ReadMesh, path: Path) -> None:
    for what, tags in (("tetrahedra", mesh.tet_tags), ("triangles", mesh.triangle_tags)):
        count = int((tags == SEVERAL).sum())
        if count:
            raise FileError(
                f"{count} {what} are in several physical groups: let each be in one", path
            )
    count = int((mesh.tet_tags == NONE).sum())
    if count:
        raise FileError(
            f"{count} tetrahedra are in no physical group: give each volume a group", path
        )


def _same(known: About, mesh: ReadMesh) -> bool:
    """Whether what the file tells of its groups is still true of their names."""
    told = {(group.dimension, group.tag): group.name for group in known.groups}
    return told == mesh.names


def _named(mesh: ReadMesh) -> tuple[Group, ...]:
    """Groups of which names are all that is known."""
    groups = []
    for (dimension, tag), name in sorted(mesh.names.items(), key=lambda item: -item[0][0]):
        name = name or f"group {tag}"
        regions = tuple(dict.fromkeys(side.partition("/")[0] for side in name.split("|")))
        groups.append(Group(_kind(dimension, name), tag, name, regions))
    return tuple(groups)


def _kind(dimension: int, name: str) -> GroupKind:
    """What decomp calls so."""
    if dimension < 2:
        return GroupKind.EDGE if dimension == 1 else GroupKind.VERTEX
    if dimension == 3:
        return GroupKind.CELL if "/" in name else GroupKind.REGION
    if "|" not in name:
        return GroupKind.FACE
    return GroupKind.SHEET if name.count("/") == 1 else GroupKind.INTERFACE


def _parts(mesh: ReadMesh) -> Parts | None:
    """The parts, if the file tells of those of all elements."""
    known, fine = mesh.about, finest(mesh)
    if known is None:
        return None
    cells = known.cells if _all_in(fine, 3, known.cells) else ()
    solids = cells or known.regions
    if not _all_in(fine, 3, solids) or not _all_in(fine, 2, known.surfaces):
        return None
    surfaces, triangles, tags = _surfaces(mesh, fine, known)
    return Parts(known.regions, known.materials, cells, fine.tet_tags, surfaces, triangles, tags)


def _surfaces(mesh: ReadMesh, fine: ReadMesh, known: About) -> tuple[tuple[Group, ...], Ints, Ints]:
    """Faces, interfaces and those sheets that are whole, with their triangles and these' tags.

    Sheets that are no groups are where cells meet, but for those within a cell, and where trim
    surfaces part cells too.
    """
    of_name = {surface.name: surface.tag for surface in known.surfaces}
    table = {t: of_name.get(name, -1) for (d, t), name in fine.names.items() if d == 2}
    tags = looked_up(table, fine.triangle_tags)
    whole = tuple(
        surface
        for surface, size in zip(known.surfaces, known.sizes, strict=True)
        if surface.kind is not GroupKind.SHEET or int((tags == surface.tag).sum()) == size
    )
    kept = np.isin(tags, [surface.tag for surface in whole])
    kept[: len(mesh.triangles)] = True
    return whole, fine.triangles[kept], tags[kept]


def _all_in(fine: ReadMesh, dimension: int, parts: tuple[Group, ...]) -> bool:
    """Whether the elements of a dimension are told by parts."""
    names = {tag: name for (d, tag), name in fine.names.items() if d == dimension}
    return bool(parts) and all(names.get(part.tag) == part.name for part in parts)
