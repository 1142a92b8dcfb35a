"""Points of seams, parts of them, and how they end."""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import Enum

from decomp.vectors import Array


class SeamEnd(Enum):
    """How a seam ends.

    At a junction, where another site is as near; at a split, where sites that were equally near
    part tangentially or others join them; at a fin, where two of its contacts run together and so
    the sheet between them ends; at the boundary, where its radius is zero; or in its own beginning.
    """

    JUNCTION = "junction"
    SPLIT = "split"
    FIN = "fin"
    BOUNDARY = "boundary"
    CLOSED = "closed"


@dataclass(frozen=True, eq=False)
class State:
    """A point of a seam.

    Args:
        point: (3,).
        radius: common distance from the sites.
        sites: the site of each contact.
        feet: (m, 3).
        tangent: unit vector along the seam, in the sense of travel.
        slope: change of the radius along it.
    """

    point: Array
    radius: float
    sites: tuple[int, ...]
    feet: Array
    tangent: Array
    slope: float

    def turned(self) -> State:
        """The same point, travelling the other way."""
        return replace(self, tangent=-self.tangent, slope=-self.slope)


@dataclass(frozen=True, eq=False)
class Run:
    """Points of a seam with constant sites.

    Args:
        sites: the site of each contact.
        points: (n, 3).
        radius: (n,).
        feet: (n, m, 3).
    """

    sites: tuple[int, ...]
    points: Array
    radius: Array
    feet: Array


@dataclass(frozen=True, eq=False)
class Traced:
    """A seam as it was traced.

    Args:
        runs: its parts in order; where a foot passes to another site the point at the end of one
            run is the first of the next.
        last: its last point.
        end: how it ends.
        intruder: the site that ends it at a junction, -1 otherwise.
        foot: of the intruder.
    """

    runs: tuple[Run, ...]
    last: State
    end: SeamEnd
    intruder: int
    foot: Array
