"""A disk that is soon full."""

from __future__ import annotations

import shutil
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest


@contextmanager
def small_disk(place: Path, kilobytes: int) -> Iterator[Path]:
    """A file system of a few kilobytes in a directory, which is made; skips where that cannot be.

    Only the superuser of Linux can have one.
    """
    place.mkdir()
    words = ["-t", "tmpfs", "-o", f"size={kilobytes}k", "none", str(place)]
    mount = shutil.which("mount")
    if (
        mount is None
        or subprocess.run([mount, *words], capture_output=True, check=False).returncode
    ):
        pytest.skip("no file system can be mounted here")
    try:
        yield place
    finally:
        subprocess.run(["umount", "-l", str(place)], check=True)
