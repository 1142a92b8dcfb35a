"""Files that are written whole or not at all."""

from __future__ import annotations

import os
import secrets
import sys
from contextlib import suppress
from pathlib import Path

from decomp.errors import FileError
from decomp.files.targets import check_target, descriptor, is_special, reason, status


def write_whole(path: str | Path, data: bytes) -> None:
    """Write beside the file first, then put it into its place at once.

    Where there is a file already, its mode is kept, and its owner as far as the system allows. A
    link stays, and what it leads to is replaced. Devices, pipes and open streams (`/dev/stdout`)
    cannot be replaced: they are written to.

    Raises:
        FileError: the file cannot be written.
    """
    check_target(path)
    try:
        stream = descriptor(path)
        if stream is not None:
            _into_stream(stream, data)
        elif is_special(path):
            _into_device(path, data)
        else:
            _replaced(Path(os.path.realpath(path)), status(path), data)
    except OSError as error:
        raise FileError(f"cannot be written: {reason(error)}", path) from None


def _replaced(target: Path, old: os.stat_result | None, data: bytes) -> None:
    temporary = target.with_name(f".decomp-{secrets.token_hex(8)}.tmp")
    try:
        # others may not have been allowed to read the old file: they may not read the new one early
        temporary.touch(0o666 if old is None else 0o600, exist_ok=False)
        temporary.write_bytes(data)
        if old is not None:
            _as_before(temporary, old)
        temporary.replace(target)
    finally:
        temporary.unlink(missing_ok=True)


def _as_before(file: Path, old: os.stat_result) -> None:
    """Give a file the owner, group and mode of the one that it replaces."""
    if os.name == "posix":
        for owner in (old.st_uid, -1):
            with suppress(PermissionError):  # most users can give files to no other
                os.chown(file, owner, old.st_gid)
                break
    file.chmod(old.st_mode & 0o7777)


def _into_stream(stream: int, data: bytes) -> None:
    """What has been printed before comes first."""
    if sys.stdout is not None:
        sys.stdout.flush()
    with os.fdopen(stream, "wb", closefd=False) as file:
        file.write(data)


def _into_device(path: str | Path, data: bytes) -> None:
    with open(path, "wb", opener=_existing) as file:
        file.write(data)


def _existing(path: str, flags: int) -> int:
    """Open a file, but make none: systems keep some pipes from those who might make them."""
    return os.open(path, flags & ~os.O_CREAT)
