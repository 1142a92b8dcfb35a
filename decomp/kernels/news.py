"""Who is told that kernels are being compiled, which takes long.

It does without numba, which is slow to load.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager

_listeners: list[Callable[[], None]] = []


def compiling() -> None:
    """A kernel is not kept and has to be compiled."""
    while _listeners:
        _listeners.pop()()


@contextmanager
def told_of_compiling(listener: Callable[[], None]) -> Iterator[None]:
    """Have a function called before the first kernel is compiled, if any is."""
    _listeners.append(listener)
    try:
        yield
    finally:
        if listener in _listeners:
            _listeners.remove(listener)
