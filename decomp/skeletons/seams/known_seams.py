"""Whether points lie on seams that are already known."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass

import numpy as np

from decomp.skeletons.balls.equidistance import balanced
from decomp.skeletons.balls.supports import SupportTable
from decomp.skeletons.seams.seam_graph_model import Seam
from decomp.tolerance import TINY
from decomp.vectors import Array, Bools, Ints, dot, norm

ASIDE = 0.2
"""How far a seam may stand out from its chord, as a part of the chord."""
NEAR = 1e-5
"""Points nearer to a seam than this part of the size may lie on it."""
FEET = 1e-2
"""Feet nearer to each other than this part of the radius may be the same."""


class KnownSeams:
    """Seams that can be looked up by the points on them.

    Args:
        table: supports of their sites.
        size: of the region.
        seams: the first ones, by their numbers.
    """

    def __init__(self, table: SupportTable, size: float, seams: Sequence[Seam] = ()) -> None:
        self._table, self._size = table, size
        self._seams: dict[int, Seam] = {}
        self._lines: dict[int, _Line] = {}
        self._boxes = np.full((6, 64), np.nan)
        for number, seam in enumerate(seams):
            self.add(number, seam)

    def __contains__(self, number: int) -> bool:
        return number in self._seams

    @property
    def seams(self) -> tuple[Seam, ...]:
        """All of them."""
        return tuple(self._seams.values())

    def add(self, number: int, seam: Seam) -> None:
        """Add a seam under a new number."""
        self._seams[number] = seam
        self._lines[number] = line = _line(seam)
        while number >= self._boxes.shape[1]:
            self._boxes = np.hstack([self._boxes, np.full_like(self._boxes, np.nan)])
        room = ASIDE * line.chord.max() + NEAR * self._size
        self._boxes[:, number] = (
            *(line.points.min(axis=0) - room),
            *(line.points.max(axis=0) + room),
        )

    def remove(self, number: int) -> None:
        """Forget a seam."""
        del self._seams[number], self._lines[number]
        self._boxes[:, number] = np.nan

    def through(self, point: Array) -> list[int]:
        """The numbers of the seams that pass a point (3,)."""
        none = np.empty((1, 0, 3))
        return [k for k in self._about(point) if self._on([(0, k)], point[None], none)[0]]

    def near(self, point: Array, reach: float) -> bool:
        """Whether a chord of a seam passes a point (3,) within a reach."""
        for line in self._lines.values():
            _, gap = line.beside(point)
            if bool((gap <= reach + ASIDE * line.chord).any()):
                return True
        return False

    def hold(self, points: Array, feet: Array, among: Collection[int] | None = None) -> Bools:
        """Whether points (k, 3) with some feet (k, j, 3) lie on a seam (with a given number)."""
        numbers = list(self._seams if among is None else among)
        if len(numbers) < len(points):
            pairs = [(k, n) for n in numbers for k in self._beside(n, points)]
        else:
            allowed = set(numbers)
            pairs = [(k, n) for k, p in enumerate(points) for n in self._about(p) if n in allowed]
        return self._on(pairs, points, feet)

    def _beside(self, number: int, points: Array) -> list[int]:
        """Which of some points (k, 3) lie in a seam's box."""
        low, high = self._boxes[:3, number], self._boxes[3:, number]
        return [int(k) for k in np.flatnonzero(((low <= points) & (points <= high)).all(axis=1))]

    def _about(self, point: Array) -> list[int]:
        """The numbers of the seams whose boxes hold a point (3,)."""
        numbers: Ints = np.arange(self._boxes.shape[1])
        for low, high, at in zip(self._boxes[:3], self._boxes[3:], point, strict=True):
            numbers = numbers[(low[numbers] <= at) & (at <= high[numbers])]
        return [int(k) for k in numbers]

    def _on(self, pairs: Sequence[tuple[int, int]], points: Array, feet: Array) -> Bools:
        """Which points (k, 3) lie on a seam; asked for pairs of a point and a seam only.

        Chords near a point are looked for first; then it is put onto the seam exactly, whose feet
        there must be among its own.
        """
        known = np.zeros(len(points), dtype=np.bool_)
        tasks: dict[int, list[tuple[int, tuple[int, ...], Array]]] = {}
        for k, number in pairs:
            seam, line = self._seams[number], self._lines[number]
            along, gap = line.beside(points[k])
            close = np.flatnonzero(gap <= ASIDE * line.chord + NEAR * self._size)
            for i in close[np.argsort(gap[close])][:2]:
                sites = seam.sites[int(i)]
                spot = line.feet[i] + along[i] * (line.feet[i + 1] - line.feet[i])
                tasks.setdefault(len(sites), []).append((k, sites, spot))
        for listed in tasks.values():
            rows: Ints = np.array([k for k, _, _ in listed])
            which = np.array([sites for _, sites, _ in listed])
            spots = np.array([spot for _, _, spot in listed])
            found = balanced(self._table, self._size, which, points[rows], spots)
            apart = norm(feet[rows][:, :, None] - found.feet[:, None]).min(axis=2)
            near = NEAR * self._size
            same = (apart <= FEET * found.radius[:, None] + near).all(axis=1)
            same &= found.converged & (norm(found.points - points[rows]) <= near)
            known[rows[same]] = True
        return known


@dataclass(frozen=True, eq=False)
class _Line:
    """The chords of a seam: their ends, feet there, differences, lengths and squares."""

    points: Array
    feet: Array
    way: Array
    chord: Array
    square: Array

    def beside(self, point: Array) -> tuple[Array, Array]:
        """The nearest places (k,) on the chords, from 0 to 1, and their distances from a point."""
        along = dot(point - self.points[:-1], self.way) / self.square
        along = np.minimum(np.maximum(along, 0.0), 1.0)
        return along, norm(point - self.points[:-1] - along[:, None] * self.way)


def _line(seam: Seam) -> _Line:
    points, feet = seam.points, seam.feet
    if seam.ends is None:
        points, feet = np.concatenate([points, points[:1]]), np.concatenate([feet, feet[:1]])
    way = np.diff(points, axis=0)
    square = dot(way, way)
    return _Line(points, feet, way, np.sqrt(square), np.maximum(square, TINY))
