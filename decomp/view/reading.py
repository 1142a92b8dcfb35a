"""The scene of a file: of a model's skeleton, of a mesh, of a skeleton's file."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from decomp.drawing.scene import Scene
from decomp.errors import InputError
from decomp.files.format import suffixes
from decomp.formats.table import FORMATS
from decomp.meshes.files.table import READ
from decomp.places import FAR_SIZES
from decomp.vectors import norm

if TYPE_CHECKING:
    from decomp.skeletons.model import Skeleton

MODELS, MESHES, SKELETONS = suffixes(FORMATS), suffixes(READ), (".vtu",)


def scene_of(path: Path, skeleton: Skeleton | None = None) -> Scene:
    """The scene of a file, about its own middle if that is far from the origin.

    Args:
        path: of a mesh (.msh) or of a skeleton's file (.vtu), or of a model.
        skeleton: of the model, where it is one.

    Raises:
        InputError: the file is of none of these kinds, or what reads it is not installed.
        FileError: it cannot be read.
    """
    from decomp.drawing import of_mesh
    from decomp.view import of_skeleton

    suffix = path.suffix.lower()
    if suffix in MESHES:
        scene = of_mesh.read(path)
    elif suffix in SKELETONS:
        scene = of_skeleton.read(path)
    elif skeleton is not None:
        scene = of_skeleton.scene_of(skeleton)
    else:
        known = ", ".join((*MODELS, *MESHES, *SKELETONS))
        raise InputError(
            f"{path}: {suffix!r} is nothing that can be viewed; views are of {known} files"
        )
    return brought_near(scene)


def brought_near(scene: Scene) -> Scene:
    """The scene about its middle if that is far away: single precision has no digits for it."""
    if not len(scene.points):
        return scene
    low, high = scene.points.min(axis=0), scene.points.max(axis=0)
    middle = (low + high) / 2
    if not norm(middle) > FAR_SIZES * norm(high - low):
        return scene
    return replace(scene, points=scene.points - middle, origin=scene.origin + middle)
