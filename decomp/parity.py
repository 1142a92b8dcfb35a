"""On which side of its two sites a Voronoi surface lies."""

from __future__ import annotations

from enum import Enum


class Parity(Enum):
    """On which side of its two carriers a sheet lies.

    EVEN: inside both or outside both; ODD: inside one and outside the other.
    """

    EVEN = "even"
    ODD = "odd"

    @property
    def sign(self) -> int:
        """The e in s_f = e s_g for the signed distances s: +1 or -1."""
        return 1 if self is Parity.EVEN else -1
