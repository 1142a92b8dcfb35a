"""Mid-surfaces to files, in the formats of `table.py`."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from decomp.files.format import Format, format_of, suffixes
from decomp.midsurfaces.table import FORMATS
from decomp.skeletons.files.elements import KINDS, Elements

if TYPE_CHECKING:
    from decomp.midsurfaces.facing import MidSurface

SUFFIXES = suffixes(FORMATS)


def form_of(path: str | Path) -> Format:
    """The format of a file that `write` can write.

    Raises:
        InputError: its suffix is none of `SUFFIXES`.
    """
    return format_of(path, FORMATS, "mid-surfaces")


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

    form = form_of(path)
    check_outputs([path], [surface.source])
    values = {"thickness": surface.thickness}, {"facing": surface.angle}
    contents: bytes = form.loaded().encoded(_elements(surface), *values)
    write_whole(path, contents)


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
