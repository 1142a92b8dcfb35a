"""Room in which compiled code puts the points of a seam whose sites stay the same."""

from __future__ import annotations

from decomp.skeletons.seams.steps.states import Run, State
from decomp.skeletons.seams.steps.stepping import track
from decomp.vectors import norm

SAME = 1e-10
"""Points nearer than this part of the size are one."""


class Stretch:
    """Rows of a track, each a point of a seam with given sites.

    Args:
        sites: the site of each contact.
        length: the number of rows.
        size: of the region.
    """

    def __init__(self, sites: tuple[int, ...], length: int, size: float) -> None:
        self.sites, self._size = sites, size
        self.track = track(sites, length, size)

    def put(self, row: int, state: State) -> None:
        """Put a point into a row."""
        m, room = len(self.sites), self.track
        room.points[row], room.radius[row] = state.point, state.radius
        room.tangents[row], room.slopes[row] = state.tangent, state.slope
        room.contacts.feet[row * m : row * m + m] = state.feet

    def state(self, row: int) -> State:
        """The point in a row."""
        m, room = len(self.sites), self.track
        return State(
            room.points[row].copy(),
            float(room.radius[row]),
            self.sites,
            room.contacts.feet[row * m : row * m + m].copy(),
            room.tangents[row].copy(),
            float(room.slopes[row]),
        )

    def run(self, count: int) -> Run:
        """The first `count` points."""
        m, room = len(self.sites), self.track
        return Run(
            self.sites,
            room.points[:count].copy(),
            room.radius[:count].copy(),
            room.contacts.feet[: count * m].reshape(count, m, 3).copy(),
        )

    def cut(self, base: int, state: State) -> int:
        """Put a point behind row `base`, instead of a row at it; return how many rows there are."""
        points, kept = self.track.points, base + 1
        while kept > 1 and norm(points[kept - 1] - state.point) <= SAME * self._size:
            kept -= 1
        if kept > 1 or norm(points[0] - state.point) > SAME * self._size:
            kept += 1
        self.put(kept - 1, state)
        return kept
