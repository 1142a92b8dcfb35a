"""Gmsh's old format 2.2 (.msh), text, which more programs read.

Each element has two tags: its physical group and its entity, here the same number.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from decomp.output.mesh.msh41 import TYPES
from decomp.output.mesh.msh_fields import fields
from decomp.output.mesh.names import physical_names
from decomp.tetra.mesh import TetMesh
from decomp.vectors import Ints


def encoded(mesh: TetMesh) -> bytes:
    """The contents of a file."""
    count = len(mesh.triangles) + len(mesh.tets)
    nodes = (f"{k} {x!r} {y!r} {z!r}" for k, (x, y, z) in enumerate(mesh.points.tolist(), 1))
    lines = ["$Nodes", str(len(mesh.points)), *nodes, "$EndNodes", "$Elements", str(count)]
    lines += _elements(mesh.triangles, mesh.triangle_tags, 1)
    lines += _elements(mesh.tets, mesh.tet_tags, len(mesh.triangles) + 1)
    lines += ["$EndElements", ""]
    head = b"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"
    return (
        head
        + physical_names(mesh)
        + "\n".join(lines).encode()
        + fields(mesh, text=True, by_tag=False)
    )


def _elements(elements: Ints, tags: Ints, first: int) -> Iterator[str]:
    numbers = np.arange(first, first + len(elements))
    kinds = np.full(len(elements), TYPES[elements.shape[1]])
    two = np.full(len(elements), 2)
    rows = np.column_stack([numbers, kinds, two, tags, tags, elements + 1])
    for row in rows.tolist():
        yield " ".join(map(str, row))
