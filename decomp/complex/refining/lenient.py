"""Elements that leave a point where it is where they cannot place it, instead of raising.

With these a complex is refined as far as that goes: an edge or triangle that its surface cannot be
followed at stays as it is, and whoever asked for it has to measure what has come of it.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from decomp.complex.many_elements import Elements, Together
from decomp.errors import GeometryError
from decomp.vectors import Array, Bools, Ints, norm


class LenientElements(Elements):
    """As `Elements`, but `place` and `normal` do not raise."""

    def place(self, numbers: Ints, points: Array) -> Array:
        """Points (k, 3) moved onto their elements; those that have no place there stay."""
        return self.attempt(numbers, points)[0]

    def gap(self, numbers: Ints, points: Array) -> Array:
        """How far (k,) each point is from where its element places it; infinite without a place."""
        placed, good = self.attempt(numbers, points)
        return np.where(good, norm(placed - points), np.inf)

    def normal(self, numbers: Ints, points: Array) -> Array:
        """Unit normals (k, 3) of the surfaces at points (k, 3) on them; zero where none."""
        found = self._each(numbers, points, self._normal_or_none, self._asked("normal"))
        return np.where(_finite(found)[:, None], found, 0.0)

    def attempt(self, numbers: Ints, points: Array) -> tuple[Array, Bools]:
        """Points (k, 3) moved onto their elements as far as they have a place, and whether (k,)."""
        placed = self._each(numbers, points, self._place_or_none, self._asked("place"))
        good = _finite(placed)
        return np.where(good[:, None], placed, points), good

    def _asked(self, what: str) -> list[Together]:
        return [getattr(family, what) for family in self._families]

    def _place_or_none(self, number: int, points: Array) -> Array:
        element = (self._surfaces + self._curves)[number]
        attempt = getattr(element, "try_place", None)
        if attempt is not None:
            placed, good = attempt(points)
            return np.where(good[:, None], placed, np.nan)
        return self._some(number, points, self._place_on)

    def _normal_or_none(self, number: int, points: Array) -> Array:
        return self._some(number, points, self._normal_of)

    def _some(self, number: int, points: Array, ask: Callable[[int, Array], Array]) -> Array:
        """Ask for all points, or for halves of them, down to those that fail."""
        try:
            return np.asarray(ask(number, points))
        except GeometryError:
            if len(points) == 1:
                return np.full((1, 3), np.nan)
        half = len(points) // 2
        return np.concatenate(
            [self._some(number, part, ask) for part in (points[:half], points[half:])]
        )


def _finite(points: Array) -> Bools:
    return np.asarray(np.isfinite(points).all(axis=1))
