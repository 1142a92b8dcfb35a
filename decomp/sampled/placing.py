"""Points at equal distance from sets of sites, some of which take over from one another.

Where a face and its own reentrant edge are both as near, their feet are one: the point lies on the
normal of the face at its foot on the edge (a trim), and the difference of the distances, which
vanishes to second order, is replaced by the point's distance from that plane of normals.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations

import numpy as np

from decomp.medial.incidence import Incidence
from decomp.sites.site import SiteKind, faces_at
from decomp.tracing.fields import site_fields
from decomp.vectors import Array, Bools, cross, dot, norm

STEPS = 30
EXACT = 2e-14
"""Newton's method ends when all constraints hold to this part of the size."""
GOOD = 2e-13
"""Points at which they hold to this part of the size are placed."""
RANK = 1e-7
"""Gradients that differ by less than this are equal."""
DELTA = 1e-7
"""Gradients of planes of normals are differences over this part of the size."""


@dataclass(frozen=True, eq=False)
class Placed:
    """Points brought to where their sites are equally near.

    Args:
        points: (k, 3).
        radius: (k,) their distance from the sites.
        good: (k,) whether that succeeded.
    """

    points: Array
    radius: Array
    good: Bools


class Placer:
    """Places points of one region.

    Args:
        incidence: of the region.
    """

    def __init__(self, incidence: Incidence) -> None:
        self._it = incidence
        self._size = incidence.boundary.diagonal

    def takes_over(self, a: int, b: int) -> bool:
        """Whether one of two sites is an edge or a vertex of the other.

        Where both are as near, their feet are one.
        """
        one, two = sorted((self._it.sites[a], self._it.sites[b]), key=lambda s: s.kind.value)
        if one.kind is two.kind:
            return False
        boundary = self._it.boundary
        if SiteKind.FACE in (one.kind, two.kind):
            face, other = (one, two) if one.kind is SiteKind.FACE else (two, one)
            return face.index in faces_at(boundary, other)
        edge, vertex = (one, two) if one.kind is SiteKind.EDGE else (two, one)
        return vertex.index in (boundary.edges[edge.index].vertices or ())

    def is_face(self, site: int) -> bool:
        """Whether a site is a face."""
        return self._it.sites[site].kind is SiteKind.FACE

    def on_normal(self, a: int, b: int) -> bool:
        """Whether two sites are as near along one normal at a vertex alone.

        They are a face and a vertex of it, or two edges that end there.
        """
        one, two = self._it.sites[a], self._it.sites[b]
        kinds = {one.kind, two.kind}
        if kinds == {SiteKind.FACE, SiteKind.VERTEX}:
            return self.takes_over(a, b)
        if kinds != {SiteKind.EDGE} or a == b:
            return False
        first, second = (set(self._it.boundary.edges[s.index].vertices or ()) for s in (one, two))
        return bool(first & second)

    def between(self, sites: tuple[int, ...], point: Array) -> int:
        """The edge at which two of some sites meet that is nearest to a point (3,), -1 for none."""
        edges = {
            site
            for edge, site in self._it.edge_site.items()
            if sum(self._it.face_site[f] in sites for f in self._it.boundary.edges[edge].faces) > 1
        }
        left = sorted(edges - set(sites))
        if not left:
            return -1
        away = norm(self._it.feet(left, point[None])[0] - point)
        return left[int(np.argmin(away))]

    def later(self, a: int, b: int) -> int:
        """The one of two sites that takes over from the other: the vertex, or else the edge."""
        order = (SiteKind.FACE, SiteKind.EDGE, SiteKind.VERTEX)
        return max((a, b), key=lambda site: order.index(self._it.sites[site].kind))

    def contacts(self, sites: tuple[int, ...]) -> list[set[int]]:
        """Sites that share a foot, together."""
        found: list[set[int]] = []
        for site in sites:
            near = [g for g in found if any(self.takes_over(site, other) for other in g)]
            found = [g for g in found if g not in near] + [{site}.union(*near)]
        return found

    def place(self, sites: tuple[int, ...], points: Array) -> Placed:
        """Move points (k, 3) the shortest way to where all of some sites are equally near."""
        x = np.array(points)
        links = self._links(sites)
        feet = self._it.feet(sites, x)
        best, worst = np.array(x), np.full(len(x), np.inf)
        for _ in range(STEPS):
            value, slope = self._constraints(sites, links, x, feet)
            off = np.abs(value).max(axis=1)
            off[~np.isfinite(off)] = np.inf
            better = off < worst
            best[better], worst[better] = x[better], off[better]
            if (worst <= EXACT * self._size).all():
                break
            finite = np.isfinite(value).all(axis=1) & np.isfinite(slope).all(axis=(1, 2))
            step = np.zeros_like(x)
            inverse = np.linalg.pinv(slope[finite], rcond=RANK)
            step[finite] = -np.einsum("kij,kj->ki", inverse, value[finite])
            length = norm(step)
            most = 0.25 * self._size
            step *= np.minimum(1.0, most / np.maximum(length, 1e-300))[:, None]
            x = x + step
        radius = self._field(sites[0], best, feet[:, 0])[0]
        return Placed(best, radius, worst <= GOOD * self._size)

    def across(self, sites: tuple[int, int], points: Array) -> Array:
        """Normals (k, 3), of no certain length, of the surface where one site takes over.

        They point to the side of the site that takes over (`later`).
        """
        feet = self._it.feet(sites, points)
        return self._off_normals(sites[0], sites[1], points, feet)[0][1]

    def names(self, sites: tuple[int, ...]) -> list[str]:
        """What sites are called in messages."""
        return [self._it.sites[site].name for site in sites]

    def _links(self, sites: tuple[int, ...]) -> list[tuple[int, int, bool]]:
        """Pairs of columns that tie all sites together, and whether one takes over."""
        pairs = list(combinations(range(len(sites)), 2))
        trims = [(i, j) for i, j in pairs if self.takes_over(sites[i], sites[j])]
        group = list(range(len(sites)))

        def joined(i: int, j: int) -> bool:
            if group[i] == group[j]:
                return False
            old = group[j]
            for k, each in enumerate(group):
                if each == old:
                    group[k] = group[i]
            return True

        for i, j in trims:
            joined(i, j)
        links = [(i, j, True) for i, j in trims]
        return links + [(i, j, False) for i, j in pairs if joined(i, j)]

    def _constraints(
        self,
        sites: tuple[int, ...],
        links: list[tuple[int, int, bool]],
        x: Array,
        feet: Array,
    ) -> tuple[Array, Array]:
        """Values (k, c) and gradients (k, c, 3); feet (k, m, 3) are brought up to date."""
        fields = []
        for column, site in enumerate(sites):
            distance, gradient, foot = self._field(site, x, feet[:, column])
            feet[:, column] = foot
            fields.append((distance, gradient))
        values, slopes = [], []
        for i, j, trim in links:
            if not trim:
                values.append(fields[i][0] - fields[j][0])
                slopes.append(fields[i][1] - fields[j][1])
                continue
            for value, slope in self._off_normals(sites[i], sites[j], x, feet[:, [i, j]]):
                values.append(value)
                slopes.append(slope)
        return np.stack(values, axis=1), np.stack(slopes, axis=1)

    def _field(self, site: int, x: Array, feet: Array) -> tuple[Array, Array, Array]:
        which = np.full(len(x), site, dtype=np.int64)
        found = site_fields(self._it.boundary, self._it.sites, which, x, feet)
        return found.distance, found.gradient, found.foot

    def _off_normals(self, a: int, b: int, x: Array, feet: Array) -> list[tuple[Array, Array]]:
        """How far points are off the normals at which one site takes over, with gradients."""
        it = self._it
        one, two = it.sites[a], it.sites[b]
        if SiteKind.VERTEX in (one.kind, two.kind):
            vertex, other = (one, two) if one.kind is SiteKind.VERTEX else (two, one)
            at = it.boundary.vertices[vertex.index].point
            if other.kind is SiteKind.EDGE:
                ends = it.boundary.edges[other.index].vertices
                sense = -1.0 if ends is not None and ends[0] == vertex.index else 1.0
                return [_plane(x, at, sense * it.tangent(other.index, at))]
            normal = it.inward(other.index, at[None])[0]
            u = np.eye(3)[int(np.argmin(np.abs(normal)))]
            u = u - (u @ normal) * normal
            u /= norm(u)
            return [_plane(x, at, u), _plane(x, at, cross(normal, u))]
        edge, own, column = (a, two, 0) if one.kind is SiteKind.EDGE else (b, one, 1)
        near = feet[:, column]
        faces = it.boundary.edges[it.sites[edge].index].faces
        face = own.index
        beyond = faces[1] if faces[0] == face else faces[0]

        def off(points: Array) -> Array:
            foot = self._field(edge, points, near)[2]
            # across the edge, along the face and away from it: the other face's normal leads there
            normal, second = it.inward(face, foot), it.inward(beyond, foot)
            across = second - dot(second, normal)[:, None] * normal
            return np.asarray(dot(points - foot, across / norm(across)[:, None]))

        h = DELTA * self._size
        steps = [off(x + h * way) - off(x - h * way) for way in np.eye(3)]
        return [(off(x), np.stack(steps, axis=1) / (2 * h))]


def _plane(x: Array, at: Array, normal: Array) -> tuple[Array, Array]:
    return (x - at) @ normal, np.repeat(normal[None], len(x), axis=0)
