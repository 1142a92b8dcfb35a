"""Names of groups, as Gmsh's formats hold them."""

from __future__ import annotations

from decomp.meshes.about import about, about_lines
from decomp.meshes.files.msh_names import names_section
from decomp.meshes.model import TetMesh


def physical_names(mesh: TetMesh) -> bytes:
    """The section of names, and comments with all that is known of groups and of their parts.

    Both are text in binary files too.

    Volumes come first: of groups with the same name meshio, and scikit-fem with it, knows the last
    one alone, and conditions are set on surfaces.
    """
    groups = sorted(mesh.groups, key=lambda group: (-group.dimension, group.tag))
    names = [((group.dimension, group.tag), group.name) for group in groups]
    return names_section(names, about_lines(about(mesh)))
