"""Lengths asked for at points, in balls, in boxes, and by a function of the place."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.interpolate import LinearNDInterpolator, NearestNDInterpolator  # type: ignore[import-untyped]

from decomp.errors import InputError
from decomp.meshing.sizing.wishes import SLOPE
from decomp.places import triple
from decomp.vectors import Array, norm, positive, vector

PLACE_DIGITS = 9
"""Of places in words: users look for what they wrote."""


@dataclass(frozen=True, eq=False)
class Place:
    """A ball, a point (radius 0) or a box in which edges are to be short.

    Args:
        low, high: (3,) corners of a box; both the centre of a ball.
        radius: of a ball.
        length: wanted there.
        what: it is, in words.
    """

    low: Array
    high: Array
    radius: float
    length: float
    what: str

    def lengths(self, points: Array, offset: Array) -> Array:
        """Lengths (n,) wanted at points (n, 3), which are counted from `offset`."""
        return np.asarray(self.length + SLOPE * self.away(points, offset))

    def away(self, points: Array, offset: Array) -> Array:
        """How far (n,) such points are from it."""
        here = points + offset
        beyond = np.maximum(self.low - here, 0) + np.maximum(here - self.high, 0)
        return np.asarray(np.maximum(norm(beyond) - self.radius, 0))


def places_of(given: Any) -> tuple[Place, ...]:
    """Places from what users write.

    Args:
        given: a list of (point, length), (centre, radius, length) and (corner, corner, length).

    Raises:
        InputError: it is something else; says which entry.
    """
    if given is None:
        return ()
    if isinstance(given, str) or not isinstance(given, Sequence):
        raise InputError(f"size_at must be a list of places, got {given!r}")
    return tuple(_place(each, f"entry {k} of size_at") for k, each in enumerate(given, 1))


def _place(given: Any, where: str) -> Place:
    if isinstance(given, str) or not isinstance(given, Sequence) or len(given) not in (2, 3):
        raise InputError(
            f"{where} must be (point, length), (centre, radius, length) or "
            f"(corner, corner, length), got {given!r}"
        )
    first, length = vector(given[0], f"the place of {where}"), positive(given[-1], where)
    if len(given) == 2:
        return Place(first, first, 0.0, length, f"the point {triple(first, PLACE_DIGITS)}")
    if np.ndim(given[1]) == 0:
        radius = positive(given[1], f"the radius of {where}")
        return Place(first, first, radius, length, f"the ball about {triple(first, PLACE_DIGITS)}")
    other = vector(given[1], f"the other corner of {where}")
    low, high = np.minimum(first, other), np.maximum(first, other)
    return Place(
        low,
        high,
        0.0,
        length,
        f"the box from {triple(low, PLACE_DIGITS)} to {triple(high, PLACE_DIGITS)}",
    )


def field_of(given: Any) -> SizeFunction | None:
    """A function of the place from what users give: a function, or lengths at points.

    Between points lengths are linear on their Delaunay mesh; beyond, those of the nearest count.

    Raises:
        InputError: it is something else.
    """
    if given is None:
        return None
    if callable(given):
        return SizeFunction(given)
    if isinstance(given, Sequence) and not isinstance(given, str) and len(given) == 2:
        points, lengths = (np.asarray(each, dtype=np.float64) for each in given)
        if points.ndim == 2 and points.shape[1] == 3 and lengths.shape == (len(points),):
            return SizeFunction(_Interpolated(points, lengths))
    raise InputError(
        "size_field must be a function of points (n, 3) that gives lengths (n,), or a pair of "
        f"points and lengths, got {type(given).__name__}"
    )


@dataclass(frozen=True, eq=False)
class SizeFunction:
    """A user's function, whose values are looked at."""

    function: Any

    def __call__(self, points: Array) -> Array:
        """Lengths (n,) at points (n, 3) of the model.

        Raises:
            InputError: the function gives something else.
        """
        found = self._values(points)
        wrong = np.flatnonzero(~(found > 0))
        if len(wrong):
            raise InputError(
                f"size_field must be above 0, but is {found[wrong[0]]:g} at "
                f"{triple(points[wrong[0]])}"
            )
        return found

    def anywhere(self, points: Array) -> Array:
        """The same at any points: outside the model there need be no lengths."""
        found = self._values(points)
        return np.where(found > 0, found, np.inf)

    def _values(self, points: Array) -> Array:
        found = np.asarray(self.function(points), dtype=np.float64)
        if found.shape != (len(points),):
            raise InputError(
                f"size_field must give a length for each of {len(points)} points, got an array of "
                f"shape {found.shape}"
            )
        return found


class _Interpolated:
    """Lengths (n,) at points (n, 3) in between."""

    def __init__(self, points: Array, lengths: Array) -> None:
        self._nearest = NearestNDInterpolator(points, lengths)
        flat = np.linalg.matrix_rank(points - points.mean(axis=0)) < 3
        self._between = None if flat else LinearNDInterpolator(points, lengths)

    def __call__(self, points: Array) -> Array:
        nearest = self._nearest(points)
        if self._between is None:
            return np.asarray(nearest)
        found = self._between(points)
        return np.asarray(np.where(np.isnan(found), nearest, found))
