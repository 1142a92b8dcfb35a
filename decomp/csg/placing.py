"""Where a node of the tree stands, about a point of its own near the model.

Far from the origin numbers have no digits left for what is small. So a move is kept as
s R (x - pivot) + image, with a pivot that comes to lie near the model's centre: x - pivot and image
are as small as the model, and both are differences of large numbers, taken in exact arithmetic.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from math import floor, log2

import numpy as np

from decomp.exact import Exact, binary, exact, rounded
from decomp.places import FAR_SIZES
from decomp.similarity import IDENTITY, Similarity
from decomp.vectors import Array, frozen, norm


@dataclass(frozen=True, eq=False)
class Placing:
    """x -> `by` (x - pivot), in coordinates about the model's centre.

    Args:
        by: its offset is where the pivot comes to.
        pivot: (3,), None where the model stays at the origin, and `by` is all there is.
        grid: what pivots are multiples of.
    """

    by: Similarity
    pivot: Array | None = None
    grid: float = 0.0

    @property
    def offset(self) -> Array:
        """Of a whole model: where its coordinates are counted from (3,)."""
        return np.zeros(3) if self.pivot is None else self.pivot

    def after(self, first: Similarity) -> Placing:
        """The place of what is moved by `first`, then as this tells."""
        if self.pivot is None:
            return Placing(self.by.after(first))
        grid = self.grid / 2.0 ** floor(log2(first.scale))
        # what `first` takes to the pivot, roughly; what it does with it is had exactly
        back = first.rotation.T @ rounded(
            (p - o) / Fraction(first.scale)
            for p, o in zip(binary(self.pivot), _image(first, (Fraction(),) * 3), strict=True)
        )
        pivot = np.round(back / grid) * grid
        off = _image(first, binary(pivot))
        image = rounded(o - p for o, p in zip(off, binary(self.pivot), strict=True))
        inner = Similarity(first.rotation, first.scale, frozen(image))
        return Placing(self.by.after(inner), frozen(pivot), grid)


AT_ORIGIN = Placing(IDENTITY)
"""Of a model that is computed in its own coordinates."""


def placing_of(low: Array, high: Array) -> Placing:
    """The place of a model in a box with these corners (3,): about its centre if that is far away.

    The centre is rounded to a grid as wide as the box, so that its digits are few.
    """
    size, middle = float(norm(high - low)), (low + high) / 2
    if not float(norm(middle)) > FAR_SIZES * size:
        return AT_ORIGIN
    grid = _grid(size)
    return Placing(IDENTITY, frozen(np.round(middle / grid) * grid), grid)


def _grid(size: float) -> float:
    return float(2.0 ** floor(log2(size)))


def _image(by: Similarity, point: Exact) -> Exact:
    """The image of a point without rounding, but for that of the similarity's own numbers."""
    scale = Fraction(by.scale)
    if by.fixed is None:
        start, away = exact(by.offset), point
    else:
        start = exact(by.fixed)
        away = tuple(p - f for p, f in zip(point, start, strict=True))
    turned = (
        sum((Fraction(float(r)) * a for r, a in zip(row, away, strict=True)), Fraction())
        for row in by.rotation
    )
    return tuple(scale * t + s for t, s in zip(turned, start, strict=True))
