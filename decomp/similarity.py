"""Similarities of space: x -> scale * rotation @ x + offset."""

from __future__ import annotations

from dataclasses import dataclass
from decimal import Decimal
from math import cos, radians, sin

import numpy as np
from numpy.typing import ArrayLike

from decomp.errors import InputError
from decomp.magnitude import check_length, check_magnitude
from decomp.vectors import Array, direction, frozen, number, positive, vector

FEW_DIGITS = 1e-5
"""Matrices in files carry about six digits, so that an orthogonal one is off by 1e-6."""
ALL_DIGITS = 1e-13
"""A matrix that is off by no more than this is a similarity to rounding."""
DIGITS = 6
"""Numbers of so many significant digits were rounded to them; shorter ones are exact."""
LAST_DIGIT = 4e-16
"""A sine or cosine nearer to a half or whole number is that number."""


@dataclass(frozen=True, eq=False)
class Similarity:
    """A rotation or reflection, a uniform scale, then a translation.

    Args:
        rotation: orthogonal matrix (3, 3), of determinant +1 or -1 (reflection).
        scale: factor above zero.
        offset: translation (3,).
        doubt: how far an image may be off, in units of its distance from the origin, as the numbers
            were given with few digits.
        shift: how far all images may be off, for the same reason. Neither is handed on by `after`.
        fixed: a point (3,) that stays where it is, if `offset` was computed from one: far from the
            origin it tells the offset more exactly. Not handed on by `after` either.
    """

    rotation: Array
    scale: float
    offset: Array
    doubt: float = 0.0
    shift: float = 0.0
    fixed: Array | None = None

    def points(self, p: Array) -> Array:
        """Images of points (..., 3)."""
        return np.asarray(self.scale * (p @ self.rotation.T) + self.offset)

    def directions(self, v: Array) -> Array:
        """Images of unit vectors (..., 3), again of unit length."""
        return np.asarray(v @ self.rotation.T)

    def after(self, first: Similarity) -> Similarity:
        """The similarity that applies `first`, then this one."""
        return Similarity(
            frozen(self.rotation @ first.rotation),
            self.scale * first.scale,
            frozen(self.points(first.offset)),
        )

    def matrix(self) -> Array:
        """The homogeneous matrix (4, 4)."""
        result = np.eye(4)
        result[:3, :3] = self.scale * self.rotation
        result[:3, 3] = self.offset
        return result


IDENTITY = Similarity(frozen(np.eye(3)), 1.0, frozen(np.zeros(3)))


def translation(offset: ArrayLike) -> Similarity:
    """Move by `offset`."""
    return Similarity(IDENTITY.rotation, 1.0, vector(offset, "translation"))


def rotation(axis: ArrayLike, degrees: float, centre: ArrayLike = (0, 0, 0)) -> Similarity:
    """Turn by `degrees` about the axis through `centre` (right-hand rule)."""
    k = direction(axis, "rotation axis")
    pivot = vector(centre, "rotation centre")
    angle = radians(number(degrees, "rotation angle"))
    s, c = _clean(sin(angle)), _clean(cos(angle))
    cross = np.array([[0, -k[2], k[1]], [k[2], 0, -k[0]], [-k[1], k[0], 0]])
    matrix = c * np.eye(3) + s * cross + (1 - c) * np.outer(k, k)
    return Similarity(frozen(matrix), 1.0, frozen(pivot - matrix @ pivot), fixed=pivot)


def reflection(normal: ArrayLike, point: ArrayLike = (0, 0, 0)) -> Similarity:
    """Mirror in the plane through `point` with the given normal."""
    n = direction(normal, "mirror normal")
    p = vector(point, "mirror point")
    matrix = np.eye(3) - 2 * np.outer(n, n)
    return Similarity(frozen(matrix), 1.0, frozen(p - matrix @ p), fixed=p)


def scaling(factor: float, centre: ArrayLike = (0, 0, 0)) -> Similarity:
    """Scale uniformly by `factor` above zero, keeping `centre` in place."""
    f = positive(factor, "scale factor")
    c = vector(centre, "scale centre")
    return Similarity(IDENTITY.rotation, f, frozen((1 - f) * c), fixed=c)


def from_matrix(matrix: ArrayLike) -> Similarity:
    """Read a homogeneous matrix (4, 4) or (3, 4).

    Files give matrices with six digits or so, with which a rotation is none. It is made one again,
    its scale is the shortest number that those digits can stand for, and what they leave open is
    kept as `doubt` and `shift`. A matrix that is a similarity to rounding leaves nothing open.

    Raises:
        InputError: not a similarity: shear, non-uniform scale, zero scale or projection.
    """
    try:
        m = np.array(matrix, dtype=np.float64)
    except OverflowError:
        raise InputError("transform has an entry that is too large to compute with") from None
    except (TypeError, ValueError):
        raise InputError(f"transform must be a 4 x 4 matrix, got {matrix!r}") from None
    if m.shape not in ((4, 4), (3, 4)):
        raise InputError(f"transform must be a 4 x 4 matrix, got shape {m.shape}")
    check_magnitude(m, "transform")
    if m.shape == (4, 4) and not np.array_equal(m[3], [0, 0, 0, 1]):
        raise InputError("transform is a projection: its last row is not 0 0 0 1")
    linear = m[:3, :3]
    scale = float(abs(np.linalg.det(linear))) ** (1 / 3)
    if scale == 0.0:
        raise InputError("transform flattens space: its determinant is 0")
    check_length(scale, "scale factor of the transform")
    u, _, vt = np.linalg.svd(linear / scale)
    nearest = u @ vt
    miss = float(np.abs(nearest - linear / scale).max())
    if miss > FEW_DIGITS:
        raise InputError("transform is not a similarity: it shears or scales unevenly")
    if miss <= ALL_DIGITS:
        return Similarity(frozen(nearest), scale, frozen(m[:3, 3]))
    shortest = _shortest(scale, max(3 * miss, _half_digit(linear)) * scale)
    doubt = max(miss, _half_digit(linear) / scale)
    shift = _half_digit(m[:3, 3])
    return Similarity(frozen(nearest), shortest, frozen(m[:3, 3]), doubt, shift)


def _half_digit(values: Array) -> float:
    """Half a unit of the last decimal place of numbers that are given to six digits or more.

    Of fewer digits they are taken as exact. 0 if all are.
    """
    most = 0.0
    for value in np.asarray(values).ravel():
        _, digits, exponent = Decimal(repr(float(value))).normalize().as_tuple()
        if len(digits) >= DIGITS and isinstance(exponent, int):
            most = max(most, 0.5 * 10.0**exponent)
    return most


def _shortest(value: float, error: float) -> float:
    """The number of fewest digits within an error of a value."""
    for digits in range(1, 17):
        rounded = float(f"{value:.{digits}g}")
        if abs(rounded - value) <= error:
            return rounded
    return value


def _clean(value: float) -> float:
    """Round sines and cosines of multiples of 30 degrees that are 0, 1/2 or 1 to exactly that."""
    nearest = round(2 * value) / 2
    return nearest if abs(value - nearest) < LAST_DIGIT else value
