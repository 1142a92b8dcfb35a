"""Skeletons and cells to files. The suffix of a file's name tells its format.

The writers are loaded when they are first used.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from decomp.files.suffixes import known_suffix

if TYPE_CHECKING:
    from decomp.skeletons.model import Skeleton

SUFFIXES = (".vtu", ".ply", ".obj", ".json")
CELL_FORMATS = ("stl", "obj", "ply")


def suffix_of(path: str | Path) -> str:
    """The suffix of a file that `write` can write.

    Raises:
        InputError: it is none of `SUFFIXES`.
    """
    return known_suffix(path, SUFFIXES, "skeletons")


def write(
    skeleton: Skeleton, path: str | Path, *, boundary: bool = False, trims: bool = False
) -> None:
    """Write a skeleton to a file, whole or not at all.

    Args:
        skeleton: to write.
        path: ends in one of `SUFFIXES`, and is not the file that the model was read from.
        boundary: write the boundary's faces and edges too.
        trims: write the trim surfaces too. JSON has no triangles and heeds neither.

    Raises:
        InputError: the suffix is unknown.
        FileError: the file cannot be written.
    """
    from decomp.files.targets import check_outputs
    from decomp.files.whole_file import write_whole
    from decomp.skeletons.files import as_json, obj, ply, vtu
    from decomp.skeletons.files.elements import elements

    suffix = suffix_of(path)
    check_outputs([path], [skeleton.source])
    if suffix == ".json":
        write_whole(path, as_json.encoded(skeleton))
        return
    parts = elements(skeleton, boundary=boundary, trims=trims)
    encode = {".vtu": vtu.encoded, ".ply": ply.encoded, ".obj": obj.encoded}[suffix]
    write_whole(path, encode(parts))
