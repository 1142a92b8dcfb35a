"""How long edges on curved faces can be: a mesher is given triangles close to the exact ones."""

from __future__ import annotations

import numpy as np

from decomp.meshes.reasons import Reason
from decomp.meshing.sizing.sizes import curvatures
from decomp.meshing.sizing.wishes import UNKNOWN, Wish, Wishes, joined
from decomp.meshing.surface.layout import samples
from decomp.meshing.surface.surface import MeshSurface
from decomp.tolerance import TINY
from decomp.vectors import Array


def chords(surface: MeshSurface, sizes: Array, rise: float) -> Wishes:
    """The lengths of chords that rise so much, at points of all curved faces; at most the sizes.

    An edge of length l is l^2 k / 8 off a surface of curvature k.

    Args:
        surface: of the model.
        sizes: (r,) the largest length in each region.
        rise: in model units.
    """
    mesh = surface.complex
    found: list[Wish] = []
    for region, size in zip(surface.regions, sizes.tolist(), strict=True):
        for face, sides in zip(region.boundary.faces, region.face_sides, strict=True):
            triangles = np.concatenate([mesh.patches[p].triangles for p, _ in sides])
            some, _ = samples(mesh.points, triangles, size)
            bend = np.abs(curvatures(region.boundary.carriers[face.carrier], some)).max(axis=0)
            lengths = np.minimum(np.sqrt(8 * rise / np.maximum(bend, TINY)), size)
            bent = Reason(f"curvature of {region.name}/{face.name}")
            found.append((some, lengths, ((lengths < size).astype(np.int64), (UNKNOWN, bent))))
    return joined(found)
