"""Tracing one seam from a point to where it ends.

A seam is followed as long as its sites stay the same, see `following`. Where a foot leaves its site
the neighbouring site takes over: a trim, where the seam goes on smoothly, unless it splits there.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from enum import Enum

import numpy as np

from decomp.boundary.topology import RegionBoundary
from decomp.errors import GeometryError
from decomp.sites import Nearest, SiteIndex
from decomp.tracing.contacts import ContactFinder
from decomp.tracing.departures import departures
from decomp.tracing.fins import fin
from decomp.tracing.following import (
    CLOSED,
    ENDED,
    FULL,
    STUCK,
    Track,
    advance,
    follow,
    settle,
    track,
)
from decomp.tracing.local import seam_rays
from decomp.tracing.probing import APART, INTRUDED, JOINED, TOUCH, TOWARDS
from decomp.tracing.queries import region_queries
from decomp.tracing.supports import support_table
from decomp.tracing.walls import Walls, cross
from decomp.vectors import Array, norm, place

ROOM = 1024
MOST_RUNS = 1000
SLACK = 1e-9
"""Contacts whose distances differ by less than this part of the size are looked at as equal."""
MERGED = 1e-3
"""Feet nearer than this part of the radius have run together where a seam stops."""
MET = 1e-6
MERGING = 2e-2
"""Feet on one site nearer than this part of the radius may be about to run together."""
FOOT_ON_EDGE = 1e-9
NEAR_WALL = 1e-3
"""Feet beyond a wall but not noticed yet are nearer to it than this part of the size."""
SAME = 1e-10
"""Points nearer than this part of the size are one."""


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


class SeamTracer:
    """Follows seams of one region."""

    def __init__(self, index: SiteIndex, boundary: RegionBoundary, region: int) -> None:
        self.index, self.boundary, self.region = index, boundary, region
        self.size = boundary.diagonal
        self.table = support_table(boundary, index.sites)
        self.contacts = ContactFinder(index, boundary, region)
        self.queries = region_queries(index, region)
        self._probe = self.queries.probe
        self._walls = Walls(boundary, index.sites, self.table)
        self._tracks: dict[int, Track] = {}

    def trace(self, start: State, stops: Callable[[Array], bool] | None = None) -> Traced:
        """Follow a seam from `start` in the sense of its tangent.

        Args:
            start: its first point.
            stops: whether there is a node at a point (3,) where the sites change.

        Raises:
            GeometryError: the seam cannot be followed; says where.
        """
        home = np.concatenate([start.point, start.tangent])
        here, runs, steps, nothing = start, [], 0, np.zeros(3)
        for _ in range(MOST_RUNS):
            room = self._room(len(here.sites))
            self._put(room, 0, here)
            which = np.array(here.sites, dtype=np.int64)
            same = here.sites == start.sites
            count, why, contact = follow(
                self.table, self._probe, which, room, self.size, home, steps, same
            )
            steps += count - 1
            last = self._get(room, count - 1, here.sites)
            if why in (STUCK, INTRUDED, JOINED) and self._about_to_merge(last):
                merged = self._merging(room, count, here.sites)
                if merged is not None:
                    runs.append(self._run(room, merged[0], here.sites))
                    return Traced(tuple(runs), merged[1], SeamEnd.FIN, -1, nothing)
            if why == STUCK and self._merged(last):
                kept, at = self._fin(room, count, here.sites)
                runs.append(self._run(room, kept, here.sites))
                return Traced(tuple(runs), at, SeamEnd.FIN, -1, nothing)
            if why in (FULL, ENDED, CLOSED, STUCK):
                runs.append(self._run(room, count, here.sites))
                if why == FULL:
                    here = last
                    continue
                if why == ENDED:
                    return Traced(tuple(runs), last, SeamEnd.BOUNDARY, -1, nothing)
                if why == CLOSED:
                    return Traced(tuple(runs), last, SeamEnd.CLOSED, -1, nothing)
                if len(self.contacts.at(last.point, 1e-7 * self.size).feet) > 3:
                    return Traced(tuple(runs), last, SeamEnd.SPLIT, -1, nothing)
                raise GeometryError(f"a seam cannot be followed past {place(last.point)}")
            beyond = self._get(room, count, here.sites)
            if why == INTRUDED:
                found = self.queries.nearest(beyond.point[None])
                intruder = int(found.site[0])
                if found.region[0] != self.region:
                    raise GeometryError(f"a seam leaves the region at {place(last.point)}")
                contact = self._neighbour(here.sites, beyond, intruder, found.foot[0])
                if contact < 0:
                    runs.append(self._run(room, count, here.sites))
                    return Traced(tuple(runs), last, SeamEnd.JUNCTION, intruder, found.foot[0])
            elif why == JOINED:
                kept, at = self._joining(room, count, here.sites)
                runs.append(self._run(room, kept, here.sites))
                return Traced(tuple(runs), at, SeamEnd.SPLIT, -1, nothing)
            kept, at = self._crossing(room, count, here.sites, contact)
            runs.append(self._run(room, kept, here.sites))
            if self._merged(at, MET):
                return Traced(tuple(runs), at, SeamEnd.FIN, -1, nothing)
            known = stops is not None and stops(at.point)
            switched = None if known else self._onwards(at)
            if switched is None:
                return Traced(tuple(runs), at, SeamEnd.SPLIT, -1, nothing)
            here = switched
        raise GeometryError(f"the seam from {place(start.point)} does not end")

    def state(self, sites: Sequence[int], point: Array, feet: Array, along: Array) -> State | None:
        """The point of a seam next to `point`, travelling in the sense of `along`."""
        room = self._room(len(sites))
        room.feet[: len(sites)] = feet
        which = np.array(sites, dtype=np.int64)
        x, y, z = (float(v) for v in point)
        dx, dy, dz = (float(v) for v in along)
        if not settle(self.table, which, room, 0, x, y, z, dx, dy, dz, self.size, True):
            return None
        return self._get(room, 0, tuple(sites))

    def holds(self, state: State) -> bool:
        """Whether a point is truly on the skeleton, with these sites."""
        towards = state.point + TOWARDS * (state.feet - state.point)
        found = self.queries.nearest(np.concatenate([state.point[None], towards]))
        slack = TOUCH * self.size
        return bool(
            found.region[0] == self.region
            and found.distance[0] >= state.radius - slack
            and (found.distance[1:] <= (1 - TOWARDS) * state.radius + slack).all()
        )

    def settled(self, point: Array, feet: Array, along: Array) -> State | None:
        """The point of a seam next to `point`, whose contacts have feet near the given ones.

        Where a foot is shared by several sites (on an edge), a query from a little way towards it
        tells which of them is touched from here.
        """
        sound: State | None = None
        sites: tuple[int, ...] = ()
        for _ in range(6):
            found = tuple(int(k) for k in self._towards(point, feet).site)
            if found == sites and sound is not None:
                return sound
            sites = found
            state = self.state(sites, point, feet, along)
            if state is None:
                return sound
            if self.holds(state):
                sound = state
            point, feet = state.point, state.feet
        return sound

    def _towards(self, point: Array, feet: Array) -> Nearest:
        return self.queries.nearest(point + TOWARDS * (feet - point))

    def _merged(self, state: State, within: float = MERGED) -> bool:
        """Whether two contacts have run together."""
        m = len(state.feet)
        gaps = norm(state.feet[:, None] - state.feet[None])[np.triu_indices(m, 1)]
        return bool((gaps <= within * state.radius).any())

    def _about_to_merge(self, state: State) -> bool:
        """Whether two contacts on one site are close to each other."""
        one, other = self._pair(state)
        near = float(norm(state.feet[one] - state.feet[other])) <= MERGING * state.radius
        return near and state.sites[one] == state.sites[other]

    def _onwards(self, at: State) -> State | None:
        """The same point with the sites of the seam behind it, None if it does not go on alone.

        It does if one seam, with as many contacts, leaves straight on.
        """
        touching = self.contacts.at(at.point, SLACK * self.size)
        rays = seam_rays(touching.gradients)
        if len(rays) != 2 or len(touching.feet) != len(at.sites):
            return None
        ray = max(rays, key=lambda r: float(r.direction @ at.tangent))
        leaving = departures(self, at.point, touching, ray)
        if len(leaving) != 1 or len(leaving[0][0]) != len(at.sites):
            return None
        ahead = leaving[0][1]
        # the contacts in the order in which they were
        order = [int(np.argmin(norm(ahead.feet - foot))) for foot in at.feet]
        if len(set(order)) != len(order):
            return None
        sites = tuple(ahead.sites[k] for k in order)
        switched = self.state(sites, at.point, at.feet, at.tangent)
        return None if switched is None else replace(switched, point=at.point)

    def _neighbour(self, sites: tuple[int, ...], beyond: State, intruder: int, foot: Array) -> int:
        """The contact whose site the intruder continues over an edge, -1 if there is none."""
        gaps = norm(beyond.feet - foot)
        contact = int(np.argmin(gaps))
        if gaps[contact] > 0.01 * beyond.radius:
            return -1
        return contact if intruder in self.contacts.neighbours(sites[contact]) else -1

    def _crossing(
        self, room: Track, count: int, sites: tuple[int, ...], contact: int
    ) -> tuple[int, State]:
        """Where a contact's foot leaves its site near the last of `count` rows.

        Returns:
            The number of rows up to there, and the point; it is put into the last of them.
        """
        beyond = self._get(room, count, sites)
        found = self._wall_near(room, count, sites, sites[contact], beyond.feet[contact])
        if found is None:
            raise GeometryError(
                f"a seam cannot be followed past the trim near {place(room.points[count - 1])}"
            )
        base, state, spot = found
        if float(norm(state.feet[contact] - spot)) <= FOOT_ON_EDGE * self.size:
            state.feet[contact] = spot
        return self._cut(room, base, state), state

    def _joining(self, room: Track, count: int, sites: tuple[int, ...]) -> tuple[int, State]:
        """Where a further contact joins those of a seam, near the last of `count` rows.

        Up to there the distance to it is greater in second order, so that its foot, too, passes to
        another site there.
        """
        beyond = self._get(room, count, sites)
        touching = self.contacts.at(beyond.point, 1e-10 * self.size)
        best: tuple[int, State, Array] | None = None
        for foot, members in zip(touching.feet, touching.sites, strict=True):
            if float(norm(beyond.feet - foot).min()) <= APART * beyond.radius:
                continue
            for site in members:
                found = self._wall_near(room, count, sites, site, foot)
                if found is not None and (best is None or found[0] > best[0]):
                    best = found
        if best is None:
            return count, self._get(room, count - 1, sites)
        return self._cut(room, best[0], best[1]), best[1]

    def _fin(self, room: Track, count: int, sites: tuple[int, ...]) -> tuple[int, State]:
        """Where two contacts run together, just behind the last of `count` rows.

        Either they meet at a vertex, at a wall of their sites, or in the middle of one site: then
        the square of the gap between their feet vanishes linearly along the seam, and the point is
        found by extrapolation to no gap, see `fins`.
        """
        last = self._get(room, count - 1, sites)
        which = np.array(sites, dtype=np.int64)
        for length in (1e-6, 1e-5):
            if not advance(
                self.table, which, room, count - 1, count, length * self.size, self.size, False
            ):
                continue
            for contact in self._pair(last):
                found = self._wall_near(room, count, sites, sites[contact], last.feet[contact])
                if found is not None:
                    base, state, _ = found
                    return self._cut(room, base, state), state
        return count, last

    def _merging(self, room: Track, count: int, sites: tuple[int, ...]) -> tuple[int, State] | None:
        """Where two contacts on one site run together, near the last of `count` rows."""
        rows = [self._get(room, k, sites) for k in range(count)]
        one, other = self._pair(rows[-1])
        if sites[one] != sites[other]:
            return None
        found = fin(self, rows, (one, other))
        self._put(room, 0, rows[0])  # where points were settled in between
        if found is None or not self.holds(found[1][-1]):
            return None
        kept, ahead = found
        for state in ahead:
            self._put(room, kept, state)
            kept += 1
        return kept, ahead[-1]

    def _pair(self, state: State) -> tuple[int, int]:
        """The two contacts with the nearest feet."""
        one, other = np.triu_indices(len(state.feet), 1)
        k = int(np.argmin(norm(state.feet[one] - state.feet[other])))
        return int(one[k]), int(other[k])

    def _wall_near(
        self, room: Track, count: int, sites: tuple[int, ...], site: int, foot: Array
    ) -> tuple[int, State, Array] | None:
        """Where a seam crosses a wall of a site, near the last of `count` rows.

        Args:
            room, count: points of the seam; the row behind them is beyond the wall.
            sites: of the seam.
            site: whose foot leaves it.
            foot: that foot beyond the wall, close to the wall's edge.

        Returns:
            The row from which the wall is ahead, the point, and the point of the edge.
        """
        which = np.array(sites, dtype=np.int64)
        spare = count + 1
        best: tuple[float, int, State, Array] | None = None
        for wall in self._walls.of(site):
            for base in range(count - 1, max(count - 4, -1), -1):
                # from a row before the change to the point beyond it
                high = float(norm(room.points[count] - room.points[base]))
                low = 0.0 if base else -1e-3 * high - 1e-6 * self.size
                spot = np.array(foot)
                if not cross(
                    self.table,
                    which,
                    room,
                    base,
                    spare,
                    low,
                    1.02 * high + 1e-6 * self.size,
                    spot,
                    wall.edge,
                    wall.carrier,
                    wall.vertex,
                    self.size,
                ):
                    continue
                off = float(norm(spot - foot))
                if off <= NEAR_WALL * self.size and (best is None or off < best[0]):
                    best = (off, base, self._get(room, spare, sites), spot)
                break
        return None if best is None else best[1:]

    def _cut(self, room: Track, base: int, state: State) -> int:
        """Put a point behind row `base`, instead of a row at it; return how many rows there are."""
        kept = base + 1
        while kept > 1 and norm(room.points[kept - 1] - state.point) <= SAME * self.size:
            kept -= 1
        if kept > 1 or norm(room.points[0] - state.point) > SAME * self.size:
            kept += 1
        self._put(room, kept - 1, state)
        return kept

    def _room(self, contacts: int) -> Track:
        if contacts not in self._tracks:
            self._tracks[contacts] = track(contacts, ROOM)
        return self._tracks[contacts]

    def _put(self, room: Track, row: int, state: State) -> None:
        m = len(state.sites)
        room.points[row], room.radius[row] = state.point, state.radius
        room.tangents[row], room.slopes[row] = state.tangent, state.slope
        room.feet[row * m : row * m + m] = state.feet

    def _get(self, room: Track, row: int, sites: tuple[int, ...]) -> State:
        m = len(sites)
        return State(
            room.points[row].copy(),
            float(room.radius[row]),
            sites,
            room.feet[row * m : row * m + m].copy(),
            room.tangents[row].copy(),
            float(room.slopes[row]),
        )

    def _run(self, room: Track, count: int, sites: tuple[int, ...]) -> Run:
        m = len(sites)
        return Run(
            sites,
            room.points[:count].copy(),
            room.radius[:count].copy(),
            room.feet[: count * m].reshape(count, m, 3).copy(),
        )
