"""Sheets: the pieces of Vor(a, b) that the skeleton's curves cut out.

All curves that border sheets of one pair of sites are drawn in a plane domain, in which the sheets
are graphs: the footprint on one of the two sites, or a plane that the sheets lie in. They cut the
domain into components; each is in the skeleton or not, as exact queries inside it tell.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree  # type: ignore[import-untyped]

from decomp.boundary.topology import RegionBoundary
from decomp.carriers import Sphere
from decomp.carriers.reflexive import reflexive_gap
from decomp.complex.domains import Domain, domain_of
from decomp.complex.model import SurfaceElement
from decomp.complex.planar import (
    PLANE,
    Period,
    SparseError,
    Triangulation,
    crossings,
    triangulate,
)
from decomp.errors import GeometryError
from decomp.medial.incidence import Incidence
from decomp.medial.sheet_surface import SheetSurface
from decomp.medial.unrolled import unrolled
from decomp.sites import SiteIndex
from decomp.sites.site import SiteKind
from decomp.tracing.balls import Balls, inscribed_balls
from decomp.vectors import Array, Bools, Ints, cross, dot, norm, place

TESTS = 7
"""Triangles of each component at which it is asked what it is."""
RANKS = {"plane": 0, "cone": 3, "cylinder": 2, "sphere": 4, "torus": 5}
UNCLEAR = 0.1
"""A component with votes of more weight than this on either side is neither sheet nor none. Votes
count by inradius: a sliver beside a border can lie on its wrong side."""
OFF = 1e-6
ROUNDS = 12
FILL = 6
"""Points per period with which a domain that has too few is filled."""
COARSE = 0.15
"""Triangles whose middles are farther from the sheet than this part of their longest side are
divided before anything else, so that all are on the right side of the solid."""
FLAT = 1e-10
MERGED = 1e-9
"""Points of a footprint nearer to each other than this part of the size have merged."""


class CrossingError(GeometryError):
    """Sampled curves cross in the domain: they must be sampled more finely.

    Args:
        segments: (k, 2) pairs of vertices between which a curve must have more samples.
    """

    def __init__(self, message: str, segments: Ints) -> None:
        super().__init__(message)
        self.segments = segments


class MissingCurveError(GeometryError):
    """A part of a footprint is partly sheet and partly not: a curve between them is not known."""


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


@dataclass(eq=False)
class _Draft:
    """The sheets of a pair as they are drawn in their domain.

    Args:
        pair: the sites.
        used: (k,) the vertices that border them or are kinks: the first of the points.
        points, uv: (n, 3) and (n, 2); beyond the first k are points inside the sheets.
        segments: (m, 2) indices of points.
        domain: None for a plane that the sheets are projected to.
        column: of which site the domain is the footprint.
    """

    pair: tuple[int, int]
    used: Ints
    points: Array
    uv: Array
    segments: Ints
    domain: Domain | None
    column: int

    @property
    def period(self) -> Period:
        """Of the domain."""
        return PLANE if self.domain is None else self.domain.period

    def add(self, uv: Array, points: Array) -> None:
        """More points inside."""
        self.uv = np.concatenate([self.uv, uv])
        self.points = np.concatenate([self.points, points])


class SheetMaker:
    """Triangulates the sheets of one region over given vertices.

    Args:
        index: nearest-site queries.
        incidence: of the region.
        points: (n, 3) all vertices.
        add: makes a point (3,) a vertex and returns its number.
    """

    def __init__(
        self,
        index: SiteIndex,
        incidence: Incidence,
        points: Array,
        add: Callable[[Array], int],
    ) -> None:
        self._index, self._incidence, self._points = index, incidence, points
        self._add = add
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
        points = self._points[used]
        feet = self._incidence.feet(pair, points)
        surface = SheetSurface(self._incidence, pair, points, feet)
        uv, domain, column = self._drawn(pair, points, feet, surface)
        draft = _Draft(pair, used, points, uv, np.searchsorted(used, segments), domain, column)
        self._check_crossings(draft)
        found, keep = self._triangulated(draft, surface)
        return self._parts(draft, surface, found, keep)

    def _drawn(
        self, pair: tuple[int, int], points: Array, feet: Array, surface: SheetSurface
    ) -> tuple[Array, Domain | None, int]:
        """Coordinates of the points, their domain and the site that it belongs to.

        Sheets between edges and vertices are drawn in their plane if they have one; so are those
        whose feet on both sites merge, for there the footprint has too little room.
        """
        flat = self._flat(pair, points)
        faces = [self._incidence.sites[site].kind is SiteKind.FACE for site in pair]
        if flat is not None and not any(faces):
            return flat, None, 0
        column = self._better(pair, points)
        own, other = pair[column], pair[1 - column]
        domain = self._domain(own, points, feet[:, column], surface)
        domain = unrolled(
            domain,
            domain.to_plane(feet[:, column], points),
            lambda at: self._touches(own, other, *domain.lift(at)),
        )
        uv = domain.to_plane(feet[:, column], points)
        if flat is not None and len(cKDTree(uv).query_pairs(MERGED * self._size)):
            return flat, None, 0
        return uv, domain, column

    def _check_crossings(self, draft: _Draft) -> None:
        bad = crossings(draft.uv, draft.segments, draft.period)
        if len(bad):
            rows = np.unique(bad)
            where = place(draft.points[draft.segments[rows[0], 0]])
            raise CrossingError(
                f"curves cross in the footprint near {where}", draft.used[draft.segments[rows]]
            )

    def _triangulated(
        self, draft: _Draft, surface: SheetSurface
    ) -> tuple[Triangulation, list[int]]:
        """A triangulation whose triangles follow the sheets roughly, and the sheets' components."""
        for _ in range(ROUNDS):
            try:
                found = triangulate(draft.uv, draft.segments, draft.period)
            except SparseError as error:
                self._fill(draft, error)
                continue
            keep = self._kept(draft.pair, found, draft, surface)
            if draft.domain is None or not self._add_where_coarse(draft, found, keep):
                return found, keep
        names = " and ".join(self._incidence.sites[s].name for s in draft.pair)
        raise GeometryError(
            f"the sheet between {names} near {place(draft.points[0])} cannot be triangulated"
        )

    def _fill(self, draft: _Draft, error: SparseError) -> None:
        """Add points to a periodic domain that has too few, where the sheets are if possible."""
        domain = draft.domain
        if domain is None:
            raise error
        spots = error.places
        if not len(spots):
            low, high = draft.uv.min(axis=0), draft.uv.max(axis=0)
            count = FILL + len(draft.used) - len(draft.uv)
            sides = []
            for k, period in enumerate(draft.period):
                start, length = float(low[k]), float(high[k] - low[k])
                sides.append(start + (period or length) * (np.arange(count) + 0.5) / count)
            spots = np.array(np.meshgrid(*sides)).reshape(2, -1).T
        feet, inward = domain.lift(spots)
        on = self._on(draft.pair[draft.column], feet, inward)
        if not on.any():
            raise error
        centres = self._balls(feet[on], inward[on]).centre
        draft.add(spots[on], centres)

    def _add_where_coarse(self, draft: _Draft, found: Triangulation, keep: list[int]) -> bool:
        """Add inner points where triangles leave their sheet by much; whether there were any."""
        domain = draft.domain
        rows = np.flatnonzero(np.isin(found.component, keep))
        if domain is None or not len(rows):
            return False
        corners = draft.points[found.triangles[rows]]
        sides = norm(corners - np.roll(corners, 1, axis=1)).max(axis=1)
        feet, inward = domain.lift(found.centroids[rows])
        balls = self._balls(feet, inward)
        off = norm(balls.centre - corners.mean(axis=1))
        coarse = off > COARSE * sides
        coarse &= balls.site == draft.pair[1 - draft.column]
        if not coarse.any():
            return False
        draft.add(found.centroids[rows][coarse], balls.centre[coarse])
        return True

    def _parts(
        self, draft: _Draft, surface: SheetSurface, found: Triangulation, keep: list[int]
    ) -> list[SheetPart]:
        inner = len(draft.used)
        if len(draft.points) > inner:
            surface = SheetSurface(
                self._incidence,
                draft.pair,
                draft.points,
                self._incidence.feet(draft.pair, draft.points),
            )
        numbers = np.full(len(draft.points), -1, dtype=np.int64)
        numbers[:inner] = draft.used
        kept = np.isin(found.component, keep)
        for k in np.unique(found.triangles[kept]):
            if k >= inner:
                numbers[k] = self._add(draft.points[k])
        parts = []
        for number in keep:
            triangles = found.triangles[found.component == number]
            oriented = self._oriented(surface, draft.points, triangles)
            parts.append(SheetPart(draft.pair, surface, numbers[oriented]))
        return parts

    def _flat(self, pair: tuple[int, int], points: Array) -> Array | None:
        """Plane coordinates of points that all lie in a plane."""
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

    def _on(self, site: int, feet: Array, inward: Array) -> Bools:
        """Whether feet (k, 3) are on a site, as seen in directions into the region (k, 3)."""
        step = OFF * self._size
        near = self._index.nearest(feet + step * inward)
        on = (near.region == self._incidence.region) & (np.abs(near.distance - step) < 1e-3 * step)
        if self._incidence.sites[site].kind is SiteKind.FACE:
            on &= near.site == site
        return np.asarray(on)

    def _balls(self, feet: Array, inward: Array) -> Balls:
        region = self._incidence.region
        return inscribed_balls(self._index, self._boundary, region, feet, inward)

    def _touches(self, site: int, other: int, feet: Array, inward: Array) -> Bools:
        """Whether feet (k, 3) are on a site and the maximal balls there touch another."""
        result = np.zeros(len(feet), dtype=np.bool_)
        rows = np.flatnonzero(self._on(site, feet, inward))
        if len(rows):
            result[rows] = self._balls(feet[rows], inward[rows]).site == other
        return result

    def _kept(
        self,
        pair: tuple[int, int],
        found: Triangulation,
        draft: _Draft,
        surface: SheetSurface,
    ) -> list[int]:
        """Numbers of the components that are sheets."""
        points, domain, column = draft.points, draft.domain, draft.column
        weights, inradius = _incentres(found.corners)
        rows, owner = [], []
        for number in range(found.components):
            members = np.flatnonzero(found.component == number)
            chosen = members[np.argsort(-inradius[members])[:TESTS]]
            rows.extend(chosen.tolist())
            owner.extend([number] * len(chosen))
        if not rows:
            return []
        where = np.einsum("ij,ijk->ik", weights[rows], points[found.triangles[rows]])
        if domain is None:
            yes = self._in_skeleton(pair, where, surface)
        else:
            feet, inward = domain.lift(np.einsum("ij,ijk->ik", weights[rows], found.corners[rows]))
            yes = self._touches(pair[column], pair[1 - column], feet, inward)
        owners = np.array(owner)
        kept = []
        for number in range(found.components):
            own = owners == number
            share = float(np.average(yes[own], weights=inradius[rows][own]))
            if UNCLEAR < share < 1 - UNCLEAR:
                odd = where[own][yes[own] != (share > 0.5)][0]
                names = " and ".join(self._incidence.sites[s].name for s in pair)
                raise MissingCurveError(
                    f"the sheet between {names} has no clear end near {place(odd)}"
                )
            if share > 0.5:
                kept.append(number)
        return kept

    def _in_skeleton(self, pair: tuple[int, int], near: Array, surface: SheetSurface) -> Bools:
        """Whether points near the surface, moved onto it, have both sites as nearest ones."""
        moved, good = surface.try_place(near)
        found = self._index.nearest(moved)
        which: Ints = np.tile(np.array(pair), (len(moved), 1))
        feet = self._incidence.feet(pair, moved)
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


def _incentres(corners: Array) -> tuple[Array, Array]:
    """Barycentric coordinates (m, 3) of the incentres of plane triangles, and inradii (m,)."""
    a, b, c = (corners[:, k] for k in range(3))
    sides = np.stack([norm(b - c), norm(c - a), norm(a - b)], axis=1)
    perimeter = sides.sum(axis=1)
    doubled = np.abs((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0])
    return sides / perimeter[:, None], doubled / perimeter
