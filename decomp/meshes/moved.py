"""A mesh in other coordinates."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from decomp.errors import GeometryError
from decomp.meshes.model import TetMesh
from decomp.meshes.quality import inverted
from decomp.vectors import Array


def moved_mesh(mesh: TetMesh, offset: Array) -> TetMesh:
    """A mesh moved by `offset` (3,); each node is rounded once.

    Raises:
        GeometryError: so far from the origin rounding turns tetrahedra over.
    """
    if not offset.any():
        return mesh
    result = replace(mesh, points=mesh.points + offset)
    before, after = (int(inverted(each.points, each.tets).sum()) for each in (mesh, result))
    if after > before:
        away = float(np.abs(offset).max())
        raise GeometryError(
            f"the model is {away:.3g} away from the origin, where coordinates are "
            f"{np.spacing(away):.1g} apart: {after} of {len(mesh.tets)} tetrahedra would be turned "
            "over by rounding; move the model nearer to the origin, or make its elements larger"
        )
    return result
