"""Names of groups, as Gmsh's formats hold them."""

from __future__ import annotations

from decomp.tetra.mesh import TetMesh


def physical_names(mesh: TetMesh) -> bytes:
    """The section of names, text in binary files too; dimension 2 before 3, as Gmsh writes it."""
    groups = sorted(mesh.groups, key=lambda group: (group.dimension, group.tag))
    lines = [f'{group.dimension} {group.tag} "{group.name}"' for group in groups]
    text = "\n".join(["$PhysicalNames", str(len(lines)), *lines, "$EndPhysicalNames", ""])
    return text.encode()
