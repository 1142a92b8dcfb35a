"""Exact rational numbers, vectors and their lengths."""

from __future__ import annotations

from collections.abc import Iterable
from fractions import Fraction
from math import isfinite, isqrt, sqrt
from typing import Any, TypeAlias

import numpy as np

from decomp.errors import InputError
from decomp.vectors import Array

Vector: TypeAlias = tuple[Fraction, Fraction, Fraction]


def exact(value: Any, what: str = "a number") -> Fraction:
    """Return a number exactly: floats by their binary value, strings such as "1/3" as written.

    Raises:
        InputError: not a finite number; the message names `what`.
    """
    try:
        if isinstance(value, (float, np.floating)) and not isfinite(value):
            raise ValueError
        if isinstance(value, np.generic):
            value = value.item()
        return Fraction(value)
    except (TypeError, ValueError):
        raise InputError(f"{what} must be a finite number, got {value!r}") from None


def exact_vector(values: Iterable[Any], what: str) -> Vector:
    """Return three numbers exactly.

    Raises:
        InputError: not three finite numbers.
    """
    numbers = [exact(value, what) for value in values]
    if len(numbers) != 3:
        raise InputError(f"{what} must be three numbers, got {len(numbers)}")
    return (numbers[0], numbers[1], numbers[2])


def exact_direction(values: Iterable[Any], what: str) -> Vector:
    """Return three numbers exactly, not all of them zero; the length is left as it is.

    Raises:
        InputError: not three finite numbers, or all of them zero.
    """
    vector = exact_vector(values, what)
    if not any(vector):
        raise InputError(f"{what} must not be the zero vector")
    return vector


def root(value: Fraction) -> Fraction:
    """The square root of a number >= 0: exact if it is rational, else the nearest float."""
    top, bottom = isqrt(value.numerator), isqrt(value.denominator)
    if top * top == value.numerator and bottom * bottom == value.denominator:
        return Fraction(top, bottom)
    return Fraction(sqrt(value))


def inner(a: Vector, b: Vector) -> Fraction:
    """Inner product."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a: Vector, b: Vector) -> Vector:
    """Cross product."""
    return (
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    )


def minus(a: Vector, b: Vector) -> Vector:
    """a - b."""
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def moved(a: Vector, by: Fraction, b: Vector) -> Vector:
    """a + by b."""
    return (a[0] + by * b[0], a[1] + by * b[1], a[2] + by * b[2])


def length(a: Vector) -> Fraction:
    """Euclidean length: exact if it is rational, else the nearest float."""
    return root(inner(a, a))


def floats(a: Vector) -> Array:
    """A vector as floats (3,)."""
    return np.array([float(x) for x in a])


def unit(a: Vector) -> Array:
    """A vector, not zero, as floats (3,) of unit length."""
    scale = max(abs(x) for x in a)
    scaled = floats((a[0] / scale, a[1] / scale, a[2] / scale))
    return np.asarray(scaled / np.linalg.norm(scaled))
