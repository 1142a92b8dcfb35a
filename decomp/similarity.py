"""Similarities of space: x -> scale * rotation @ x + offset."""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, radians, sin

import numpy as np
from numpy.typing import ArrayLike

from decomp.errors import InputError
from decomp.magnitude import check_length, check_magnitude
from decomp.vectors import Array, direction, frozen, number, positive, vector


@dataclass(frozen=True, eq=False)
class Similarity:
    """A rotation or reflection, a uniform scale, then a translation.

    Args:
        rotation: orthogonal matrix (3, 3), of determinant +1 or -1 (reflection).
        scale: factor above zero.
        offset: translation (3,).
    """

    rotation: Array
    scale: float
    offset: Array

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
    return Similarity(frozen(matrix), 1.0, frozen(pivot - matrix @ pivot))


def reflection(normal: ArrayLike, point: ArrayLike = (0, 0, 0)) -> Similarity:
    """Mirror in the plane through `point` with the given normal."""
    n = direction(normal, "mirror normal")
    p = vector(point, "mirror point")
    matrix = np.eye(3) - 2 * np.outer(n, n)
    return Similarity(frozen(matrix), 1.0, frozen(p - matrix @ p))


def scaling(factor: float, centre: ArrayLike = (0, 0, 0)) -> Similarity:
    """Scale uniformly by `factor` above zero, keeping `centre` in place."""
    f = positive(factor, "scale factor")
    c = vector(centre, "scale centre")
    return Similarity(IDENTITY.rotation, f, frozen((1 - f) * c))


def from_matrix(matrix: ArrayLike) -> Similarity:
    """Read a homogeneous matrix (4, 4) or (3, 4).

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
    # matrices in files carry about six digits, so an orthogonal one is off by 1e-6
    if np.abs(nearest - linear / scale).max() > 1e-5:
        raise InputError("transform is not a similarity: it shears or scales unevenly")
    return Similarity(frozen(nearest), scale, frozen(m[:3, 3]))


def _clean(value: float) -> float:
    """Round sines and cosines of multiples of 30 degrees that are 0, 1/2 or 1 to exactly that."""
    nearest = round(2 * value) / 2
    return nearest if abs(value - nearest) < 4e-16 else value
