"""Where pairs of carriers touch, so that curves of the one touch the other."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from decomp.curves import Intersection
from decomp.curves.base import Curve
from decomp.vectors import Array, Bools, norm


class Tangencies:
    """Curves along which pairs of carriers touch, and points at which they do.

    Args:
        reach: points this close to one of them are on it.
    """

    def __init__(self, reach: float) -> None:
        self._reach = reach
        self._curves: dict[tuple[int, int], list[Curve]] = {}
        self._points: dict[tuple[int, int], Array] = {}

    def add(self, i: int, j: int, found: Intersection) -> None:
        """Add what two carriers (i < j) have in common."""
        along = [piece.curve for piece in found.curves if piece.tangent]
        if along:
            self._curves[i, j] = along
        if len(found.contacts) or len(found.nodes):
            self._points[i, j] = np.concatenate([found.contacts, found.nodes])

    def at(self, carrier: int, others: Iterable[int], points: Array) -> Bools:
        """Whether a carrier touches any of some others at points (n, 3)."""
        result = np.zeros(len(points), dtype=np.bool_)
        for other in others:
            pair = (min(carrier, other), max(carrier, other))
            for curve in self._curves.get(pair, ()):
                result |= norm(curve.point(curve.parameter(points)) - points) <= self._reach
            for touch in self._points.get(pair, ()):
                result |= norm(points - touch) <= self._reach
        return result
