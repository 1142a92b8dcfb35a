"""Files that are written whole or not at all."""

from __future__ import annotations

import os
from pathlib import Path

from decomp.errors import FileError


def write_whole(path: str | Path, data: bytes) -> None:
    """Write beside the file first, then put it into its place at once.

    Raises:
        FileError: the file cannot be written.
    """
    check_target(path)
    target = Path(os.path.realpath(path))
    temporary = target.with_name(f".{target.name}.{os.getpid()}.tmp")
    try:
        try:
            temporary.write_bytes(data)
            temporary.replace(target)
        finally:
            temporary.unlink(missing_ok=True)
    except OSError as error:
        raise FileError(f"cannot be written: {error.strerror or error}", path) from None


def check_target(path: str | Path) -> None:
    """See early whether a file can be written, before hours are spent on what goes into it.

    Raises:
        FileError: it is a directory, or its directory does not exist or is not writable.
    """
    target = Path(os.path.realpath(path))
    if target.is_dir():
        raise FileError("this is a directory; give the name of a file to write", path)
    if not target.parent.is_dir():
        raise FileError("cannot be written: its directory does not exist", path)
    if not os.access(target.parent, os.W_OK):
        raise FileError("cannot be written: its directory is not writable", path)
