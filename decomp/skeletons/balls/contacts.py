"""All contacts of a maximal ball with the boundary."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from decomp.boundary.topology import Convexity
from decomp.kernels.compiled import scalar
from decomp.sites.measure import count_of
from decomp.sites.octree import locate
from decomp.sites.site import SiteKind
from decomp.skeletons.balls.fields import support_fields
from decomp.skeletons.balls.probing import TOWARDS, Probe, candidate_foot
from decomp.skeletons.balls.region_context import RegionContext
from decomp.vectors import Array, norm


@dataclass(frozen=True, eq=False)
class Contacts:
    """Where the maximal ball about a point touches the boundary.

    Args:
        radius: of the ball.
        feet: (m, 3), pairwise different.
        sites: for each foot all sites that have it, those of the lowest dimension first.
        gradients: (m, 3), unit vectors from the feet to the point.
    """

    radius: float
    feet: Array
    sites: tuple[tuple[int, ...], ...]
    gradients: Array


def contacts(context: RegionContext, point: Array, slack: float) -> Contacts:
    """Find every site whose foot is no more than `slack` farther than the nearest."""
    return ContactFinder(context).at(point, slack)


class ContactFinder:
    """Finds contacts in one region."""

    def __init__(self, context: RegionContext) -> None:
        self._boundary, self._sites = context.boundary, context.sites
        self._table, self._queries = context.table, context.queries
        self._probe = self._queries.probe
        self._near = _neighbours(context)
        self._parts = _parts(context)
        self._feet = np.empty((count_of(self._probe.sites), 3))

    def neighbours(self, site: int) -> tuple[int, ...]:
        """Sites that can share a foot with a site."""
        return self._near.get(site, ())

    def at(self, point: Array, slack: float) -> Contacts:
        """Every site whose foot is no more than `slack` farther than the nearest.

        A site's support may come near without the site (its foot lies outside the face). That is
        told by a query a little way towards the foot: from there the foot, if on the boundary, is
        nearest.
        """
        radius = float(self._queries.nearest(point[None]).distance[0])
        x, y, z = (float(v) for v in point)
        count = close_feet(self._probe, x, y, z, radius + slack, self._feet)
        feet = self._feet[:count].copy()
        found = self._queries.nearest(point + TOWARDS * (feet - point))
        exact = self._boundary.tolerances.converged
        true = np.abs(found.distance - (1 - TOWARDS) * norm(feet - point)) <= exact
        # so far off its site can a foot be without being noticed
        gap = max(slack, 3 * float(np.sqrt(2 * radius * exact)))
        groups: list[tuple[Array, set[int]]] = []
        for site, own, spot in zip(
            found.site[true].tolist(), found.foot[true], feet[true], strict=True
        ):
            for place, members in groups:
                if float(norm(place - spot)) <= gap:
                    members.add(site)
                    break
            else:
                # the query's own foot is exact on its site
                spot = own if float(norm(own - spot)) <= gap else spot
                groups.append((spot, {site}))
        self._complete(point, radius, groups, gap)
        order = {SiteKind.VERTEX: 0, SiteKind.EDGE: 1, SiteKind.FACE: 2}
        places = np.array([spot for spot, _ in groups]).reshape(-1, 3)
        return Contacts(
            radius,
            places,
            tuple(
                tuple(sorted(members, key=lambda k: (order[self._sites[k].kind], k)))
                for _, members in groups
            ),
            (point - places) / radius,
        )

    def _complete(
        self, point: Array, radius: float, groups: Sequence[tuple[Array, set[int]]], gap: float
    ) -> None:
        """Add to each contact the neighbours of its sites that have the same foot."""
        for _ in range(2):
            which = [
                (number, other)
                for number, (_, members) in enumerate(groups)
                for site in members
                for other in self._near.get(site, ())
                if other not in members
            ]
            if not which:
                return
            spots = np.array([groups[number][0] for number, _ in which])
            others = np.array([other for _, other in which])
            field = support_fields(
                self._table, others, np.repeat(point[None], len(which), axis=0), spots
            )
            same = (norm(field.foot - spots) <= gap) & (np.abs(field.distance - radius) <= gap)
            for (number, other), good in zip(which, same, strict=True):
                if good and self.is_on(other, groups[number][0]):
                    groups[number][1].add(other)

    def is_on(self, site: int, foot: Array) -> bool:
        """Whether a foot (3,) on an edge's carriers is on the edge; true of all other sites."""
        if site not in self._parts:
            return True
        edge = self._boundary.edges[self._sites[site].index]
        return edge.holds(foot, self._boundary.tolerances.same)


@scalar
def close_feet(probe: Probe, x: float, y: float, z: float, reach: float, feet: Array) -> int:
    """Feet within reach of a point on the untrimmed supports of its leaf's candidates.

    Returns:
        How many there are; they are put into the first rows of `feet`.
    """
    sites = probe.sites
    every = len(sites.face_carriers) + len(sites.kinds) + len(sites.vertices)
    leaf = locate(probe.candidates.tree, x, y, z)
    begin, end = 0, every
    if leaf >= 0:
        begin, end = probe.candidates.first[leaf], probe.candidates.first[leaf + 1]
    listed = leaf >= 0 and end > begin
    if not listed:
        begin, end = 0, every
    count = 0
    for m in range(begin, end):
        k = probe.candidates.items[m] if listed else m
        qx, qy, qz = candidate_foot(probe, k, x, y, z)
        dx, dy, dz = qx - x, qy - y, qz - z
        if dx * dx + dy * dy + dz * dz <= reach * reach:
            feet[count, 0], feet[count, 1], feet[count, 2] = qx, qy, qz
            count += 1
    return count


def _parts(context: RegionContext) -> set[int]:
    """The edges that are not all in which their carriers meet: feet can be on another one."""
    found: dict[tuple[int, ...], list[int]] = {}
    for number, site in enumerate(context.sites):
        if site.region == context.region and site.kind is SiteKind.EDGE:
            carriers = tuple(sorted(context.boundary.edges[site.index].carriers))
            found.setdefault(carriers, []).append(number)
    return {number for own in found.values() if len(own) > 1 for number in own}


def _neighbours(context: RegionContext) -> dict[int, tuple[int, ...]]:
    """For each site those that can share a foot with it."""
    number: dict[tuple[SiteKind, int], int] = {
        (site.kind, site.index): k
        for k, site in enumerate(context.sites)
        if site.region == context.region
    }
    boundary = context.boundary
    pairs: set[tuple[int, int]] = set()

    def join(a: int | None, b: int | None) -> None:
        if a is not None and b is not None and a != b:
            pairs.update([(a, b), (b, a)])

    for k, edge in enumerate(boundary.edges):
        if edge.convexity is Convexity.CONVEX:
            continue
        own = number.get((SiteKind.EDGE, k))
        one, other = (number[SiteKind.FACE, face] for face in edge.faces)
        if edge.convexity is Convexity.SMOOTH:
            join(one, other)
        join(own, one)
        join(own, other)
        for v in edge.vertices or ():
            vertex = boundary.vertices[v]
            corner = number.get((SiteKind.VERTEX, v))
            join(own, corner)
            for other_edge in vertex.edges:
                join(own, number.get((SiteKind.EDGE, other_edge)))
            for face in vertex.faces:
                join(corner, number[SiteKind.FACE, face])
                join(own, number[SiteKind.FACE, face])
    found: dict[int, list[int]] = {}
    for a, b in sorted(pairs):
        found.setdefault(a, []).append(b)
    return {a: tuple(b) for a, b in found.items()}
