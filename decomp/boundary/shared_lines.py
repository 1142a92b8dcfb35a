"""Straight lines on three carriers or more: every pair of them gives a part of the line.

Two carriers matter together only in a part of space, so each pair's line is clipped to a part. The
parts of one line that overlap are made one, from the first point of any to the last of any.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np

from decomp.curves.line import Line
from decomp.vectors import Array, norm


@dataclass(frozen=True, eq=False)
class StraightPart:
    """A part of a line.

    Args:
        line: with the part for its domain.
        carriers: those that hold it, ascending.
        nodes: points (n, 3) that cut it.
        cuts: parameters (k,) at which other carriers cut it, None if they are not known yet.
    """

    line: Line
    carriers: tuple[int, ...]
    nodes: Array
    cuts: Array | None


class SharedLines:
    """Collects parts of lines and joins those of one line that overlap.

    Args:
        tolerance: how far apart the ends of parts of one line may be from each other's line.
    """

    def __init__(self, tolerance: float) -> None:
        self._tolerance = tolerance
        self._parts: dict[int, StraightPart] = {}
        self._on: defaultdict[tuple[int, int], set[int]] = defaultdict(set)
        self._count = 0

    def waiting(self) -> Iterator[StraightPart]:
        """Hand out the parts one by one, those without known cuts first, until none is left."""
        while self._parts:
            unknown = [k for k, part in self._parts.items() if part.cuts is None]
            for number in unknown or list(self._parts):
                if number in self._parts:
                    yield self._taken(number)

    def add(self, part: StraightPart) -> None:
        """Add a part, joined with all that it overlaps."""
        grown = True
        while grown:  # what is longer may reach another part
            grown = False
            for number in sorted(set().union(*(self._on[k] for k in _pairs(part)))):
                joined = self._joined(self._parts[number], part)
                if joined is not None:
                    self._taken(number)
                    part, grown = joined, True
                    break
        self._parts[self._count] = part
        for pair in _pairs(part):
            self._on[pair].add(self._count)
        self._count += 1

    def _taken(self, number: int) -> StraightPart:
        part = self._parts.pop(number)
        for pair in _pairs(part):
            self._on[pair].discard(number)
        return part

    def _joined(self, one: StraightPart, other: StraightPart) -> StraightPart | None:
        """Both as one; None if they are not parts of one line, or do not overlap."""
        ends = other.line.point(np.array(other.line.domain))
        t = (ends - one.line.origin) @ one.line.direction
        low, high = one.line.domain
        if t.min() > high + self._tolerance or t.max() < low - self._tolerance:
            return None
        longer = replace(one.line, domain=(min(low, float(t.min())), max(high, float(t.max()))))
        away = longer.point(np.array(longer.domain)) - other.line.origin
        away = away - (away @ other.line.direction)[:, None] * other.line.direction
        if float(norm(away).max()) > self._tolerance:
            return None
        carriers = tuple(sorted({*one.carriers, *other.carriers}))
        return StraightPart(longer, carriers, np.concatenate([one.nodes, other.nodes]), None)


def _pairs(part: StraightPart) -> Iterator[tuple[int, int]]:
    return combinations(part.carriers, 2)
