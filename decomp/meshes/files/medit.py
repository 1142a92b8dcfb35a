"""Medit's format (.mesh), text, for Medit, Mmg, Gmsh and others.

References are the groups' tags; those of vertices are 0 but where points are groups. The format
holds no names; comments at its head tell them.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from decomp.meshes.model import TetMesh
from decomp.meshes.ordering import in_vtk_order
from decomp.plain import plain
from decomp.vectors import Ints

WHAT = {3: "Tetrahedra", 2: "Triangles", 1: "Edges", 0: "Vertices"}


def encoded(mesh: TetMesh) -> bytes:
    """The contents of a file."""
    end = "" if mesh.order == 1 else "P2"
    lines = ["MeshVersionFormatted 2", "Dimension 3"]
    for group in mesh.groups:
        lines.append(f"# {WHAT[group.dimension]} {group.tag}: {plain(group.name)}")
    reference = np.zeros(len(mesh.points), dtype=np.int64)
    reference[mesh.nodes] = mesh.node_tags
    lines += ["Vertices", str(len(mesh.points))]
    places = zip(mesh.points.tolist(), reference.tolist(), strict=True)
    lines += [f"{x!r} {y!r} {z!r} {own}" for (x, y, z), own in places]
    if len(mesh.lines):
        lines += _elements(f"Edges{end}", mesh.lines, mesh.line_tags)
    lines += _elements(f"Triangles{end}", mesh.triangles, mesh.triangle_tags)
    lines += _elements(f"Tetrahedra{end}", in_vtk_order(mesh.tets), mesh.tet_tags)
    return ("\n".join([*lines, "End"]) + "\n").encode()


def _elements(keyword: str, elements: Ints, tags: Ints) -> Iterator[str]:
    yield keyword
    yield str(len(elements))
    for row in np.column_stack([elements + 1, tags]).tolist():
        yield " ".join(map(str, row))
