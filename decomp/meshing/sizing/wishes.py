"""Lengths wanted at points and in places, joined into one field, and why.

A wish is a length at a point. Away from it lengths may grow by a fixed slope, and the least of all
that follows counts, so that neighbouring tetrahedra never differ much. Each has a reason, which
the report tells where it decides.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree  # type: ignore[import-untyped]

from decomp.meshes.reasons import Reason
from decomp.vectors import Array, Ints

SLOPE = 0.35
"""How much longer edges may get for each unit of way."""
CLASS_STEP = 1.25
"""Wishes are joined in classes of lengths that differ by this factor."""

Lengths = Callable[[Array], Array]
"""Points (k, 3) -> lengths (k,)."""


UNKNOWN = Reason("", True)


@dataclass(frozen=True, eq=False)
class Wishes:
    """Lengths (n,) wanted at points (n, 3).

    Args:
        points, lengths: of the wishes.
        reason: (n,) which of `reasons` each has.
        reasons: first those of the wishes, last one for each of `more`.
        more: lengths wanted everywhere.
    """

    points: Array
    lengths: Array
    reason: Ints
    reasons: tuple[Reason, ...]
    more: tuple[Lengths, ...] = ()

    def at(self, places: Array) -> Array:
        """The field (k,) at places (k, 3): the least of all wishes, grown with the distance."""
        return self.why(places)[0]

    def why(self, places: Array) -> tuple[Array, Ints]:
        """The field (k,) at places (k, 3), and which of `reasons` decides there (k,)."""
        found = np.full(len(places), np.inf)
        which: Ints = np.zeros(len(places), dtype=np.int64)
        least = float(self.lengths.min())
        classes = np.floor(np.log(self.lengths / least) / np.log(CLASS_STEP)).astype(np.int64)
        for number in np.unique(classes).tolist():
            rows = np.flatnonzero(classes == number)
            gap, nearest = cKDTree(self.points[rows]).query(places)
            lengths = least * CLASS_STEP**number + SLOPE * gap
            shorter = lengths < found
            found[shorter] = lengths[shorter]
            which[shorter] = self.reason[rows[nearest[shorter]]]
        first = len(self.reasons) - len(self.more)
        for number, each in enumerate(self.more):
            lengths = each(places)
            shorter = lengths < found
            found[shorter], which[shorter] = lengths[shorter], first + number
        return found, which


Wish = tuple[Array, Array, "Reason | tuple[Ints, tuple[Reason, ...]]"]
"""Points (n, 3), lengths (n,), and one reason for all, or which (n,) of several each has."""


def joined(wishes: Iterable[Wish], more: Iterable[tuple[Lengths, Reason]] = ()) -> Wishes:
    """Wishes with one list of reasons."""
    known: dict[Reason, int] = {}
    points, lengths, reason = [], [], []
    for some, own, why in wishes:
        which, reasons = (
            (np.zeros(len(some), dtype=np.int64), (why,)) if isinstance(why, Reason) else why
        )
        numbers = np.array([known.setdefault(each, len(known)) for each in reasons])
        points.append(some)
        lengths.append(own)
        reason.append(numbers[which])
    everywhere = tuple(more)
    return Wishes(
        np.concatenate(points),
        np.concatenate(lengths),
        np.concatenate(reason),
        (*known, *(why for _, why in everywhere)),
        tuple(each for each, _ in everywhere),
    )


def shorter(one: Wishes, other: Wishes, places: Array) -> tuple[Array, Ints, tuple[Reason, ...]]:
    """The lesser lengths (k,) of two at places, which reason (k,) each has, and all reasons."""
    (first, why), (second, also) = one.why(places), other.why(places)
    reasons = tuple(dict.fromkeys((*one.reasons, *other.reasons)))
    number = {reason: k for k, reason in enumerate(reasons)}
    mine, theirs = (np.array([number[each] for each in w.reasons]) for w in (one, other))
    return np.minimum(first, second), np.where(second < first, theirs[also], mine[why]), reasons
