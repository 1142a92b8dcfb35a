"""What the suffix of a file's name says."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from decomp.errors import InputError
from decomp.files.targets import is_special
from decomp.paths import path_of


def known_suffix(path: str | Path, suffixes: Sequence[str], what: str) -> str:
    """The suffix of a path, in lower case.

    Devices, pipes and open streams (`/dev/stdout`) need none, and are given the first.

    Args:
        path: of a file to write.
        suffixes: that are known.
        what: is to be written, in the plural.

    Raises:
        InputError: it is none of `suffixes`.
    """
    suffix = path_of(path, "the file to write").suffix.lower()
    if not suffix and is_special(path):
        return suffixes[0]
    if suffix not in suffixes:
        said = f"{suffix!r} is unknown" if suffix else "there is none"
        raise InputError(f"{path}: {said} as a suffix for {what}; use {', '.join(suffixes)}")
    return suffix
