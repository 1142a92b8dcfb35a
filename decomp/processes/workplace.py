"""Temporary directories in which child processes work, and the removal of those left behind.

Who makes one holds a lock on it, which the system lets go when its holder ends in whatever way. So
a directory whose lock can be had is nobody's: no process of the same number hides it, and none is
removed whose owner lives, be it in another container.
"""

from __future__ import annotations

import os
import re
import shutil
import stat
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from decomp.errors import FileError
from decomp.files.targets import reason

ROOM = "set TMPDIR to a directory with room"
ENDING = "[a-z0-9_]{8}"
"""What `tempfile` puts after a prefix: no user's own directory is called so."""


@contextmanager
def workplace(name: str) -> Iterator[Path]:
    """A new directory, removed in the end; if this process is killed, by `swept` later.

    Args:
        name: of what works there.

    Raises:
        FileError: there is no temporary directory that can be written to.
    """
    place, lock = _locked(_prefix(name))
    try:
        yield place
    finally:
        # what cannot be removed now is left to `swept`
        shutil.rmtree(place, ignore_errors=True)
        if lock is not None:
            os.close(lock)


def swept(name: str) -> None:
    """Remove this user's directories whose owners have died, of all programs on this machine.

    Args:
        name: of what worked there.

    Raises:
        FileError: there is no temporary directory that can be written to.
    """
    if sys.platform == "win32":
        return
    prefix = _prefix(name)
    ours = re.compile(re.escape(prefix) + ENDING)
    for place in _temporary().glob(f"{prefix}*"):
        if ours.fullmatch(place.name):
            _sweep(place)


def _prefix(name: str) -> str:
    return f"decomp-{name}-"


def _temporary() -> Path:
    """The directory of temporary files.

    Where `TMPDIR` names one that cannot be used, Python would take another without a word.
    """
    named = os.environ.get("TMPDIR")
    if named:
        return Path(named)
    try:
        return Path(tempfile.gettempdir())
    except OSError as error:
        raise FileError(f"{error.strerror}; {ROOM}") from None


def _locked(prefix: str) -> tuple[Path, int | None]:
    """A new directory and the descriptor that holds its lock.

    Between the directory's making and its locking somebody may sweep it, so another is made then.
    """
    while True:
        where = _temporary()
        try:
            place = Path(tempfile.mkdtemp(prefix=prefix, dir=where))
        except OSError as error:
            raise FileError(
                f"no temporary directory can be made here: {reason(error)}; {ROOM}", where
            ) from None
        if sys.platform == "win32":
            return place, None
        try:
            lock = os.open(place, os.O_RDONLY | os.O_DIRECTORY)
        except FileNotFoundError:
            continue
        if not _lock(lock, wait=True):
            # a file system without locks, on which nobody sweeps
            return place, lock
        try:
            if os.path.samestat(place.stat(), os.fstat(lock)):
                return place, lock
        except FileNotFoundError:
            pass
        os.close(lock)


def _sweep(place: Path) -> None:
    """Remove a directory if it is this user's and its lock can be had."""
    try:
        # a link is not followed
        lock = os.open(place, os.O_RDONLY | os.O_DIRECTORY | os.O_NOFOLLOW)
    except OSError:
        # another one has swept it, or it is another user's, or no directory
        return
    try:
        found = os.fstat(lock)
        ours = stat.S_ISDIR(found.st_mode) and found.st_uid == os.getuid()
        if ours and _lock(lock, wait=False):
            # what a dying child still writes is left to the next time
            shutil.rmtree(place, ignore_errors=True)
    finally:
        os.close(lock)


def _lock(descriptor: int, wait: bool) -> bool:
    """Whether a directory's lock could be had: not if another has it, or there are no locks."""
    import fcntl

    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | (0 if wait else fcntl.LOCK_NB))
    except OSError:
        return False
    return True
