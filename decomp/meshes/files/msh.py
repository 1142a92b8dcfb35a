"""Gmsh's files (.msh) in all their versions."""

from __future__ import annotations

from decomp.meshes.files import msh22, msh41
from decomp.meshes.files.msh_reader import read_msh as read
from decomp.meshes.model import TetMesh

__all__ = ["encoded", "read"]


def encoded(mesh: TetMesh, *, text: bool, version: str) -> bytes:
    """The contents of a file.

    Args:
        mesh: to write.
        text: whether version 4.1 has text in place of binary numbers.
        version: 4.1, or 2.2, which is always text.
    """
    return msh22.encoded(mesh) if version == "2.2" else msh41.encoded(mesh, text=text)
