"""Tetrahedral meshes to and from files, in the formats of `table.py`.

The suffix of a file's name tells its format. Writers and readers are loaded when they are first
used.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from decomp.errors import InputError
from decomp.files.format import format_of, suffixes
from decomp.meshes.files.table import FORMATS, READ, MeshFormat

if TYPE_CHECKING:
    from decomp.meshes.files.msh_reader import ReadMesh
    from decomp.meshes.model import TetMesh

SUFFIXES = suffixes(FORMATS)


def form_of(path: str | Path) -> MeshFormat:
    """The format of a file that `write` can write.

    Raises:
        InputError: its suffix is none of `SUFFIXES`.
    """
    return format_of(path, FORMATS, "meshes")


def read_file(path: Path) -> ReadMesh:
    """A mesh as a file has it; one whose suffix tells no format is read in the first that is read.

    Raises:
        FileError: it cannot be read, or is of another format.
    """
    suffix = path.suffix.lower()
    form = next((known for known in READ if suffix in known.suffixes), READ[0])
    found: ReadMesh = form.loaded().read(path)
    return found


def encoded(
    mesh: TetMesh, form: MeshFormat, *, text: bool = False, version: str | None = None
) -> bytes:
    """The contents of a file; the options are those of `write`.

    Raises:
        DecompError: the format is written by a library that is not installed.
    """
    versions = form.versions
    options = {"text": text, "version": version or versions[0]} if versions else {}
    contents: bytes = form.loaded().encoded(mesh, **options)
    return contents


def write(mesh: TetMesh, path: str | Path, *, text: bool = False, version: str = "4.1") -> None:
    """Write a mesh to a file, whole or not at all.

    Args:
        mesh: to write.
        path: ends in one of `SUFFIXES`, and is not the file that the model was read from.
        text: write Gmsh's format 4.1 as text; other formats are as they are.
        version: of Gmsh's format, 4.1 or 2.2, which is always text; other formats have none.

    Raises:
        InputError: the suffix or the version is unknown.
        FileError: the file cannot be written.
    """
    from decomp.arguments import switch
    from decomp.files.targets import check_outputs
    from decomp.files.whole_file import write_whole

    form = form_of(path)
    known = [each for other in FORMATS for each in other.versions]
    if version not in (form.versions or known):
        raise InputError(f"Gmsh's format {version!r} is not written; use {' or '.join(known)}")
    switch(text, "text")
    check_outputs([path], [mesh.source])
    write_whole(path, encoded(mesh, form, text=text, version=version))
