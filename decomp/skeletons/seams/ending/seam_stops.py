"""Where exactly a seam stops having the sites that it has.

It was followed to the last of some rows; the row behind them is beyond the place.
"""

from __future__ import annotations

import numpy as np

from decomp.skeletons.seams.ending.arriving import arrival
from decomp.skeletons.seams.ending.fins import fin as merging_feet
from decomp.skeletons.seams.ending.landing import landing
from decomp.skeletons.seams.ending.vertex_fins import at_vertex
from decomp.skeletons.seams.ending.walls import (
    ALONG,
    CROSSED,
    JOINS,
    MISSED,
    Wall,
    Walls,
    cross,
    gap_ahead,
)
from decomp.skeletons.seams.steps.points import SeamPoints
from decomp.skeletons.seams.steps.states import State
from decomp.skeletons.seams.steps.stepping import advance
from decomp.skeletons.seams.steps.stretch import Stretch
from decomp.vectors import Array, norm

AT_VERTEX = 1e-4
"""Feet lost while they run together are nearer to their vertex than this part of the size."""
NEAR_WALL = 1e-3
"""Feet beyond a wall but not noticed yet are nearer to it than this part of the size."""
AHEAD = (1e-6, 1e-5)
"""Steps ahead of a fin on which feet leave their sites, as parts of the size."""
TOUCHED = 1e-10
"""Sites no farther than this part of the size beyond the nearest are touched where one joins."""
BEFORE, LONGER, PAST = 1e-3, 1.02, 1e-6
"""A wall is looked for from so much before the first point to so much past the last, in parts of
the way between; and by a part of the size more at both ends."""


class SeamStops:
    """Finds where seams of one region stop."""

    def __init__(self, points: SeamPoints) -> None:
        self._points, self._size = points, points.size
        self._walls = Walls(points.context)

    def crossing(self, stretch: Stretch, count: int, contact: int) -> tuple[int, State] | None:
        """Where a contact's foot leaves its site near the last of `count` rows.

        Returns:
            The number of rows up to there, and the point; it is put into the last of them. None if
            it is not found.
        """
        beyond = stretch.state(count)
        found = self._wall_near(stretch, count, stretch.sites[contact], beyond.feet[contact])
        if found is None:
            return None
        base, state, spot = found
        if float(norm(state.feet[contact] - spot)) <= self._points.tolerances.same:
            state.feet[contact] = spot
        state = self._exactly(state)
        return stretch.cut(base, state), state

    def joining(self, stretch: Stretch, count: int) -> tuple[int, State] | None:
        """Where a further contact joins those of a seam, near the last of `count` rows.

        Up to there the distance to it is greater in second order, so that its foot, too, passes to
        another site there, or the foot of a contact that it was one with. Behind it feet may stay
        on the walls of their sites, where rounding tells on which side. So the first of all
        crossings is the one. None if there is none.
        """
        beyond = stretch.state(count)
        touching = self._points.contacts.at(beyond.point, TOUCHED * self._size)
        best: tuple[int, State] | None = None
        first = np.inf
        for foot, members in zip(touching.feet, touching.sites, strict=True):
            for site in members:
                found = self._wall_near(stretch, count, site, foot)
                if found is None:
                    continue
                base, state, _ = found
                ahead = float((state.point - beyond.point) @ beyond.tangent)
                if ahead < first:
                    first, best = ahead, (base, state)
        if best is None:
            return None
        return stretch.cut(best[0], best[1]), best[1]

    def fin(self, stretch: Stretch, count: int) -> tuple[int, State]:
        """Where two contacts run together, just behind the last of `count` rows.

        Either they meet at a vertex, at a wall of their sites, or in the middle of one site: then
        the square of the gap between their feet vanishes linearly along the seam, and the point is
        found by extrapolation to no gap, see `fins`.
        """
        last = stretch.state(count - 1)
        for length in AHEAD:
            step = length * self._size
            if not advance(self._points.table, stretch.track, count - 1, count, step, False):
                continue
            for contact in nearest_pair(last):
                found = self._wall_near(stretch, count, stretch.sites[contact], last.feet[contact])
                if found is not None:
                    base, state = found[0], self._exactly(found[1])
                    return stretch.cut(base, state), state
        return self.merging(stretch, count) or (count, last)

    def _exactly(self, state: State) -> State:
        """A crossing with a wall, exactly also where two feet run together at a vertex there."""
        return at_vertex(self._points, state, nearest_pair(state)) or state

    def vertex(self, stretch: Stretch, count: int) -> tuple[int, State] | None:
        """Where two feet run together at a vertex, close to the last of `count` rows.

        None if they do not.
        """
        last = stretch.state(count - 1)
        end = at_vertex(self._points, last, nearest_pair(last), AT_VERTEX)
        return None if end is None else (stretch.cut(count - 1, end), end)

    def landing(self, stretch: Stretch, count: int) -> tuple[int, State] | None:
        """Where a seam ends on the reflexive locus of a face that its edges bound.

        None if it does not, close to the last of `count` rows, or something else is nearer there.
        """
        spare, last = count + 1, stretch.state(count - 1)

        def ahead(length: float) -> State | None:
            if not advance(self._points.table, stretch.track, count - 1, spare, length, False):
                return None
            return stretch.state(spare)

        def settle(state: State) -> State | None:
            return self._points.state(state.sites, state.point, state.feet, state.tangent)

        for off in self._points.loci_near(last):
            found = landing(ahead, settle, off, last)
            if found is not None and self._points.holds(found[1]):
                between, end = found
                kept = count
                for state in (*between, end):
                    stretch.put(kept, state)
                    kept += 1
                return kept, end
        return None

    def merging(self, stretch: Stretch, count: int) -> tuple[int, State] | None:
        """Where two contacts run together inside a site, near the last of `count` rows.

        None if they do not.
        """
        rows = [stretch.state(k) for k in range(count)]
        found = merging_feet(self._points, rows, nearest_pair(rows[-1]))
        if found is None or not self._points.holds(found[1][-1]):
            return None
        kept, ahead = found
        room = len(stretch.track.points) - kept
        for state in ahead[-room:]:
            stretch.put(kept, state)
            kept += 1
        return kept, ahead[-1]

    def _wall_near(
        self, stretch: Stretch, count: int, site: int, foot: Array
    ) -> tuple[int, State, Array] | None:
        """Where a seam crosses a wall of a site, near the last of `count` rows.

        Args:
            stretch, count: points of the seam; the row behind them is beyond the wall.
            site: whose foot leaves it.
            foot: that foot beyond the wall, close to the wall's edge.

        Returns:
            The row from which the wall is ahead, the point, and the point of the edge.
        """
        spare = count + 1
        best: tuple[float, int, State, Array] | None = None
        for wall in self._walls.of(site):
            for base in range(count - 1, max(count - 4, -1), -1):
                # from a row before the change to the point beyond it
                high = float(norm(stretch.track.points[count] - stretch.track.points[base]))
                low = 0.0 if base else -BEFORE * high - PAST * self._size
                spot = np.array(foot)
                high = LONGER * high + PAST * self._size
                between = low, high
                found = cross(self._points.table, wall, stretch.track, base, spare, between, spot)
                if found == JOINS:
                    found = self._arrive(stretch, base, spare, between, wall, foot, spot)
                if found == MISSED or self._walls.beyond(wall, spot) > self._points.tolerances.same:
                    continue
                off = float(norm(spot - foot))
                if off <= NEAR_WALL * self._size and (best is None or off < best[0]):
                    best = (off, base, stretch.state(spare), spot)
                break
        return None if best is None else best[1:]

    def _arrive(
        self,
        stretch: Stretch,
        base: int,
        spare: int,
        lengths: tuple[float, float],
        wall: Wall,
        foot: Array,
        spot: Array,
    ) -> int:
        """Put the point where a seam comes to a wall along which it runs, as `cross` does."""

        def gap(length: float) -> float:
            spot[:] = foot
            good, value = gap_ahead(
                self._points.table, wall, stretch.track, base, spare, length, spot
            )
            return value if good else np.nan

        radius = float(stretch.track.radius[base])
        found = arrival(gap, *lengths, ALONG * self._size, radius)
        return CROSSED if found is not None and np.isfinite(gap(found)) else MISSED


def nearest_pair(state: State) -> tuple[int, int]:
    """The two contacts with the nearest feet."""
    one, other = np.triu_indices(len(state.feet), 1)
    k = int(np.argmin(norm(state.feet[one] - state.feet[other])))
    return int(one[k]), int(other[k])
