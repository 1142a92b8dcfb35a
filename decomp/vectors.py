"""Arrays of points and vectors: the few operations that every geometry file needs."""

from __future__ import annotations

from typing import Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from decomp.errors import InputError
from decomp.magnitude import check_length, check_magnitude

Array: TypeAlias = NDArray[np.float64]
Bools: TypeAlias = NDArray[np.bool_]
Ints: TypeAlias = NDArray[np.int64]


def frozen(values: ArrayLike) -> Array:
    """Return a read-only float copy of `values`."""
    array = np.array(values, dtype=np.float64)
    array.setflags(write=False)
    return array


def reals(values: ArrayLike) -> NDArray[Any]:
    """Return `values` as an array of real numbers.

    Raises:
        TypeError: they are texts, or True or False, of which numpy would make numbers.
        ValueError: their shape is uneven.
    """
    array = np.asarray(values)
    if array.dtype.kind not in "iufO":
        raise TypeError(f"{array.dtype} is no kind of real number")
    return array


def vector(values: ArrayLike, what: str) -> Array:
    """Return three finite numbers as a read-only vector.

    Raises:
        InputError: not three finite numbers, or too large ones; the message names `what`.
    """
    try:
        array = frozen(reals(values))
    except OverflowError:
        raise InputError(f"{what} is too large to compute with") from None
    except (TypeError, ValueError):
        raise InputError(f"{what} must be three numbers, got {values!r}") from None
    if array.shape != (3,):
        raise InputError(f"{what} must be three numbers, got {values!r}")
    check_magnitude(array, what)
    return array


def direction(values: ArrayLike, what: str) -> Array:
    """Return `values` scaled to unit length.

    Raises:
        InputError: not three finite numbers, or all of them zero, or too small or large.
    """
    array = vector(values, what)
    scale = float(np.abs(array).max())
    if scale == 0.0:
        raise InputError(f"{what} must not be the zero vector")
    check_length(scale, what)
    array = array / scale
    return frozen(array / np.linalg.norm(array))


def number(value: Any, what: str) -> float:
    """Return `value` as a finite float.

    Raises:
        InputError: not a finite number, or too large.
    """
    try:
        # no text, no True or False, of which Python would make numbers
        given = reals(value)
        if given.ndim:
            raise TypeError("these are several numbers")
        result = float(given)
    except (TypeError, ValueError):
        raise InputError(f"{what} must be a number, got {value!r}") from None
    except OverflowError:  # a whole number beyond double precision
        result = float("inf")
    check_magnitude(result, what)
    return result


def positive(value: Any, what: str) -> float:
    """Return `value` as a finite float above zero.

    Raises:
        InputError: not a finite number above zero, or too small or large.
    """
    result = number(value, what)
    if result <= 0.0:
        raise InputError(f"{what} must be positive, got {result:g}")
    check_length(result, what)
    return result


def dot(a: Array, b: Array) -> Array:
    """Inner products along the last axis."""
    return np.asarray(np.einsum("...i,...i->...", a, b))


def cross(a: Array, b: Array) -> Array:
    """Vector products along the last axis (faster than `np.cross` on few vectors)."""
    ax, ay, az = a[..., 0], a[..., 1], a[..., 2]
    bx, by, bz = b[..., 0], b[..., 1], b[..., 2]
    result = np.empty(np.broadcast_shapes(a.shape, b.shape))
    result[..., 0] = ay * bz - az * by
    result[..., 1] = az * bx - ax * bz
    result[..., 2] = ax * by - ay * bx
    return result


def norm(a: Array) -> Array:
    """Euclidean lengths along the last axis."""
    return np.sqrt(dot(a, a))


def perpendicular(axis: Array) -> Array:
    """Return a unit vector at right angles to the unit vector `axis`."""
    helper = np.zeros(3)
    helper[int(np.argmin(np.abs(axis)))] = 1.0
    side = cross(axis, helper)
    return np.asarray(side / np.linalg.norm(side))


def frame(axis: Array) -> tuple[Array, Array]:
    """Return unit vectors x, y such that (x, y, axis) is right-handed and orthonormal."""
    x = perpendicular(axis)
    return x, cross(axis, x)


ROWS_AT_ONCE = 4096


def nearest_rows(known: Array, points: Array) -> Ints:
    """For each of points (k, 3) the nearest of some known ones."""
    rows = np.empty(len(points), dtype=np.int64)
    for start in range(0, len(points), ROWS_AT_ONCE):
        block = points[start : start + ROWS_AT_ONCE]
        gap = ((block[:, None] - known[None]) ** 2).sum(axis=2)
        rows[start : start + ROWS_AT_ONCE] = np.argmin(gap, axis=1)
    return rows
