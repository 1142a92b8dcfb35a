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


def survivors(place: Path, seconds: float) -> list[str]:
    """The command lines of those that have not ended before so many seconds have passed."""
    end = time.monotonic() + seconds
    while found := processes(place):
        if time.monotonic() > end:
            return [_command(each) for each in found]
        time.sleep(0.02)
    return []


def _command(process: int) -> str:
    try:
        return Path(f"/proc/{process}/cmdline").read_text().replace("\0", " ")
    except OSError:
        return "ended just now"
