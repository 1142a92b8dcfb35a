"""Whether the groups of a mesh hold the parts that they say they do."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from decomp.checking.edges import edge_shortcomings
from decomp.checking.names import listed_names
from decomp.meshes.files.msh_reader import ReadMesh
from decomp.meshes.group import NOUNS
from decomp.vectors import Ints


def group_shortcomings(mesh: ReadMesh, fine: ReadMesh) -> Iterator[str]:
    """Groups with elements of other parts than theirs, and groups that nothing is known of.

    Args:
        mesh: as read.
        fine: the same by its parts (`decomp.meshes.files.finest`).
    """
    if mesh.about is None:
        return
    known, count = mesh.about, len(mesh.triangles)
    every = (
        (3, (known.cells, known.regions), mesh.tet_tags, fine.tet_tags),
        (2, (known.surfaces,), mesh.triangle_tags, fine.triangle_tags[:count]),
        (1, (), mesh.line_tags, mesh.line_tags),
        (0, (), mesh.node_tags, mesh.node_tags),
    )
    for dimension, kinds, groups, parts in every:
        what = NOUNS[dimension]
        told = {g.tag: g for g in known.groups if g.dimension == dimension}
        names = {tag: name for (d, tag), name in mesh.names.items() if d == dimension}
        strange = [n for tag, n in names.items() if tag not in told or told[tag].name != n]
        yield from listed_names(f"{what}s that the model has not", sorted(strange))
        part = {tag: name for (d, tag), name in fine.names.items() if d == dimension}
        if not any(kind and {k.name for k in kind} <= set(part.values()) for kind in kinds):
            continue  # its parts are not told
        region = {cell.name: cell.regions[0] for cell in known.cells}
        for tag, group in told.items():
            own = group.members or (group.name,)
            for number in _different(parts[groups == tag]):
                name = part.get(number, "")
                if name not in own and region.get(name) not in own:
                    yield f"{what} {group.name} holds elements of {name or number}"
        if dimension == 2:
            yield from edge_shortcomings(mesh, mesh.triangles, parts, known)


def _different(values: Ints) -> list[int]:
    return [int(value) for value in np.unique(values)]
