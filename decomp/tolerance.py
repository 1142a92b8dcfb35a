"""The tolerances of the package, each a part of a model's or a region's size.

What is computed in closed form or by Newton's method is exact to rounding; what follows from it by
another way is less so, and what is extrapolated least. Things that count as one are told apart by
the tolerance of the way by which they were found.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

CONVERGED: Final = 1e-12
"""Newton's method has come to rest if it is off by less."""
TOUCHING: Final = 1e-11
"""Distances from a point of the skeleton to its sites are equal if they differ by less."""
TOLERANCE: Final = 1e-9
"""Lengths below count as zero.

It decides when two carriers coincide and when two points are one. Computed points are far
more exact than that: Newton's method brings them to about 1e-15 of the diagonal.
"""
ON_LOCUS: Final = 1e-7
"""A point nearer to a reflexive locus is on it: what it touches is known to half the digits."""
ONE_NODE: Final = 1e-7
"""Nodes nearer to each other, found along different seams, are one."""
SINGULAR: Final = 1e-7
"""Sine of the angle between two normals below which they count as parallel."""
TINY: Final = 1e-300
"""Divisors are no less: what is divided by it is 0 itself, or does not count."""
AT_END: Final = 1e-6
"""What is nearer to the end of a curve, which may be extrapolated, is at it."""


@dataclass(frozen=True)
class Tolerances:
    """The tolerances of a region, as lengths.

    Args:
        size: of the region: its diagonal.
    """

    size: float

    @property
    def converged(self) -> float:
        """`CONVERGED` of the size."""
        return CONVERGED * self.size

    @property
    def touching(self) -> float:
        """`TOUCHING` of the size."""
        return TOUCHING * self.size

    @property
    def same(self) -> float:
        """`TOLERANCE` of the size."""
        return TOLERANCE * self.size

    @property
    def on_locus(self) -> float:
        """`ON_LOCUS` of the size."""
        return ON_LOCUS * self.size

    @property
    def one_node(self) -> float:
        """`ONE_NODE` of the size."""
        return ONE_NODE * self.size

    @property
    def at_end(self) -> float:
        """`AT_END` of the size."""
        return AT_END * self.size
