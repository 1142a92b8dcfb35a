"""A picture (.png) of a mesh cut open, with every element's edges.

The half of the tetrahedra that is nearer to the eye is left away, so that cells show inside.
"""

from __future__ import annotations

from decomp.drawing import picture
from decomp.drawing.of_mesh import scene_of
from decomp.meshes.model import TetMesh

LOOK = picture.Look(clip=picture.Clip(axis=1, whole=True))


def encoded(mesh: TetMesh) -> bytes:
    """The contents of a file."""
    return picture.encoded(scene_of(mesh), LOOK)
