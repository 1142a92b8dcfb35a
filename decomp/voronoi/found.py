"""What is found for a pair of sites: the surface between them as a shape, and its equation."""

from __future__ import annotations

from collections.abc import Iterable

from decomp.voronoi.exact import Vector
from decomp.voronoi.kinds import Kind
from decomp.voronoi.polynomial import Polynomial
from decomp.voronoi.shape import Shape

Found = tuple[Shape, Polynomial | None]
"""A surface and the polynomial that vanishes on it; None for an empty one."""


def both_of(found: Iterable[Found], centre: Vector) -> Found:
    """The union of two surfaces, or the one of them that is not empty.

    Args:
        found: both, of which one at most is empty.
        centre: what the union's polynomial counts from.
    """
    kept = [(part, equation) for part, equation in found if equation is not None]
    if len(kept) == 1:
        return kept[0]
    (one, first), (two, second) = kept
    whole = Shape(Kind.TWO_SURFACES, one.origin, one.axes, {}, (one, two))
    return whole, Polynomial.of(first.raw * second.raw, centre)
