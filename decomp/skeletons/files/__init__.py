"""Skeletons and cells to files, in the formats of `table.py`.

The suffix of a file's name tells its format. The writers are loaded when they are first used.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from decomp.files.format import format_of, suffixes
from decomp.skeletons.files.table import FORMATS, SkeletonFormat

if TYPE_CHECKING:
    from decomp.skeletons.model import Skeleton

SUFFIXES = suffixes(FORMATS)


def form_of(path: str | Path) -> SkeletonFormat:
    """The format of a file that `write` can write.

    Raises:
        InputError: its suffix is none of `SUFFIXES`.
    """
    return format_of(path, FORMATS, "skeletons")


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
    from decomp.skeletons.files.elements import elements

    form = form_of(path)
    check_outputs([path], [skeleton.source])
    given = elements(skeleton, boundary=boundary, trims=trims) if form.triangles else skeleton
    contents: bytes = form.loaded().encoded(given)
    write_whole(path, contents)
