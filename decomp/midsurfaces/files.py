"""Mid-surfaces to files. The suffix of a file's name tells its format."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from decomp.files.suffixes import known_suffix
from decomp.skeletons.files.elements import KINDS, Elements

if TYPE_CHECKING:
    from decomp.midsurfaces.facing import MidSurface

SUFFIXES = (".vtu", ".ply", ".obj", ".stl")


def suffix_of(path: str | Path) -> str:
    """The suffix of a file that `write` can write.

    Raises:
        InputError: it is none of `SUFFIXES`.
    """
    return known_suffix(path, SUFFIXES, "mid-surfaces")


def write(surface: MidSurface, path: str | Path) -> None:
    """Write a mid-surface to a file, whole or not at all.

    Args:
        surface: to write. `.vtu` and `.ply` hold the thickness; `.obj` groups triangles by sheet.
        path: ends in one of `SUFFIXES`, and is not the file that the model was read from.

    Raises:
        InputError: the suffix is unknown.
        FileError: the file cannot be written.
    """
    from decomp.files.targets import check_outputs
    from decomp.files.whole_file import write_whole
    from decomp.skeletons.files import obj, ply, stl, vtu

    suffix = suffix_of(path)
    check_outputs([path], [surface.source])
    if suffix == ".stl":
        write_whole(path, stl.surface(surface.points, surface.triangles))
        return
    parts = _elements(surface)
    thickness = {"thickness": surface.thickness}
    if suffix == ".obj":
        write_whole(path, obj.encoded(parts))
    elif suffix == ".ply":
        write_whole(path, ply.encoded(parts, thickness))
    else:
        write_whole(path, vtu.encoded(parts, thickness, {"facing": surface.angle}))


def _elements(surface: MidSurface) -> Elements:
    """Triangles sorted by sheet, as the writers of skeletons take them."""
    count = len(surface.triangles)
    none = np.full(count, -1, dtype=np.int64)
    return Elements(
        surface.points,
        surface.thickness / 2,
        surface.triangles,
        np.empty((0, 2), dtype=np.int64),
        np.empty((0, 1), dtype=np.int64),
        np.full(count, KINDS.index("sheet"), dtype=np.int64),
        surface.region,
        surface.sheet,
        none,
        surface.sites,
        none,
        none,
        none,
        surface.sheet_names,
        (),
    )
