"""What becomes of a seam where it halts: it ends there, or goes on with other sites.

A seam is followed with constant sites until something changes (`following`). Each kind of change
has its rule here, which takes the halt and tells how the seam ends or where it goes on.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np

from decomp.errors import GeometryError
from decomp.skeletons.balls.probing import INTRUDED, JOINED, LOST
from decomp.skeletons.seams.ending.seam_stops import SeamStops, nearest_pair
from decomp.skeletons.seams.leaving.departures import departures
from decomp.skeletons.seams.leaving.local import seam_rays
from decomp.skeletons.seams.steps.following import CLOSED, ENDED, FULL, STUCK
from decomp.skeletons.seams.steps.points import SeamPoints
from decomp.skeletons.seams.steps.states import Run, SeamEnd, State
from decomp.skeletons.seams.steps.stretch import Stretch
from decomp.vectors import Array, norm

MERGED = 1e-3
"""Feet nearer than this part of the radius have run together where a seam stops."""
MERGING = 2e-2
"""Feet on one site nearer than this part of the radius may be about to run together."""
MET = 1e-6
"""Feet nearer than this part of the radius have run together at the wall of a site."""
BESIDE = 0.01
"""An intruder's foot nearer to a contact's than this part of the radius may take over from it."""

Found = tuple[int, State]
"""The number of rows of a stretch up to a point, and the point."""


@dataclass(frozen=True, eq=False)
class Halt:
    """Where a seam ceased to have the sites that it had.

    Args:
        here: the first point with these sites.
        stretch: the points, and behind them one just beyond the change, if there is a change.
        count: the number of points before the change.
        why: as `follow` tells it.
        contact: whose foot left its site, if one did.
        last: of the points.
        joined: where a further contact joined, if that is why and it is known.
        node_at: whether there is a node at a point (3,) where the sites change.
    """

    here: State
    stretch: Stretch
    count: int
    why: int
    contact: int
    last: State
    joined: Found | None
    node_at: Callable[[Array], bool]

    @property
    def run(self) -> Run:
        """All points before the change."""
        return self.stretch.run(self.count)

    def ended(self, end: SeamEnd, found: Found | None = None) -> Ended:
        """The seam ends, at its last point or where it was found to."""
        kept, at = found or (self.count, self.last)
        return Ended(self.stretch.run(kept), at, end)


@dataclass(frozen=True, eq=False)
class Onwards:
    """The seam goes on: its run up to a point, and that point with the sites behind it."""

    run: Run
    here: State


@dataclass(frozen=True, eq=False)
class Ended:
    """The seam ends: its run up to there, its last point, and how; see `Traced`."""

    run: Run
    last: State
    end: SeamEnd
    intruder: int = -1
    foot: Array = field(default_factory=lambda: np.zeros(3))


Outcome = Onwards | Ended


class Transitions:
    """The rules of one region's seams.

    Args:
        points: of its seams.
        stops: finds where they stop.
    """

    def __init__(self, points: SeamPoints, stops: SeamStops) -> None:
        self._points, self._stops = points, stops
        self._rules: dict[int, Callable[[Halt], Outcome]] = {
            FULL: _full,
            ENDED: _vanished,
            CLOSED: _closed,
            STUCK: self._stuck,
            INTRUDED: self._intruded,
            JOINED: self._joined,
            LOST: self._lost,
        }

    def after(self, halt: Halt) -> Outcome:
        """How a seam ends where it halts, or goes on.

        Raises:
            GeometryError: neither can be told; says where.
        """
        return self._rules[halt.why](halt)

    def _stuck(self, halt: Halt) -> Outcome:
        """No further point: two feet run together, or there is a node."""
        merging = self._merging(halt)
        if merging is not None:
            return merging
        if _merged(halt.last):
            return halt.ended(SeamEnd.FIN, self._stops.fin(halt.stretch, halt.count))
        if self._at_node(halt.last):
            return halt.ended(SeamEnd.SPLIT)
        names = self._points.names(halt.last.sites)
        raise GeometryError("a seam cannot be followed past {at}", names, halt.last.point)

    def _intruded(self, halt: Halt) -> Outcome:
        """Another site is nearer: a junction, or a foot that passed over an edge unnoticed."""
        merging = self._merging(halt)
        if merging is not None:
            return merging
        points = self._points
        beyond = halt.stretch.state(halt.count)
        found = points.queries.nearest(beyond.point[None])
        intruder, foot = int(found.site[0]), found.foot[0]
        if found.region[0] != points.region:
            names = points.names(halt.last.sites)
            raise GeometryError("a seam leaves the region at {at}", names, halt.last.point)
        contact = self._neighbour(halt.stretch.sites, beyond, intruder, foot)
        if contact >= 0:
            crossed = self._over_edge(halt, contact)
            if crossed is not None:
                return crossed
            # not over the edge: two sites that meet there, each with a foot beside it
        else:
            landed = self._stops.landing(halt.stretch, halt.count)
            if landed is not None:
                return halt.ended(SeamEnd.FIN, landed)
        return Ended(halt.run, halt.last, SeamEnd.JUNCTION, intruder, foot)

    def _joined(self, halt: Halt) -> Outcome:
        """A further site is as near, and stays so: the seam splits there."""
        merging = self._merging(halt)
        if merging is not None:
            return merging
        if halt.joined is None:
            # the arc about a locus joins long before a seam that comes down in a parabola ends
            landed = self._stops.landing(halt.stretch, halt.count)
            if landed is not None:
                return halt.ended(SeamEnd.FIN, landed)
        return halt.ended(SeamEnd.SPLIT, halt.joined)

    def _lost(self, halt: Halt) -> Outcome:
        """A foot leaves its site: it passes over an edge to the next one."""
        crossed = self._over_edge(halt, halt.contact)
        if crossed is not None:
            return crossed
        raise GeometryError(
            "a seam cannot be followed past the trim near {at}",
            self._points.names(halt.here.sites),
            at=halt.stretch.track.points[halt.count - 1],
        )

    def _over_edge(self, halt: Halt, contact: int) -> Outcome | None:
        """What a seam does where a contact's foot passes over an edge; None if it does not pass."""
        stretch, count = halt.stretch, halt.count
        crossed = self._stops.crossing(stretch, count, contact)
        if crossed is None:
            ended = self._stops.vertex(stretch, count) or self._stops.landing(stretch, count)
            return None if ended is None else halt.ended(SeamEnd.FIN, ended)
        if count > 1 and (crossed[1].point == halt.here.point).all():
            # where it came from
            return None
        at = crossed[1]
        if _merged(at, MET):
            return halt.ended(SeamEnd.FIN, crossed)
        switched = None if halt.node_at(at.point) else self._switched(at)
        if switched is None:
            return halt.ended(SeamEnd.SPLIT, crossed)
        return Onwards(stretch.run(crossed[0]), switched)

    def _merging(self, halt: Halt) -> Ended | None:
        """The seam's end where two contacts on one site run together; None if they do not."""
        if not _about_to_merge(halt.last):
            return None
        merged = self._stops.merging(halt.stretch, halt.count)
        return None if merged is None else halt.ended(SeamEnd.FIN, merged)

    def _at_node(self, last: State) -> bool:
        """Whether a seam ends where it cannot be followed: more is touched, or a whole arc is."""
        points = self._points
        touching = points.contacts.at(last.point, points.tolerances.on_locus)
        return len(touching.feet) > 3 or any(
            points.on_locus(sites, last.point) for sites in touching.sites
        )

    def _switched(self, at: State) -> State | None:
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
        if gaps[contact] > BESIDE * beyond.radius:
            return -1
        return contact if intruder in self._points.contacts.neighbours(sites[contact]) else -1


def _full(halt: Halt) -> Outcome:
    """The room is used up: the seam goes on as it was."""
    return Onwards(halt.run, halt.last)


def _vanished(halt: Halt) -> Outcome:
    """The radius vanishes: the seam has come to the boundary."""
    return halt.ended(SeamEnd.BOUNDARY)


def _closed(halt: Halt) -> Outcome:
    """Back where the seam began; its last row lies past its first."""
    return halt.ended(SeamEnd.CLOSED, (halt.count - 1, halt.last))


def _merged(state: State, within: float = MERGED) -> bool:
    """Whether two contacts have run together."""
    one, other = nearest_pair(state)
    return bool(norm(state.feet[one] - state.feet[other]) <= within * state.radius)


def _about_to_merge(state: State) -> bool:
    """Whether two contacts on one site are close to each other."""
    one, other = nearest_pair(state)
    return state.sites[one] == state.sites[other] and _merged(state, MERGING)
