"""Differences of large numbers, rounded once.

A number counts as the shortest decimal that reads as it, which is how files and people write
numbers: 1000000.1 less 1000000 is 0.1, not 0.09999999997671694.
"""

from __future__ import annotations

from collections.abc import Iterable
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

CANCELLING = 16.0
"""Numbers that are so many times larger than their difference lose digits in it."""

Exact = tuple[Fraction, ...]


def exact(values: Iterable[float]) -> Exact:
    """Numbers as the decimals that they were written as."""
    return tuple(Fraction(repr(float(x))) for x in values)


def binary(values: Iterable[float]) -> Exact:
    """Numbers as they are, to the last bit."""
    return tuple(Fraction(float(x)) for x in values)


def rounded(values: Iterable[Fraction]) -> NDArray[np.float64]:
    """The nearest floating-point numbers."""
    return np.array([float(x) for x in values])


def difference(a: Iterable[float], b: Iterable[float]) -> NDArray[np.float64]:
    """The difference of two vectors that were written as decimals, rounded once."""
    return rounded(x - y for x, y in zip(exact(a), exact(b), strict=True))


def seen_about(point: Iterable[float], origin: Iterable[float]) -> NDArray[np.float64]:
    """A point that was written as decimals, from an origin that was computed; rounded once."""
    return rounded(x - y for x, y in zip(exact(point), binary(origin), strict=True))


def careful_difference(a: NDArray[np.float64], b: NDArray[np.float64]) -> NDArray[np.float64]:
    """a - b, exactly rounded where a and b are so large that the plain difference loses digits."""
    plain = a - b
    lost = (np.abs(a) + np.abs(b)) > CANCELLING * np.abs(plain)
    return np.where(lost, difference(a, b), plain) if lost.any() else plain
