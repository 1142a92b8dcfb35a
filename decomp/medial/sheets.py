"""Sheets: the pieces of Vor(a, b) that the skeleton's curves cut out.

All curves that border sheets of one pair of sites are drawn in a plane domain, in which the sheets
are graphs: the footprint on one of the two sites, or a plane that the sheets lie in. They cut the
domain into components; each is in the skeleton or not, as exact queries inside it tell.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_array  # type: ignore[import-untyped]
from scipy.sparse.csgraph import connected_components  # type: ignore[import-untyped]
from scipy.spatial import cKDTree  # type: ignore[import-untyped]

from decomp.attempts import Way, first_of
from decomp.complex.domains import Domain
from decomp.complex.model import SurfaceElement
from decomp.complex.planar import (
    PLANE,
    MergedError,
    Period,
    SparseError,
    Triangulation,
    crossings,
    triangulate,
)
from decomp.errors import GeometryError
from decomp.medial.component_votes import MissingCurveError, kept_components
from decomp.medial.flat_parts import flat_parts
from decomp.medial.incidence import Incidence
from decomp.medial.sheet_domains import FLAT, Drawing, SheetDomains
from decomp.medial.sheet_surface import SheetSurface
from decomp.medial.sheet_tests import SheetTests
from decomp.sites import SiteIndex
from decomp.vectors import Array, Bools, Ints, cross, dot, norm, place

ROUNDS = 12
FILL = 6
"""Points per period with which a domain that has too few is filled."""
MERGED = 1e-9
"""Points nearer to each other than this part of a period are one."""
COARSE = 0.15
"""Triangles whose middles are farther from the sheet than this part of their longest side are
divided before anything else, so that all are on the right side of the solid."""


class CrossingError(GeometryError):
    """Sampled curves cross in the domain: they must be sampled more finely.

    Args:
        segments: (k, 2) pairs of vertices between which a curve must have more samples.
    """

    def __init__(self, message: str, segments: Ints) -> None:
        super().__init__(message)
        self.segments = segments


class UnevenError(GeometryError):
    """A sheet's footprint is too uneven for it to be drawn there."""


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
        finest: whether the curves will not be sampled more finely.
    """

    def __init__(
        self,
        index: SiteIndex,
        incidence: Incidence,
        points: Array,
        add: Callable[[Array], int],
        finest: bool = False,
    ) -> None:
        self._finest = finest
        self._incidence, self._points = incidence, points
        self._add = add
        self._tests = SheetTests(index, incidence)
        self._domains = SheetDomains(incidence, self._tests)

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
        if len(segments) == 1 and len(used) == 2:
            if len(lines) == 1:
                return []  # a curve on which the two sites are near, but no sheet beside it
            where = place(self._points[used[0]])
            raise CrossingError(f"curves have one chord near {where}", segments)
        if not len(isolated) and not _encloses(segments):
            return []  # nor beside one of several chords
        points = self._points[used]
        feet = self._incidence.feet(pair, points)
        surface = SheetSurface(self._incidence, pair, points, feet)
        drawing = self._domains.drawn(pair, points, feet, surface)
        if self._domains.merged(drawing.uv):
            parts = flat_parts(self._points, lines, FLAT * self._incidence.boundary.diagonal)
            if parts is not None and not len(isolated):
                return [sheet for part in parts for sheet in self.sheets(pair, part, ())]
        local = np.searchsorted(used, segments)
        after: tuple[type[GeometryError], ...] = (UnevenError, MissingCurveError, MergedError)
        if self._finest:
            after = (*after, CrossingError)

        def way(what: str, other: Drawing, *errors: type[GeometryError]) -> Way[list[SheetPart]]:
            return Way(what, lambda: self._drawn(pair, used, points, local, other, surface), errors)

        def ways() -> Iterator[Way[list[SheetPart]]]:
            yield way("drawn in the footprint", drawing, *after)
            for other in self._domains.others(pair, points, feet):
                yield way("drawn otherwise", other, *after, CrossingError, SparseError)

        return first_of(ways())

    def _drawn(
        self,
        pair: tuple[int, int],
        used: Ints,
        points: Array,
        segments: Ints,
        drawing: Drawing,
        surface: SheetSurface,
    ) -> list[SheetPart]:
        """The sheets between their borders as they are drawn."""
        draft = _Draft(pair, used, points, drawing.uv, segments, drawing.domain, drawing.column)
        self._check_crossings(draft)
        found, keep = self._triangulated(draft, surface)
        return self._parts(draft, surface, found, keep)

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
        raise UnevenError(
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
        spots = _new(spots, draft.uv, draft.period)
        if not len(spots):
            raise error
        feet, inward = domain.lift(spots)
        on = self._tests.on(draft.pair[draft.column], feet, inward)
        if not on.any():
            raise error
        centres = self._tests.balls(feet[on], inward[on]).centre
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
        balls = self._tests.balls(feet, inward)
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

    def _kept(
        self,
        pair: tuple[int, int],
        found: Triangulation,
        draft: _Draft,
        surface: SheetSurface,
    ) -> list[int]:
        """Numbers of the components that are sheets."""
        domain, column = draft.domain, draft.column

        def ask(rows: Ints, weights: Array) -> Bools:
            if domain is None:
                where = np.einsum("ij,ijk->ik", weights, draft.points[found.triangles[rows]])
                return self._tests.in_skeleton(pair, where, surface)
            feet, inward = domain.lift(np.einsum("ij,ijk->ik", weights, found.corners[rows]))
            return self._tests.touches(pair[column], pair[1 - column], feet, inward)

        names = " and ".join(self._incidence.sites[s].name for s in pair)
        return kept_components(found, draft.points, ask, f"between {names}")

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


def _new(spots: Array, known: Array, period: Period) -> Array:
    """Those of some spots (k, 2) that are none of the known ones (n, 2), nor each other's copies.

    An edge's middle is told once for each of its triangles, also a period away.
    """
    cyclic = np.array([p or 0.0 for p in period])
    every = np.concatenate([known, spots])
    around = np.where(cyclic > 0, cyclic, 1.0)
    every = np.where(cyclic > 0, np.mod(every, around), every - every.min(axis=0))
    every = np.where((cyclic > 0) & (every >= around), 0.0, every)
    near = cKDTree(every, boxsize=cyclic).query_ball_point(
        every[len(known) :], MERGED * cyclic.max()
    )
    fresh = [min(rows) == len(known) + k for k, rows in enumerate(near)]
    return np.asarray(spots[fresh])


def _encloses(segments: Ints) -> bool:
    """Whether segments (m, 2) of vertices make a loop."""
    used, local = np.unique(segments, return_inverse=True)
    one, other = local.reshape(-1, 2).T
    joins = coo_array((np.ones(len(one)), (one, other)), shape=(len(used), len(used)))
    return len(segments) > len(used) - int(connected_components(joins, directed=False)[0])
