"""Tetrahedral meshes to files. The suffix of a file's name tells its format.

The writers are loaded when they are first used.
"""

from __future__ import annotations

from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING

from decomp.errors import InputError
from decomp.files.suffixes import known_suffix

if TYPE_CHECKING:
    from decomp.meshes.model import TetMesh

_WRITERS = {
    ".msh": "decomp.meshes.files.msh22",
    ".vtu": "decomp.meshes.files.vtu",
    ".xdmf": "decomp.meshes.files.xdmf",
    ".inp": "decomp.meshes.files.inp",
    ".mesh": "decomp.meshes.files.medit",
    ".png": "decomp.drawing.mesh_picture",
}
"""Modules with a function `encoded`. What draws pictures reads meshes: it is above this package."""
SUFFIXES = tuple(_WRITERS)
VERSIONS = ("4.1", "2.2")


def suffix_of(path: str | Path) -> str:
    """The suffix of a file that `write` can write.

    Raises:
        InputError: it is none of `SUFFIXES`.
    """
    return known_suffix(path, SUFFIXES, "meshes")


def encoded(mesh: TetMesh, suffix: str, *, text: bool = False, version: str = "4.1") -> bytes:
    """The contents of a file with a suffix of `SUFFIXES`; the options are those of `write`.

    Raises:
        DecompError: the format is written by a library that is not installed.
    """
    if suffix == ".msh" and version == "4.1":
        from decomp.meshes.files import msh41

        return msh41.encoded(mesh, text=text)
    contents: bytes = import_module(_WRITERS[suffix]).encoded(mesh)
    return contents


def write(mesh: TetMesh, path: str | Path, *, text: bool = False, version: str = "4.1") -> None:
    """Write a mesh to a file, whole or not at all.

    Args:
        mesh: to write.
        path: ends in one of `SUFFIXES`, and is not the file that the model was read from.
        text: write Gmsh's format 4.1 as text; other formats are as they are.
        version: of Gmsh's format, one of `VERSIONS`; 2.2 is always text.

    Raises:
        InputError: the suffix or the version is unknown.
        FileError: the file cannot be written.
    """
    from decomp.arguments import switch
    from decomp.files.targets import check_outputs
    from decomp.files.whole_file import write_whole

    suffix = suffix_of(path)
    if version not in VERSIONS:
        raise InputError(f"Gmsh's format {version!r} is not written; use {' or '.join(VERSIONS)}")
    switch(text, "text")
    check_outputs([path], [mesh.source])
    write_whole(path, encoded(mesh, suffix, text=text, version=version))
