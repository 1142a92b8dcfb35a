"""What a graph of seams is made of."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from decomp.skeletons.seams.leaving.local import SeamRay
from decomp.vectors import Array, norm


@dataclass(frozen=True, eq=False)
class Node:
    """A junction, or a vertex of the solid from which a seam leaves.

    Args:
        point: (3,).
        radius: distance to the boundary, 0 at a vertex.
        sites: for each contact all sites that share its foot.
        feet: (m, 3), of the contacts.
        rays: the seams that leave it; their contacts are indices into `sites`.
    """

    point: Array
    radius: float
    sites: tuple[tuple[int, ...], ...]
    feet: Array
    rays: tuple[SeamRay, ...]


@dataclass(frozen=True, eq=False)
class Piece:
    """A part of a seam with constant sites.

    Args:
        sites: the site of each contact.
        start, end: indices of its first and last point, both its own.
    """

    sites: tuple[int, ...]
    start: int
    end: int


@dataclass(frozen=True, eq=False)
class SeamRun:
    """The points (n, 3) of a part of a seam with constant sites, and their feet (n, m, 3)."""

    sites: tuple[int, ...]
    points: Array
    feet: Array


@dataclass(frozen=True, eq=False)
class Seam:
    """A curve of points with three or more contacts.

    Where a foot crosses an edge its site changes (a trim). The point there, at which the foot is on
    the edge to rounding, stands twice, first with the old sites and then with the new.

    Args:
        points: (n, 3), exact to rounding; a closed seam does not repeat its first point.
        radius: (n,).
        sites: the site of each contact at every point.
        feet: (n, m, 3), of the contacts in the same order.
        ends: the nodes where it begins and ends, None if it is closed.
    """

    points: Array
    radius: Array
    sites: tuple[tuple[int, ...], ...]
    feet: Array
    ends: tuple[int, int] | None

    @property
    def length(self) -> float:
        """Length of the polyline."""
        closed = self.points if self.ends else np.concatenate([self.points, self.points[:1]])
        return float(norm(np.diff(closed, axis=0)).sum())

    @property
    def switches(self) -> tuple[int, ...]:
        """Indices k at which the sites change: points k - 1 and k coincide.

        A closed seam has 0 among them if its sites change between its last and its first point.
        """
        first = 1 if self.ends else 0
        return tuple(
            k for k in range(first, len(self.points)) if self.sites[k] != self.sites[k - 1]
        )

    @property
    def pieces(self) -> tuple[Piece, ...]:
        """Its maximal parts with constant sites.

        Those of a closed seam with switches start at the first switch; indices from n on go round.
        """
        n, cuts = len(self.points), self.switches
        if self.ends is not None:
            starts = [0, *cuts]
            stops = [*(k - 1 for k in cuts), n - 1]
        elif cuts:
            starts = list(cuts)
            stops = [*(k - 1 for k in cuts[1:]), cuts[0] - 1 + n]
        else:
            starts, stops = [0], [n]
        return tuple(Piece(self.sites[a % n], a, b) for a, b in zip(starts, stops, strict=True))

    @property
    def runs(self) -> tuple[SeamRun, ...]:
        """The points of its pieces."""
        rows = [np.arange(piece.start, piece.end + 1) % len(self.points) for piece in self.pieces]
        return tuple(
            SeamRun(piece.sites, self.points[row], self.feet[row])
            for piece, row in zip(self.pieces, rows, strict=True)
        )


@dataclass(frozen=True, eq=False)
class SeamGraph:
    """Nodes and seams of one region."""

    nodes: tuple[Node, ...]
    seams: tuple[Seam, ...]
