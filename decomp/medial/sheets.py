"""Sheets: the pieces of Vor(a, b) that the skeleton's curves cut out.

All curves that border sheets of one pair of sites are drawn in a plane domain, in which the sheets
are graphs: the footprint on one of the two sites, or a plane that the sheets lie in. They cut the
domain into components; each is in the skeleton or not, as exact queries inside it tell.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from decomp.boundary.topology import RegionBoundary
from decomp.carriers import Sphere
from decomp.complex.domains import Domain, domain_of
from decomp.complex.model import SurfaceElement
from decomp.complex.planar import PLANE, Triangulation, crossings, triangulate
from decomp.errors import GeometryError
from decomp.medial.incidence import Incidence
from decomp.medial.reflexive import reflexive_gap
from decomp.medial.sheet_surface import SheetSurface
from decomp.sites import SiteIndex
from decomp.sites.site import SiteKind
from decomp.tracing.balls import inscribed_balls
from decomp.tracing.fields import site_fields
from decomp.vectors import Array, Bools, Ints, cross, dot, norm, place

TESTS = 7
"""Triangles of each component at which it is asked what it is."""
RANKS = {"plane": 0, "cone": 3, "cylinder": 2, "sphere": 4, "torus": 5}
OFF = 1e-6
FLAT = 1e-10


class CrossingError(GeometryError):
    """Sampled curves cross in the domain: they must be sampled more finely.

    Args:
        segments: (k, 2) pairs of vertices between which a curve must have more samples.
    """

    def __init__(self, message: str, segments: Ints) -> None:
        super().__init__(message)
        self.segments = segments


@dataclass(frozen=True, eq=False)
class SheetPart:
    """One sheet as triangles.

    Args:
        sites: a and b.
        surface: that it lies on: Vor(a, b), or a plane of symmetry if a is b.
        triangles: (m, 3) vertices, their normals pointing from a's side to b's.
    """

    sites: tuple[int, int]
    surface: SurfaceElement
    triangles: Ints


class SheetMaker:
    """Triangulates the sheets of one region over given vertices.

    Args:
        index: nearest-site queries.
        incidence: of the region.
        points: (n, 3) all vertices.
    """

    def __init__(self, index: SiteIndex, incidence: Incidence, points: Array) -> None:
        self._index, self._incidence, self._points = index, incidence, points
        self._size = incidence.boundary.diagonal

    @property
    def _boundary(self) -> RegionBoundary:
        return self._incidence.boundary

    def sheets(
        self, pair: tuple[int, int], lines: Sequence[Ints], isolated: Sequence[int]
    ) -> list[SheetPart]:
        """The sheets between two different sites.

        Args:
            pair: the sites.
            lines: polylines of vertices that border them.
            isolated: vertices inside them, where they have a kink.

        Raises:
            CrossingError: the polylines must be finer.
            GeometryError: a component is neither a sheet nor none: a curve is missing.
        """
        segments = segments_of(lines)
        used = np.unique(np.concatenate([segments.ravel(), np.array(isolated, dtype=np.int64)]))
        local = np.searchsorted(used, segments)
        points = self._points[used]
        feet = self._feet(pair, points)
        surface = SheetSurface(self._incidence, pair, points, feet)
        flat = self._flat(pair, points)
        if flat is not None:
            uv, domain, column = flat, None, 0
        else:
            column = self._better(pair, points)
            domain = self._domain(pair[column], points, feet[:, column], surface)
            uv = domain.to_plane(feet[:, column], points)
        period = PLANE if domain is None else domain.period
        bad = crossings(uv, local, period)
        if len(bad):
            rows = np.unique(bad)
            raise CrossingError(
                f"curves cross in the footprint near {place(points[local[rows[0], 0]])}",
                used[local[rows]],
            )
        found = triangulate(uv, local, period)
        keep = self._kept(pair, found, points, domain, column, surface)
        parts = []
        for number in keep:
            triangles = found.triangles[found.component == number]
            oriented = self._oriented(surface, points, triangles)
            parts.append(SheetPart(pair, surface, used[oriented]))
        return parts

    def _feet(self, pair: tuple[int, int], points: Array) -> Array:
        feet = np.empty((len(points), 2, 3))
        for column, site in enumerate(pair):
            which: Ints = np.full(len(points), site, dtype=np.int64)
            it = self._incidence.sites[site]
            guess = points
            if it.kind is SiteKind.EDGE:
                samples = self._boundary.edges[it.index].samples
                gap = ((points[:, None] - samples[None]) ** 2).sum(axis=2)
                guess = samples[np.argmin(gap, axis=1)]
            field = site_fields(self._boundary, self._incidence.sites, which, points, guess)
            feet[:, column] = field.foot
        return feet

    def _flat(self, pair: tuple[int, int], points: Array) -> Array | None:
        """Plane coordinates of points that all lie in a plane, unless a plane face is at hand."""
        if any(self._rank(site) == 0 for site in pair):
            return None
        middle = points.mean(axis=0)
        _, spread, axes = np.linalg.svd(points - middle, full_matrices=False)
        if spread[-1] > FLAT * self._size * np.sqrt(len(points)):
            return None
        return np.asarray((points - middle) @ axes[:2].T)

    def _rank(self, site: int) -> int:
        it = self._incidence.sites[site]
        if it.kind is SiteKind.FACE:
            return RANKS[self._boundary.carriers[self._boundary.faces[it.index].carrier].kind]
        return 6 if it.kind is SiteKind.EDGE else 7

    def _better(self, pair: tuple[int, int], points: Array) -> int:
        """Which site's footprint to use: simple carriers first, none whose locus is reached."""

        def cost(column: int) -> int:
            it = self._incidence.sites[pair[column]]
            rank = self._rank(pair[column])
            if it.kind is SiteKind.FACE:
                face = self._boundary.faces[it.index]
                carrier = self._boundary.carriers[face.carrier]
                if reflexive_gap(carrier, face.outward, points).min() <= 1e-7 * self._size:
                    rank += 10
            return rank

        return min((0, 1), key=cost)

    def _domain(self, site: int, points: Array, feet: Array, surface: SheetSurface) -> Domain:
        it = self._incidence.sites[site]
        if it.kind is SiteKind.FACE and self._rank(site) == RANKS["sphere"]:
            return domain_of(self._boundary, it, pole=self._pole(site, surface, feet))
        if it.kind is SiteKind.EDGE:
            return domain_of(self._boundary, it, reach=float(np.median(norm(points - feet))))
        return domain_of(self._boundary, it)

    def _pole(self, site: int, surface: SheetSurface, feet: Array) -> Array:
        """A direction from a sphere's centre in which no sheet of the pair lies."""
        face = self._boundary.faces[self._incidence.sites[site].index]
        sphere = self._boundary.carriers[face.carrier]
        assert isinstance(sphere, Sphere)
        centre, radius = sphere.centre, sphere.radius
        rng = np.random.default_rng(0)
        ways = rng.normal(size=(2000, 3))
        ways /= norm(ways)[:, None]
        q = centre + radius * ways
        clear = np.min(norm(q[:, None] - feet[None]), axis=1)
        order = np.argsort(-clear)
        other = surface.sites[1] if surface.sites[0] == site else surface.sites[0]
        ok = ~self._touches(site, other, q[order], -face.outward * sphere.normal(q[order]))
        if not ok.any():
            raise GeometryError(f"the sheet around the sphere at {place(centre)} has no boundary")
        return np.asarray(ways[order[int(np.argmax(ok))]])

    def _touches(self, site: int, other: int, feet: Array, inward: Array) -> Bools:
        """Whether feet (k, 3) are on a site and the maximal balls there touch another."""
        result = np.zeros(len(feet), dtype=np.bool_)
        step = OFF * self._size
        near = self._index.nearest(feet + step * inward)
        on = (near.region == self._incidence.region) & (np.abs(near.distance - step) < 1e-3 * step)
        rows = np.flatnonzero(on & (near.site == site))
        if self._incidence.sites[site].kind is not SiteKind.FACE:
            rows = np.flatnonzero(on)
        if not len(rows):
            return result
        balls = inscribed_balls(
            self._index, self._boundary, self._incidence.region, feet[rows], inward[rows]
        )
        result[rows] = balls.site == other
        return result

    def _kept(
        self,
        pair: tuple[int, int],
        found: Triangulation,
        points: Array,
        domain: Domain | None,
        column: int,
        surface: SheetSurface,
    ) -> list[int]:
        """Numbers of the components that are sheets."""
        rows, owner = [], []
        for number in range(found.components):
            members = np.flatnonzero(found.component == number)
            corners = points[found.triangles[members]]
            area = norm(cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]))
            chosen = members[np.argsort(-area)[:TESTS]]
            rows.extend(chosen.tolist())
            owner.extend([number] * len(chosen))
        if not rows:
            return []
        if domain is None:
            yes = self._in_skeleton(pair, points[found.triangles[rows]].mean(axis=1), surface)
        else:
            feet, inward = domain.lift(found.centroids[rows])
            yes = self._touches(pair[column], pair[1 - column], feet, inward)
        owners = np.array(owner)
        kept = []
        for number in range(found.components):
            votes = yes[owners == number]
            share = float(votes.mean())
            if 0.0 < share < 1.0:
                where = points[found.triangles[rows]].mean(axis=1)[owners == number]
                odd = where[votes != (share > 0.5)][0]
                names = " and ".join(self._incidence.sites[s].name for s in pair)
                raise GeometryError(f"the sheet between {names} has no clear end near {place(odd)}")
            if share > 0.5:
                kept.append(number)
        return kept

    def _in_skeleton(self, pair: tuple[int, int], near: Array, surface: SheetSurface) -> Bools:
        """Whether points near the surface, moved onto it, have both sites as nearest ones."""
        moved, good = surface.try_place(near)
        found = self._index.nearest(moved)
        which: Ints = np.tile(np.array(pair), (len(moved), 1))
        feet = self._feet(pair, moved)
        reach = norm(moved - feet[:, 0])
        slack = 1e-9 * self._size
        good = good & (found.region == self._incidence.region)
        good &= found.distance >= reach - slack
        for column in (0, 1):
            toward = self._index.nearest(moved + 0.3 * (feet[:, column] - moved))
            good &= np.abs(toward.distance - 0.7 * reach) <= slack
            good &= toward.site == which[:, column]
        return np.asarray(good)

    def _oriented(self, surface: SheetSurface, points: Array, triangles: Ints) -> Ints:
        corners = points[triangles]
        normals = cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        wanted = surface.normal(corners.reshape(-1, 3)).reshape(-1, 3, 3).sum(axis=1)
        agree = float(dot(normals, wanted).sum())
        return triangles if agree >= 0 else np.ascontiguousarray(triangles[:, ::-1])


def segments_of(lines: Sequence[Ints]) -> Ints:
    """Unique segments (k, 2) of polylines."""
    parts = [np.stack([line[:-1], line[1:]], axis=1) for line in lines if len(line) > 1]
    if not parts:
        return np.empty((0, 2), dtype=np.int64)
    both = np.sort(np.concatenate(parts), axis=1)
    return np.unique(both, axis=0)
