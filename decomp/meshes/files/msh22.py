"""Gmsh's old format 2.2 (.msh), text, which more programs read.

Each element has two tags: its physical group and its entity (`entities`).
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from decomp.meshes.files.entities import entities
from decomp.meshes.files.msh41 import TYPES
from decomp.meshes.files.msh_fields import fields
from decomp.meshes.files.names import physical_names
from decomp.meshes.model import TetMesh
from decomp.vectors import Ints


def encoded(mesh: TetMesh) -> bytes:
    """The contents of a file."""
    placed = entities(mesh)
    blocks = (
        (0, mesh.nodes[:, None], mesh.node_tags, placed.nodes),
        (1, mesh.lines, mesh.line_tags, placed.lines),
        (2, mesh.triangles, mesh.triangle_tags, placed.triangles),
        (3, mesh.tets, mesh.tet_tags, placed.tets),
    )
    count = sum(len(elements) for _, elements, *_ in blocks)
    nodes = (f"{k} {x!r} {y!r} {z!r}" for k, (x, y, z) in enumerate(mesh.points.tolist(), 1))
    lines = ["$Nodes", str(len(mesh.points)), *nodes, "$EndNodes", "$Elements", str(count)]
    first = 1
    for dimension, elements, groups, own in blocks:
        lines += _elements(dimension, elements, groups, own, first)
        first += len(elements)
    lines += ["$EndElements", ""]
    head = b"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"
    return (
        head
        + physical_names(mesh)
        + "\n".join(lines).encode()
        + fields(mesh, True, np.arange(len(mesh.tets)))
    )


def _elements(
    dimension: int, elements: Ints, groups: Ints, entities: Ints, first: int
) -> Iterator[str]:
    numbers = np.arange(first, first + len(elements))
    kinds = np.full(len(elements), TYPES[dimension][elements.shape[1]])
    two = np.full(len(elements), 2)
    rows = np.column_stack([numbers, kinds, two, groups, entities, elements + 1])
    for row in rows.tolist():
        yield " ".join(map(str, row))
