"""The elements of a mesh that are no tetrahedra, in blocks: points, lines, triangles."""

from __future__ import annotations

from dataclasses import dataclass

from decomp.meshes.model import TetMesh
from decomp.vectors import Ints

VTK_BY_NODES = {0: {1: 1}, 1: {2: 3, 3: 21}, 2: {3: 5, 6: 22}}
"""VTK's types of elements by dimension and number of nodes."""


@dataclass(frozen=True, eq=False)
class Block:
    """Elements of one type.

    Args:
        dimension: 0 to 2.
        vtk: VTK's number of the type.
        elements: (k, c) nodes.
        tags: (k,) of their groups.
    """

    dimension: int
    vtk: int
    elements: Ints
    tags: Ints


def lower_blocks(mesh: TetMesh) -> list[Block]:
    """Those that there are, and triangles in any case."""
    every = (
        (0, mesh.nodes[:, None], mesh.node_tags),
        (1, mesh.lines, mesh.line_tags),
        (2, mesh.triangles, mesh.triangle_tags),
    )
    return [
        Block(dimension, VTK_BY_NODES[dimension][elements.shape[1]], elements, tags)
        for dimension, elements, tags in every
        if dimension == 2 or len(elements)
    ]
