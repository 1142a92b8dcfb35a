"""Exact points of seams, found from points close by."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from decomp.carriers import Carrier
from decomp.sites.site import SiteKind
from decomp.skeletons.balls.contacts import ContactFinder
from decomp.skeletons.balls.loci import on_locus
from decomp.skeletons.balls.probing import TOWARDS
from decomp.skeletons.balls.region_context import RegionContext
from decomp.skeletons.seams.steps.states import State
from decomp.skeletons.seams.steps.stepping import settle
from decomp.skeletons.seams.steps.stretch import Stretch
from decomp.tolerance import ON_LOCUS
from decomp.vectors import Array

NEAR_LOCUS = 0.02
"""Balls whose centres are nearer to a locus than this part of their radius may be coming to it."""
TURNS = 6
"""So often sites are named anew where feet are shared by several."""


class SeamPoints:
    """Points of the seams of one region."""

    def __init__(self, context: RegionContext) -> None:
        self.context, self.contacts = context, ContactFinder(context)
        self.boundary, self.region = context.boundary, context.region
        self.size, self.tolerances = context.size, context.tolerances
        self.table, self.queries = context.table, context.queries

    def names(self, sites: Sequence[int]) -> list[str]:
        """Of some sites, for messages."""
        return [self.context.sites[site].name for site in sites]

    def state(self, sites: Sequence[int], point: Array, feet: Array, along: Array) -> State | None:
        """The point of a seam next to `point`, travelling in the sense of `along`."""
        at = Stretch(tuple(sites), 1, self.size)
        at.track.contacts.feet[:] = feet
        x, y, z = (float(v) for v in point)
        dx, dy, dz = (float(v) for v in along)
        if not settle(self.table, at.track, 0, (x, y, z), (dx, dy, dz), True):
            return None
        return at.state(0)

    def holds(self, state: State) -> bool:
        """Whether a point is truly on the skeleton, with these sites."""
        towards = state.point + TOWARDS * (state.feet - state.point)
        found = self.queries.nearest(np.concatenate([state.point[None], towards]))
        slack = self.tolerances.touching
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
        for _ in range(TURNS):
            found = self.touched(point, feet)
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

    def touched(self, point: Array, feet: Array) -> tuple[int, ...]:
        """The sites that are touched from a point (3,) at feet (m, 3), -1 where none is."""
        found = self.queries.nearest(point + TOWARDS * (feet - point))
        return tuple(int(k) for k in found.site)

    def loci_near(self, state: State) -> list[Callable[[Array], float]]:
        """Distances from the loci that are near a ball, of faces that its edges bound."""
        bounded = {
            face
            for site in state.sites
            if self.context.sites[site].kind is SiteKind.EDGE
            for face in self.boundary.edges[self.context.sites[site].index].faces
        }
        found: list[Callable[[Array], float]] = []
        for number in sorted(bounded):
            face = self.boundary.faces[number]
            carrier = self.boundary.carriers[face.carrier]

            def off(point: Array, carrier: Carrier = carrier, outward: int = face.outward) -> float:
                return float(carrier.reflexive_gap(outward, point[None])[0])

            depth = abs(float(carrier.signed_distance(state.point)))
            near = NEAR_LOCUS * state.radius
            if off(state.point) <= near and abs(depth - state.radius) <= near:
                found.append(off)
        return found

    def on_locus(self, sites: Sequence[int], point: Array) -> bool:
        """Whether a point is a centre of curvature of one of the faces among some sites."""
        own = [k for k in sites if k >= 0]
        return bool(on_locus(self.context, own, point[None], ON_LOCUS)[0])
