"""What stands where a file is to be written: nothing, a file, or a device, pipe or open stream."""

from __future__ import annotations

import os
import stat
from collections.abc import Iterable
from pathlib import Path

from decomp.errors import FileError

MOST_LINKS = 40
"""Links that are followed to an open stream; systems follow as many."""

Identity = str | tuple[int, int]


def check_outputs(outputs: Iterable[str | Path], inputs: Iterable[str | Path | None] = ()) -> None:
    """See early whether files can be written, and that none of them is read or written twice.

    Args:
        outputs: files to write.
        inputs: files that are read; None for what came from no file.

    Raises:
        FileError: a file cannot be written, or is the same file (links resolved) as an input or as
            another output.
    """
    read = {_identity(path): path for path in inputs if path is not None}
    seen: dict[Identity, str | Path] = {}
    for output in outputs:
        own = _identity(output)
        if own in read:
            raise FileError(
                f"this file is read{_also(output, read[own])}, and would be lost: "
                "give the output another name",
                output,
            )
        if own in seen:
            raise FileError(
                f"two outputs would be written to this one file{_also(output, seen[own])}: "
                "give each a name of its own",
                output,
            )
        check_target(output)
        seen[own] = output


def check_target(path: str | Path) -> None:
    """See early whether a file can be written, before hours are spent on what goes into it.

    A file without any permission to write is refused to the superuser too, whom the system would
    not hinder.

    Raises:
        FileError: it is a directory or read-only, or its directory does not exist or is not
            writable.
    """
    found = status(path)
    if is_stream(path):
        if found is None:
            raise FileError("cannot be written: it is not open", path)
        return
    if found is not None and stat.S_ISDIR(found.st_mode):
        raise FileError("this is a directory; give the name of a file to write", path)
    target = Path(os.path.realpath(path))
    if found is None or stat.S_ISREG(found.st_mode):
        if not target.parent.is_dir():
            raise FileError("cannot be written: its directory does not exist", path)
        if not os.access(target.parent, os.W_OK):
            raise FileError("cannot be written: its directory is not writable", path)
    if found is not None and not (_any_may_write(found) and os.access(path, os.W_OK)):
        raise FileError(
            "cannot be written: it is read-only; give another name or allow writing", path
        )


def status(path: str | Path) -> os.stat_result | None:
    """What the system says of a file, links followed; None where there is none.

    Raises:
        FileError: the system does not say.
    """
    try:
        return Path(path).stat()
    except (FileNotFoundError, NotADirectoryError):
        return None
    except (OSError, ValueError) as error:
        raise FileError(f"cannot be written: {reason(error)}", path) from None


def is_special(path: str | Path) -> bool:
    """Whether it is written to but not replaced: a device, a pipe, an open stream.

    Raises:
        FileError: the system does not say.
    """
    found = status(path)
    if found is None:
        return False
    mode = found.st_mode
    return not (stat.S_ISREG(mode) or stat.S_ISDIR(mode)) or is_stream(path)


def is_stream(path: str | Path) -> bool:
    """Whether it names an open stream of this process, such as `/dev/stdout`."""
    return descriptor(path) is not None


def descriptor(path: str | Path) -> int | None:
    """The number of the open stream that a path names, links followed; None if it names none."""
    streams = {os.path.realpath(f"/proc/{os.getpid()}/fd"), "/dev/fd"}
    here = os.fspath(path)
    for _ in range(MOST_LINKS):
        folder, name = os.path.split(here)
        folder = os.path.realpath(folder)
        if folder in streams:
            return int(name) if name.isdecimal() else None
        link = Path(folder, name)
        if not link.is_symlink():
            return None
        here = os.fspath(Path(folder) / link.readlink())
    return None


def same_file(one: str | Path, other: str | Path) -> bool:
    """Whether two names are of one file, or would be: links, hard ones too, are seen through."""
    return _identity(one) == _identity(other)


def _identity(path: str | Path) -> Identity:
    """Where a file is kept; where it would be if it is not there yet.

    What the system does not tell of can be neither read nor written: who tries it says why.
    """
    try:
        found = status(path)
    except FileError:
        return str(Path(path).absolute())
    return os.path.realpath(path) if found is None else (found.st_dev, found.st_ino)


def reason(error: OSError | ValueError) -> str:
    """Why the system refuses something, in words."""
    return (error.strerror if isinstance(error, OSError) else None) or str(error)


def _any_may_write(found: os.stat_result) -> bool:
    return bool(found.st_mode & (stat.S_IWUSR | stat.S_IWGRP | stat.S_IWOTH))


def _also(one: str | Path, other: str | Path) -> str:
    return "" if Path(one) == Path(other) else f" as {other}"
