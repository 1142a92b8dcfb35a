"""Paths that are given as arguments. The command line starts with it: it loads nothing heavy."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

from decomp.errors import InputError


def path_of(value: Any, what: str) -> Path:
    """Return `value` as a path.

    Raises:
        InputError: it is neither a text nor a path; the message names `what`.
    """
    if not isinstance(value, (str, os.PathLike)):
        raise InputError(f"{what} must be a path, got {value!r}")
    return value if isinstance(value, Path) else Path(value)
