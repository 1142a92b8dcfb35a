"""The seams that leave the centre of a ball's face, from which whole patches of it are as near.

All directions in which the centre touches the face are patches of the sphere of directions. Around
them are gaps, bounded by the edges of the face, and in these by the directions of single contacts.
Seams leave towards the centres of the largest empty caps in the gaps, those that touch three of
these; on the hull of all gradients, see `local`, they are the facets with corners of three kinds.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.spatial import ConvexHull, QhullError  # type: ignore[import-untyped]

from decomp.boundary.topology import Convexity
from decomp.curves.circle import Circle
from decomp.sites.site import SiteKind
from decomp.skeletons.balls.contacts import Contacts
from decomp.skeletons.balls.probing import TOWARDS
from decomp.skeletons.balls.region_context import RegionContext
from decomp.skeletons.seams.leaving.local import SeamRay
from decomp.vectors import Array, Ints, frame, norm

SAMPLES = 257
"""Points of every edge of the face."""
SAME = 1e-6
"""Contacts nearer to an edge, or to its end, than this part of the radius are at it."""
NEXT = 6.0
"""Points of one edge are two contacts if they are so many samples apart."""
ON_BOUNDARY = 1e-9
ALIKE = 0.9995
"""Cosine of the angle between directions of facets with the same kinds of corners that are one."""


def patch_rays(
    context: RegionContext, faces: set[int], touching: Contacts, single: Sequence[int]
) -> tuple[Contacts, list[SeamRay]]:
    """Contacts that seams leave with, and the seams.

    Args:
        context: of the region.
        faces: the faces whose centre it is.
        touching: all contacts.
        single: those that are on no edge and vertex of the faces.
    """
    centre = touching.feet[0] + touching.radius * touching.gradients[0]
    corners = _Corners(context, faces, touching, single)
    gradients = (centre - corners.feet) / touching.radius
    try:
        hull = ConvexHull(gradients)
    except (QhullError, ValueError):
        # all on one circle: only its axis leaves
        return touching, []
    chosen: list[tuple[frozenset[int], Array, Ints]] = []
    for simplex, equation in zip(hull.simplices, hull.equations, strict=True):
        if corners.are_alike(simplex):
            continue
        way = -equation[:3]
        kinds = frozenset[int]().union(*(corners.kinds[k] for k in simplex))
        # the middle of the cap is on the face in patches, farther away in gaps
        towards = centre + TOWARDS * touching.radius * way
        reach = float(context.queries.nearest(towards[None]).distance[0])
        if reach <= (1 - TOWARDS) * touching.radius + ON_BOUNDARY * context.size:
            continue
        if not any(float(w @ way) > ALIKE for k, w, _ in chosen if k == kinds):
            chosen.append((kinds, way, simplex))
    if not chosen:
        return touching, []
    feet, groups = [touching.feet[corners.single]], [touching.sites[k] for k in corners.single]
    rays = []
    for _, way, simplex in chosen:
        x, y = frame(way)
        around = gradients[simplex] - gradients[simplex].mean(axis=0)
        order = simplex[np.argsort(np.arctan2(around @ y, around @ x))]
        first = len(groups)
        feet.append(corners.feet[order])
        groups += [corners.groups[k] for k in order]
        slope = float(np.mean(gradients[simplex] @ way))
        rays.append(SeamRay(way, (first, first + 1, first + 2), slope))
    every = np.concatenate(feet)
    found = Contacts(touching.radius, every, tuple(groups), (centre - every) / touching.radius)
    return found, rays


class _Corners:
    """Points of edges of some faces, and single contacts.

    Attributes:
        single: the contacts that are no points of these edges.
        feet: (n, 3).
        kinds: for each the edges that it is on, or a number of its own.
        groups: the sites of each.
    """

    def __init__(
        self,
        context: RegionContext,
        faces: set[int],
        touching: Contacts,
        single: Sequence[int],
    ) -> None:
        boundary, sites = context.boundary, context.sites
        number = {(s.kind, s.index): k for k, s in enumerate(sites) if s.region == context.region}
        edges = [
            (k, edge)
            for k, edge in enumerate(boundary.edges)
            if faces & set(edge.faces) and edge.convexity is not Convexity.CONVEX
        ]
        numbers = {k for k, _ in edges}
        ends = {vertex for _, edge in edges for vertex in edge.vertices or ()}
        corners = np.array([boundary.vertices[v].point for v in ends]).reshape(-1, 3)
        # where a smooth edge ends another face's contact is a corner, too, and along it the face
        # beyond is as near
        slack = SAME * touching.radius
        self.single = [
            k
            for k in single
            if not _is_among(touching.feet[k], corners, slack)
            and not any(edge.holds(touching.feet[k], slack) for _, edge in edges)
        ]
        feet = [touching.feet[self.single]]
        self.kinds = [frozenset({-1 - k}) for k in self.single]
        self.groups = [touching.sites[k] for k in self.single]
        self._spacing: dict[int, float] = {}
        self._circles = frozenset[int]()
        for k, edge in edges:
            along = np.linspace(edge.start, edge.end, SAMPLES)
            feet.append(edge.curve.point(edge.curve.wrapped(along)))
            self._spacing[k] = float(norm(np.diff(feet[-1], axis=0)).max())
            if isinstance(edge.curve, Circle):
                self._circles |= {k}
            own = number.get((SiteKind.EDGE, k))
            # a smooth edge is no site: its faces hold the contact
            group = tuple(number[SiteKind.FACE, f] for f in edge.faces) if own is None else (own,)
            self.kinds += [frozenset({k})] * SAMPLES
            self.groups += [group] * SAMPLES
            for end, vertex in zip((-SAMPLES, -1), edge.vertices or (), strict=False):
                corner = number.get((SiteKind.VERTEX, vertex))
                around = boundary.vertices[vertex]
                self.kinds[end] = frozenset(around.edges) & numbers
                if corner is not None:
                    self.groups[end] = (corner, *group)
                elif own is None:
                    self.groups[end] = tuple(number[SiteKind.FACE, f] for f in around.faces)
        self.feet = np.concatenate(feet)

    def are_alike(self, corners: Ints) -> bool:
        """Whether three points are not as many contacts: two next to each other on one edge.

        All three of a circle are alike, too.
        """
        kinds = [self.kinds[k] for k in corners]
        if kinds[0] & kinds[1] & kinds[2] & self._circles:
            return True
        for i, j in ((0, 1), (1, 2), (2, 0)):
            gap = float(norm(self.feet[corners[i]] - self.feet[corners[j]]))
            if any(gap <= NEXT * self._spacing[edge] for edge in kinds[i] & kinds[j]):
                return True
        return False


def _is_among(foot: Array, corners: Array, slack: float) -> bool:
    return bool((norm(corners - foot) <= slack).any())
