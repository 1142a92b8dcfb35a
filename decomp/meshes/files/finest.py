"""A mesh as read, with the finest parts that it tells of in the place of its groups.

- Tetrahedra by cells where it has the field `cell` and the cells' names, else by regions.
- Triangles by pieces of faces and interfaces, which are entities in .msh files.
- Sheets where tetrahedra of two cells of one region meet and no triangle is.
What it does not tell of stays as its groups have it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from decomp.meshes.about import About, by_tag
from decomp.meshes.files.msh_reader import ReadMesh
from decomp.meshes.group import Group, GroupKind
from decomp.meshes.incidence import MIDDLES, faces_of, row_keys
from decomp.meshes.parts import looked_up
from decomp.vectors import Bools, Ints


def finest(mesh: ReadMesh) -> ReadMesh:
    """The mesh by its parts; the same one where only groups are known."""
    known = mesh.about
    if known is None:
        return mesh
    names = dict(mesh.names)
    tets, solids = _solids(mesh, known)
    if tets is not None:
        names = _with(names, 3, solids)
        mesh = replace(mesh, tet_tags=tets)
    surfaces = by_tag(known.surfaces)
    entities = mesh.triangle_entities
    if entities is not None and set(np.unique(entities).tolist()) <= set(surfaces):
        names = _with(names, 2, surfaces)
        mesh = replace(mesh, triangle_tags=entities)
    mesh = replace(mesh, names=names)
    of_cells = any(solid.kind is GroupKind.CELL for solid in solids.values())
    return _with_sheets(mesh, solids) if tets is not None and of_cells else mesh


def _solids(mesh: ReadMesh, known: About) -> tuple[Ints | None, dict[int, Group]]:
    """The cell or region (m,) of each tetrahedron, None if it is not told, and these by tag."""
    tags = mesh.tet_entities
    solids = by_tag(known.regions)
    if known.cells and "cell" in mesh.cell_data:
        tags, solids = np.rint(mesh.cell_data["cell"]).astype(np.int64), by_tag(known.cells)
    elif any(group.kind is GroupKind.CELL for group in known.groups):
        solids = by_tag(known.cells)
    told = tags is not None and set(np.unique(tags).tolist()) <= set(solids)
    return (tags if told else None), solids


def _with(
    names: Mapping[tuple[int, int], str], dimension: int, parts: Mapping[int, Group]
) -> dict[tuple[int, int], str]:
    """Names with those of parts in the place of a dimension's groups."""
    kept = {key: name for key, name in names.items() if key[0] != dimension}
    return kept | {(dimension, tag): part.name for tag, part in parts.items()}


def _with_sheets(mesh: ReadMesh, cells: Mapping[int, Group]) -> ReadMesh:
    """With the faces between cells of one region that no triangle is on."""
    faces = faces_of(mesh.tets)
    keys = row_keys(np.concatenate([faces, mesh.triangles[:, :3]]))
    own, tagged = keys[: len(faces)], keys[len(faces) :]
    order = np.argsort(own, kind="stable")
    one, two = order[:-1], order[1:]
    region = {name: k for k, name in enumerate(dict.fromkeys(c.regions[0] for c in cells.values()))}
    of_cell = {tag: region[cell.regions[0]] for tag, cell in cells.items()}
    cell, owner = mesh.tet_tags, looked_up(of_cell, mesh.tet_tags)
    between: Bools = (own[one] == own[two]) & (owner[one // 4] == owner[two // 4])
    between &= (cell[one // 4] != cell[two // 4]) & ~np.isin(own[one], tagged)
    one, two = one[between], two[between]
    pairs = np.sort(np.stack([cell[one // 4], cell[two // 4]], axis=1), axis=1)
    different, which = np.unique(pairs, axis=0, return_inverse=True)
    first = max((tag for dimension, tag in mesh.names if dimension == 2), default=0) + 1
    names = dict(mesh.names)
    for k, (low, high) in enumerate(different.tolist(), first):
        start = f"{cells[low].regions[0]}/"
        ends = "|".join(cells[tag].name.removeprefix(start) for tag in (low, high))
        names[2, k] = f"{start}{ends}"
    # they point out of the first cell named
    out = np.where(cell[one // 4] < cell[two // 4], one, two)
    nodes = faces[out]
    if mesh.triangles.shape[1] == 6:
        nodes = np.column_stack([nodes, mesh.tets[:, MIDDLES].reshape(-1, 3)[out]])
    return replace(
        mesh,
        names=names,
        triangles=np.concatenate([mesh.triangles, nodes]),
        triangle_tags=np.concatenate([mesh.triangle_tags, first + which.reshape(-1)]),
    )
