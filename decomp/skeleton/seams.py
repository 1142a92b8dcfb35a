"""Tracing one seam from a point to where it ends.

A seam is followed by steps along its tangent and Newton's method back onto it. After every step
two questions are put to the nearest-site query: is anything nearer than the seam's own sites (then
it has run past a junction), and is every foot still on its site (else the foot has crossed an edge
and the neighbouring site takes over: a trim, where the seam goes on smoothly).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import Enum

import numpy as np

from decomp.boundary.topology import RegionBoundary
from decomp.errors import GeometryError
from decomp.sites import Nearest, SiteIndex
from decomp.skeleton.contacts import TOWARDS
from decomp.skeleton.equidistance import equidistant
from decomp.skeleton.local import seam_rays
from decomp.vectors import Array, norm, place

LONGEST, SHORTEST = 0.05, 1e-9
TURNING = np.radians(6.0)
TOUCH = 1e-10
HALVINGS = 60
MOST_STEPS = 5000


class SeamEnd(Enum):
    """How a seam ends.

    At a junction, where another site is as near; at a split, where sites that were equally near
    part tangentially; at the boundary, where its radius is zero; or in its own beginning.
    """

    JUNCTION = "junction"
    SPLIT = "split"
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


@dataclass(frozen=True, eq=False)
class Traced:
    """A seam as it was traced.

    Args:
        states: its points in order; sites may change from one to the next at trims.
        end: how it ends.
        intruder: the site that ends it at a junction, -1 otherwise.
    """

    states: tuple[State, ...]
    end: SeamEnd
    intruder: int


@dataclass(frozen=True, eq=False)
class _Check:
    """What the nearest-site query says of a point: an intruding site, or feet that left theirs."""

    intruder: int
    sites: tuple[int, ...]

    def same(self, sites: tuple[int, ...]) -> bool:
        return self.intruder < 0 and self.sites == sites


class SeamTracer:
    """Follows seams of one region."""

    def __init__(self, index: SiteIndex, boundary: RegionBoundary, region: int) -> None:
        self._index, self._boundary, self._region = index, boundary, region
        self._size = boundary.diagonal

    def trace(self, start: State) -> Traced:
        """Follow a seam from `start` in the sense of its tangent.

        Raises:
            GeometryError: the seam cannot be followed; says where.
        """
        states = [start]
        step = 1e-3 * self._size
        for _ in range(MOST_STEPS):
            here = states[-1]
            if here.radius <= 1e-7 * self._size and here.slope < 0:
                return Traced(tuple(states), SeamEnd.BOUNDARY, -1)
            limit = 0.5 * here.radius / -here.slope if here.slope < 0 else np.inf
            step = min(step, LONGEST * self._size, limit)
            moved = self._step(here, step)
            if moved is None:
                step /= 2
                if step < SHORTEST * min(self._size, 1e3 * here.radius):
                    if len(here.sites) > 3:
                        return Traced(tuple(states), SeamEnd.SPLIT, -1)
                    raise GeometryError(f"a seam cannot be followed past {place(here.point)}")
                continue
            check = self._check(moved)
            if check.same(moved.sites):
                states.append(moved)
                if len(states) > 3 and self._returns(states):
                    return Traced((*states[:-1], states[0]), SeamEnd.CLOSED, -1)
                step *= 1.5
                continue
            last, check = self._last_before(here, step)
            if last is not here:
                states.append(last)
            if check.intruder >= 0:
                return Traced(tuple(states), SeamEnd.JUNCTION, check.intruder)
            states.append(self._switched(last, check.sites))
            step = 1e-3 * self._size
        raise GeometryError(f"the seam from {place(start.point)} does not end")

    def state(self, sites: Sequence[int], point: Array, feet: Array, along: Array) -> State | None:
        """The point of a seam next to `point`, travelling in the sense of `along`."""
        found = equidistant(
            self._boundary, self._index.sites, np.array([sites]), point[None], feet[None]
        )
        if not found.converged[0]:
            return None
        gradients = (found.points[0] - found.feet[0]) / found.radius[0]
        rays = seam_rays(gradients)
        if len(rays) < 2:
            return None
        ray = max(rays, key=lambda r: float(r.direction @ along))
        return State(
            found.points[0],
            float(found.radius[0]),
            tuple(sites),
            found.feet[0],
            ray.direction,
            ray.slope,
        )

    def holds(self, state: State) -> bool:
        """Whether a point is truly on the skeleton, with these sites."""
        return self._check(state).same(state.sites)

    def turned(self, state: State) -> State:
        """The same point, travelling the other way."""
        return replace(state, tangent=-state.tangent, slope=-state.slope)

    def settled(self, point: Array, feet: Array, along: Array) -> State:
        """The point of a seam next to `point`, whose contacts have feet near the given ones.

        Where a foot is shared by several sites (on an edge), a query from a little way towards it
        tells which of them is touched from here.
        """
        sites = tuple(int(k) for k in self._towards(point, feet).site)
        for _ in range(4):
            state = self.state(sites, point, feet, along)
            if state is None:
                break
            if self.holds(state):
                return state
            sites = tuple(int(k) for k in self._towards(state.point, state.feet).site)
        raise GeometryError(f"the seam near {place(point)} cannot be followed")

    def _towards(self, point: Array, feet: Array) -> Nearest:
        return self._index.nearest(point + TOWARDS * (feet - point))

    def _step(self, here: State, step: float) -> State | None:
        moved = self.state(here.sites, here.point + step * here.tangent, here.feet, here.tangent)
        if moved is None:
            return None
        way = moved.point - here.point
        length = float(norm(way))
        if not 0.5 * step <= length <= 1.5 * step:
            return None
        bend = float(moved.tangent @ here.tangent)
        return moved if bend >= np.cos(TURNING) and way @ here.tangent > 0.9 * length else None

    def _check(self, state: State) -> _Check:
        towards = state.point + TOWARDS * (state.feet - state.point)
        found = self._index.nearest(np.concatenate([state.point[None], towards]))
        slack = TOUCH * self._size
        if found.region[0] != self._region or found.distance[0] < state.radius - slack:
            return _Check(int(found.site[0]), state.sites)
        lost = found.distance[1:] > (1 - TOWARDS) * state.radius + slack
        sites = tuple(
            int(new) if gone else old
            for old, new, gone in zip(state.sites, found.site[1:], lost, strict=True)
        )
        return _Check(-1, sites)

    def _last_before(self, here: State, step: float) -> tuple[State, _Check]:
        """The last point of the seam before something changes, and the change."""
        low, high = 0.0, step
        last, change = here, None
        for _ in range(HALVINGS):
            if high - low <= 1e-14 * self._size:
                break
            middle = (low + high) / 2
            moved = self._step(here, middle)
            if moved is None:
                high = middle
                continue
            check = self._check(moved)
            if check.same(moved.sites):
                low, last = middle, moved
            else:
                high, change = middle, check
        if change is None:
            moved = self._step(here, step)
            if moved is None:
                raise GeometryError(f"a seam cannot be followed past {place(here.point)}")
            change = self._check(moved)
        return last, change

    def _switched(self, state: State, sites: tuple[int, ...]) -> State:
        """The same point with neighbouring sites."""
        changed = self.state(sites, state.point, state.feet, state.tangent)
        if changed is None:
            raise GeometryError(f"a seam cannot be followed past the trim {place(state.point)}")
        return changed

    def _returns(self, states: list[State]) -> bool:
        """Whether the last step passed the seam's first point."""
        first, before, here = states[0], states[-2], states[-1]
        way = here.point - before.point
        along = float((first.point - before.point) @ way) / float(way @ way)
        off = float(norm(first.point - before.point - along * way))
        return (
            0 < along <= 1
            and off <= 0.1 * float(norm(way))
            and first.sites == here.sites
            and float(first.tangent @ here.tangent) > 0
        )
