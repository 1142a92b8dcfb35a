"""Whether curves and points of a mesh are where the faces meet that they are named for."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from decomp.meshes.about import About
from decomp.meshes.files.msh_reader import ReadMesh
from decomp.meshes.group import NOUNS
from decomp.meshes.incidence import row_keys
from decomp.meshes.mesh_edges import mesh_edges
from decomp.meshes.parts import Parts
from decomp.vectors import Ints


def edge_shortcomings(mesh: ReadMesh, triangles: Ints, tags: Ints, known: About) -> Iterator[str]:
    """Curves and points with elements elsewhere.

    Args:
        mesh: as read.
        triangles: (k, 3) or (k, 6) of faces and interfaces.
        tags: (k,) of the pieces of these.
        known: what the file tells of groups and pieces.
    """
    if not len(mesh.lines) and not len(mesh.nodes):
        return
    parts = Parts(
        known.regions, known.materials, (), mesh.tets[:0, 0], known.surfaces, triangles, tags
    )
    told = {(g.dimension, g.tag): g for g in known.groups}
    names: dict[tuple[int, int], set[str]] = {}
    count = len(mesh.lines)
    for split in (False, True):
        found = mesh_edges(parts, split)
        keys = row_keys(np.concatenate([mesh.lines[:, :2], found.lines[:, :2]]))
        place = {int(key): k for k, key in enumerate(keys[:count])}
        name = {each.tag: each.name for each in found.edges}
        for key, tag in zip(keys[count:].tolist(), found.of_lines.tolist(), strict=True):
            if key in place:
                names.setdefault((1, place[key]), set()).add(name[tag])
        at = {int(node): k for k, node in enumerate(mesh.nodes)}
        name = {each.tag: each.name for each in found.vertices}
        for node, tag in zip(found.nodes.tolist(), found.of_nodes.tolist(), strict=True):
            if node in at:
                names.setdefault((0, at[node]), set()).add(name[tag])
    for dimension, groups in ((1, mesh.line_tags), (0, mesh.node_tags)):
        for tag in np.unique(groups).tolist():
            group = told.get((dimension, tag))
            if group is None:
                continue  # told of as a group that the model has not
            own = set(group.members or (group.name,))
            rows = np.flatnonzero(groups == tag).tolist()
            astray = sum(not names.get((dimension, row), set()) & own for row in rows)
            if astray:
                yield (
                    f"{astray} elements of {NOUNS[dimension]} {group.name} are not where the "
                    "faces meet that it is named for"
                )
