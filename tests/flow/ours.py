"""The processes that a command has started, in whatever generation: all know its directory."""

from __future__ import annotations

import os
import time
from pathlib import Path


def processes(place: Path) -> list[int]:
    """Those whose `TMPDIR` is a directory; what waits to be buried does not count."""
    found = []
    for entry in Path("/proc").glob("[0-9]*/environ"):
        try:
            words = entry.read_bytes().split(b"\0")
        except OSError:
            # it has ended meanwhile, or is another user's
            continue
        if b"TMPDIR=" + os.fsencode(place) in words:
            found.append(int(entry.parent.name))
    return found


def all_gone(place: Path, seconds: float) -> bool:
    """Whether all of them have ended before so many seconds have passed."""
    end = time.monotonic() + seconds
    while processes(place):
        if time.monotonic() > end:
            return False
        time.sleep(0.02)
    return True
