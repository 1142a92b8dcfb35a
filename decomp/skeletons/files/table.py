"""The formats of skeletons and of cells. A new one is a module beside this one, and a line here."""

from __future__ import annotations

from dataclasses import dataclass

from decomp.files.format import Format


@dataclass(frozen=True)
class SkeletonFormat(Format):
    """A format of skeletons.

    Its module has `encoded(parts)` of the skeleton's `Elements`, which gives the file's bytes; of a
    format without triangles `encoded(skeleton)`.

    Args:
        triangles: whether it holds triangles.
    """

    triangles: bool = True


VTU, PLY, OBJ, STL = (f"decomp.skeletons.files.{name}" for name in ("vtu", "ply", "obj", "stl"))
FORMATS = (
    SkeletonFormat("ParaView", (".vtu",), VTU),
    SkeletonFormat("binary", (".ply",), PLY),
    SkeletonFormat("text", (".obj",), OBJ),
    SkeletonFormat(
        "without triangles", (".json",), "decomp.skeletons.files.as_json", triangles=False
    ),
)
CELL_FORMATS = (
    Format("single precision", (".stl",), STL),
    Format("text", (".obj",), OBJ),
    Format("binary", (".ply",), PLY),
)
"""Their modules have `surface(points, triangles)`, which gives the bytes of a closed surface."""
