"""Names of groups, as Gmsh's formats hold them."""

from __future__ import annotations

from decomp.tetra.mesh import TetMesh
from decomp.tetra.msh_names import names_section


def physical_names(mesh: TetMesh) -> bytes:
    """The section of names, text in binary files too.

    Volumes come first: of groups with the same name meshio, and scikit-fem with it, knows the last
    one alone, and conditions are set on surfaces.
    """
    groups = sorted(mesh.groups, key=lambda group: (-group.dimension, group.tag))
    return names_section([((group.dimension, group.tag), group.name) for group in groups])
