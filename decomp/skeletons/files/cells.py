"""A directory with the closed surface of every cell, and an index of them."""

from __future__ import annotations

import json
import os
import re
from collections.abc import Iterable
from pathlib import Path
from typing import Any, Literal

from decomp.errors import FileError
from decomp.files.format import format_named
from decomp.files.targets import check_outputs, reason, same_file
from decomp.files.whole_file import write_whole
from decomp.skeletons.cells.surface import cell_surface
from decomp.skeletons.files.table import CELL_FORMATS
from decomp.skeletons.model import Skeleton

CellKind = Literal["skeleton", "face"]
INDEX = "index.json"
LONGEST = 200
"""Bytes of a file's name before its suffix; file systems allow 255 for all."""


def write_cells(
    skeleton: Skeleton, directory: str | Path, kind: CellKind = "skeleton", form: str = "stl"
) -> list[Path]:
    """Write every cell's surface, then `index.json`; each file is written whole or not at all.

    Nothing is written if one of the files cannot be.

    Args:
        skeleton: whose cells to write.
        directory: is made if it does not exist.
        kind: skeleton cells, or face cells.
        form: the name of one of `CELL_FORMATS`.

    Returns:
        the files, in the order of regions and cells, the index last.

    Raises:
        InputError: the format is unknown.
        FileError: the directory or a file cannot be written, or the model was read from one.
    """
    writer = format_named(form, CELL_FORMATS, "cells").loaded()
    check_directory(directory, form)
    folder = Path(directory)
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise FileError(f"cannot be made: {reason(error)}", directory) from None
    pairs = [
        (region.name, cell)
        for region in skeleton.regions
        for cell in (region.cells if kind == "skeleton" else region.face_cells)
    ]
    names = [f"{stem}.{form}" for stem in file_stems(cell.name for _, cell in pairs)]
    files = [folder / name for name in (*names, INDEX)]
    check_outputs(files, [skeleton.source])
    rows: list[dict[str, Any]] = []
    for (region, cell), file in zip(pairs, names, strict=True):
        points, triangles = cell_surface(skeleton.complex, cell.sides)
        write_whole(folder / file, writer.surface(points, triangles))
        rows.append(
            {
                "name": cell.name,
                "file": file,
                "region": region,
                "faces": list(cell.faces),
                "volume": cell.volume,
                "triangles": len(triangles),
            }
        )
    index = {"model": skeleton.name, "kind": kind, "cells": rows}
    text = json.dumps(index, indent=1, ensure_ascii=False) + "\n"
    write_whole(files[-1], text.encode())
    return files


def check_directory(directory: str | Path, form: str, model: str | Path | None = None) -> None:
    """See early whether a directory is there or can be made, and files written into it.

    What cells are called is not known yet, so the model may be none of the files that are there and
    could be a cell's.

    Args:
        directory: to write to.
        form: the name of one of `CELL_FORMATS`.
        model: the file that it is read from, if any.

    Raises:
        FileError: it cannot, or the model might be lost.
    """
    nearest = Path(directory).absolute()
    while not nearest.exists() and nearest != nearest.parent:
        nearest = nearest.parent
    if not nearest.is_dir():
        raise FileError(f"{nearest} is a file; give the name of a directory", directory)
    if not os.access(nearest, os.W_OK):
        raise FileError(f"{nearest} is not writable", directory)
    folder = Path(directory)
    if not folder.is_dir():
        return
    check_outputs([folder / INDEX], [model])
    for file in folder.glob(f"*.{form}"):
        if model is not None and same_file(file, model):
            raise FileError(
                "this file is read, and a cell could be written over it: "
                "give another directory or format",
                file,
            )


def file_stems(names: Iterable[str]) -> list[str]:
    """Names of files, without suffix, for names of cells: safe on every system, all different.

    Letters, digits and `.+-@#` stay, everything else becomes `_`; what has come out before, be it
    in other case, gets `~2`, `~3`...
    """
    seen: set[str] = {"index"}
    stems = []
    for name in names:
        safe = re.sub(r"[^\w.+\-@#]", "_", name)
        safe = re.sub(r"^[.\-]", "_", safe)
        safe = safe.encode()[:LONGEST].decode(errors="ignore")
        stem, count = safe, 1
        while stem.casefold() in seen:
            count += 1
            stem = f"{safe}~{count}"
        seen.add(stem.casefold())
        stems.append(stem)
    return stems
