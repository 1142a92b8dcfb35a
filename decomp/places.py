"""Points in messages, told where the user's own coordinates have them.

Models far from the origin are computed about a point of their own. Whatever is done with such a
model runs inside `seen_from`, so that messages need not know of it.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from math import ceil, floor, log10
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

DIGITS = 6
"""Significant digits of coordinates near the origin."""
MOST_DIGITS = 17
FAR_SIZES = 8.0
"""What is so many sizes away takes more digits."""

_frame: ContextVar[tuple[NDArray[np.float64], int, int] | None] = ContextVar("frame", default=None)


@contextmanager
def seen_from(offset: NDArray[np.float64], size: float) -> Iterator[None]:
    """Inside, `place` adds `offset` (3,), with digits enough to tell points of a model apart.

    Args:
        offset: where computing has its origin, in the user's coordinates.
        size: of the model.
    """
    if not offset.any():
        yield
        return
    digits = digits_of(float(abs(offset).max()), size)
    token = _frame.set((offset, digits, DIGITS - floor(log10(size))))
    try:
        yield
    finally:
        _frame.reset(token)


def digits_of(farthest: float, size: float, least: int = DIGITS) -> int:
    """How many digits coordinates need that `least` would be enough for near the origin.

    Args:
        farthest: the largest coordinate.
        size: of what is to be told apart.
        least: the digits near the origin.
    """
    more = ceil(log10(farthest / size)) if farthest > FAR_SIZES * size else 0
    return min(least + more, MOST_DIGITS)


def place(point: NDArray[np.float64]) -> str:
    """A point (3,) as text for messages, in the user's coordinates."""
    frame = _frame.get()
    if frame is None:
        return triple(point)
    offset, digits, decimals = frame
    return triple((point + offset).round(decimals), digits)


def in_users(point: NDArray[np.float64]) -> tuple[float, ...]:
    """A point (3,) in the user's coordinates."""
    frame = _frame.get()
    return tuple((point if frame is None else point + frame[0]).tolist())


def triple(values: NDArray[np.float64], digits: int = DIGITS) -> str:
    """A vector (3,) as text."""
    return "(" + ", ".join(f"{x + 0.0:.{digits}g}" for x in values) + ")"
