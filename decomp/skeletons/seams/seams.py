"""Tracing one seam from a point to where it ends.

A seam is followed as long as its sites stay the same, see `following`. Where a foot leaves its site
the neighbouring site takes over: a trim, where the seam goes on smoothly, unless it splits there.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from math import inf

import numpy as np

from decomp.errors import GeometryError
from decomp.skeletons.balls.probing import INTRUDED, JOINED
from decomp.skeletons.seams.ending.seam_stops import SeamStops, nearest_pair
from decomp.skeletons.seams.leaving.departures import departures
from decomp.skeletons.seams.leaving.local import seam_rays
from decomp.skeletons.seams.steps.following import CLOSED, ENDED, FULL, STUCK, follow
from decomp.skeletons.seams.steps.points import SeamPoints
from decomp.skeletons.seams.steps.states import SeamEnd, State, Traced
from decomp.skeletons.seams.steps.stretch import Stretch
from decomp.vectors import Array, norm

ROOM = 1024
MOST_RUNS = 1000
MERGED = 1e-3
"""Feet nearer than this part of the radius have run together where a seam stops."""
MERGING = 2e-2
"""Feet on one site nearer than this part of the radius may be about to run together."""
MET = 1e-6
LATE = 3e-6
"""An intruder that is as near for longer than this part of the size has joined the seam before."""


class SeamTracer:
    """Follows seams of one region.

    Args:
        points: of its seams.
        longest: step, as a part of its size.
    """

    def __init__(self, points: SeamPoints, longest: float) -> None:
        self._points, self._stops = points, SeamStops(points)
        self._longest = longest * points.size
        self._probe = points.queries.probe

    def trace(self, start: State, stops: Callable[[Array], bool] | None = None) -> Traced:
        """Follow a seam from `start` in the sense of its tangent.

        Args:
            start: its first point.
            stops: whether there is a node at a point (3,) where the sites change.

        Raises:
            GeometryError: the seam cannot be followed; says where.
        """
        points, size = self._points, self._points.size
        home = np.concatenate([start.point, start.tangent])
        here, runs, steps, nothing = start, [], 0, np.zeros(3)
        for _ in range(MOST_RUNS):
            stretch = Stretch(here.sites, ROOM)
            stretch.put(0, here)
            same = here.sites == start.sites
            given = points.table, self._probe, stretch.which, stretch.track, size
            rest = self._longest, home, steps, same
            count, why, contact = follow(*given, *rest, LATE * size)
            joined = self._stops.joining(stretch, count) if why == JOINED else None
            if why == JOINED and joined is None:
                # nothing tells where it joined: the place from which it is nearer is the one
                count, why, contact = follow(*given, *rest, inf)
                joined = self._stops.joining(stretch, count) if why == JOINED else None
            steps += count - 1
            last = stretch.state(count - 1)
            if why in (STUCK, INTRUDED, JOINED) and _about_to_merge(last):
                merged = self._stops.merging(stretch, count)
                if merged is not None:
                    runs.append(stretch.run(merged[0]))
                    return Traced(tuple(runs), merged[1], SeamEnd.FIN, -1, nothing)
            if why == STUCK and _merged(last):
                kept, at = self._stops.fin(stretch, count)
                runs.append(stretch.run(kept))
                return Traced(tuple(runs), at, SeamEnd.FIN, -1, nothing)
            if why in (FULL, ENDED, CLOSED, STUCK):
                # the last row of a closed seam lies past its first
                runs.append(stretch.run(count - 1 if why == CLOSED else count))
                if why == FULL:
                    here = last
                    continue
                if why == ENDED:
                    return Traced(tuple(runs), last, SeamEnd.BOUNDARY, -1, nothing)
                if why == CLOSED:
                    return Traced(tuple(runs), last, SeamEnd.CLOSED, -1, nothing)
                if self._stuck_at_node(last):
                    return Traced(tuple(runs), last, SeamEnd.SPLIT, -1, nothing)
                names = points.names(last.sites)
                raise GeometryError("a seam cannot be followed past {at}", names, last.point)
            beyond = stretch.state(count)
            if why == INTRUDED:
                found = points.queries.nearest(beyond.point[None])
                intruder = int(found.site[0])
                if found.region[0] != points.region:
                    names = points.names(last.sites)
                    raise GeometryError("a seam leaves the region at {at}", names, last.point)
                contact = self._neighbour(here.sites, beyond, intruder, found.foot[0])
                landed = self._stops.landing(stretch, count) if contact < 0 else None
                if landed is not None:
                    runs.append(stretch.run(landed[0]))
                    return Traced(tuple(runs), landed[1], SeamEnd.FIN, -1, nothing)
                if contact < 0:
                    runs.append(stretch.run(count))
                    return Traced(tuple(runs), last, SeamEnd.JUNCTION, intruder, found.foot[0])
            elif why == JOINED:
                # the arc about a locus joins long before a seam that comes down in a parabola ends
                landed = self._stops.landing(stretch, count) if joined is None else None
                if landed is not None:
                    runs.append(stretch.run(landed[0]))
                    return Traced(tuple(runs), landed[1], SeamEnd.FIN, -1, nothing)
                kept, at = joined or (count, last)
                runs.append(stretch.run(kept))
                return Traced(tuple(runs), at, SeamEnd.SPLIT, -1, nothing)
            crossed = self._stops.crossing(stretch, count, contact)
            back = crossed is not None and count > 1 and (crossed[1].point == here.point).all()
            if back or crossed is None:
                ended = None
                if not back:
                    ended = self._stops.vertex(stretch, count)
                    ended = ended or self._stops.landing(stretch, count)
                if ended is not None:
                    runs.append(stretch.run(ended[0]))
                    return Traced(tuple(runs), ended[1], SeamEnd.FIN, -1, nothing)
                if why == INTRUDED:
                    # not over the edge: two sites that meet there, each with a foot beside it
                    runs.append(stretch.run(count))
                    return Traced(tuple(runs), last, SeamEnd.JUNCTION, intruder, found.foot[0])
                raise GeometryError(
                    "a seam cannot be followed past the trim near {at}",
                    points.names(here.sites),
                    at=stretch.track.points[count - 1],
                )
            kept, at = crossed
            runs.append(stretch.run(kept))
            if _merged(at, MET):
                return Traced(tuple(runs), at, SeamEnd.FIN, -1, nothing)
            known = stops is not None and stops(at.point)
            switched = None if known else self._onwards(at)
            if switched is None:
                return Traced(tuple(runs), at, SeamEnd.SPLIT, -1, nothing)
            here = switched
        names = points.names(start.sites)
        raise GeometryError("the seam from {at} does not end", names, start.point)

    def _stuck_at_node(self, last: State) -> bool:
        """Whether a seam ends where it cannot be followed: more is touched, or a whole arc is."""
        points = self._points
        touching = points.contacts.at(last.point, 1e-7 * points.size)
        return len(touching.feet) > 3 or any(
            points.on_locus(sites, last.point) for sites in touching.sites
        )

    def _onwards(self, at: State) -> State | None:
        """The same point with the sites of the seam behind it, None if it does not go on alone.

        It does if one seam, with as many contacts, leaves straight on. From a reflexive locus none
        does: there a face is as near all around.
        """
        points = self._points
        touching = points.contacts.at(at.point, points.tolerances.same)
        if any(points.on_locus(sites, at.point) for sites in touching.sites):
            return None
        rays = seam_rays(touching.gradients)
        if len(rays) != 2 or len(touching.feet) != len(at.sites):
            return None
        ray = max(rays, key=lambda r: float(r.direction @ at.tangent))
        leaving = departures(points, at.point, touching, ray)
        if len(leaving) != 1 or len(leaving[0][0]) != len(at.sites):
            return None
        ahead = leaving[0][1]
        # the contacts in the order in which they were
        order = [int(np.argmin(norm(ahead.feet - foot))) for foot in at.feet]
        if len(set(order)) != len(order):
            return None
        sites = tuple(ahead.sites[k] for k in order)
        switched = points.state(sites, at.point, at.feet, at.tangent)
        return None if switched is None else replace(switched, point=at.point)

    def _neighbour(self, sites: tuple[int, ...], beyond: State, intruder: int, foot: Array) -> int:
        """The contact whose site the intruder continues over an edge, -1 if there is none."""
        gaps = norm(beyond.feet - foot)
        contact = int(np.argmin(gaps))
        if gaps[contact] > 0.01 * beyond.radius:
            return -1
        return contact if intruder in self._points.contacts.neighbours(sites[contact]) else -1


def _merged(state: State, within: float = MERGED) -> bool:
    """Whether two contacts have run together."""
    one, other = nearest_pair(state)
    return bool(norm(state.feet[one] - state.feet[other]) <= within * state.radius)


def _about_to_merge(state: State) -> bool:
    """Whether two contacts on one site are close to each other."""
    one, other = nearest_pair(state)
    return state.sites[one] == state.sites[other] and _merged(state, MERGING)
