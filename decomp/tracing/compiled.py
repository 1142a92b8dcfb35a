"""How the kernels of this package are compiled: like those of `decomp.sites`, which they call.

Cached machine code must also be renewed when a file of this package changes.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any, TypeVar

from decomp.sites import compiled as base

F = TypeVar("F", bound=Callable[..., Any])


def scalar(function: F) -> F:
    """A kernel that makes no arrays, see `decomp.sites.compiled.scalar`."""
    return _stamped(base.scalar(function))


def inlined(function: F) -> F:
    """A scalar kernel that is compiled into its callers."""
    return _stamped(base.inlined(function))


def _stamped(function: F) -> F:
    with suppress(AttributeError):
        function._cache._cache_file._source_stamp = _STAMP  # type: ignore[attr-defined]
    return function


def _stamp() -> tuple[float, int]:
    """Latest change and total size of the files with kernels."""
    here = Path(__file__).parent
    stats = [
        file.stat() for folder in (here, here.parent / "sites") for file in folder.glob("*.py")
    ]
    return max(s.st_mtime for s in stats), sum(s.st_size for s in stats)


_STAMP = _stamp()
