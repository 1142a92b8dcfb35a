"""How the kernels of this package are compiled: like those of `decomp.sites`, which they call.

Cached machine code must also be renewed when a file of this package changes.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

from decomp.kernels import compiled as base

F = TypeVar("F", bound=Callable[..., Any])


def scalar(function: F) -> F:
    """A kernel that makes no arrays, see `decomp.kernels.compiled.scalar`."""
    return _stamped(base.scalar(function))


def inner(function: F) -> F:
    """A scalar kernel that only kernels can call, see `decomp.kernels.compiled.inner`."""
    return _stamped(base.inner(function))


def inlined(function: F) -> F:
    """A scalar kernel that is compiled into its callers."""
    return _stamped(base.inlined(function))


def _stamped(function: F) -> F:
    here = Path(__file__).parent
    base.restamp(function, here, here.parent / "sites", here.parent / "kernels")
    return function
