"""Sheets drawn in the plane: what is done with all of them, however they are drawn.

1. The curves around them, drawn in a plane domain, must not cross.
2. They are triangulated; a periodic domain that has too few points gets more.
3. They cut the domain into components; exact queries inside tell which of these are sheets.
4. Where triangles leave their sheet by much it gets points inside, and all is done again.
5. Triangles are turned as their sheet's normals are, and points inside become vertices.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree  # type: ignore[import-untyped]

from decomp.complex.footprints.domain_base import Domain
from decomp.complex.model import SurfaceElement
from decomp.complex.plane.planar import (
    PLANE,
    Period,
    SparseError,
    Triangulation,
    crossings,
    triangulate,
)
from decomp.errors import GeometryError
from decomp.skeletons.balls.balls import Balls
from decomp.skeletons.sheets.component_votes import incentres
from decomp.skeletons.sheets.sheet_tests import SheetTests
from decomp.tolerance import TOLERANCE
from decomp.vectors import Array, Bools, Ints, cross, dot, norm

ROUNDS = 12
FILL = 6
"""Points per period with which a domain that has too few is filled."""
COARSE = 0.15
"""Triangles whose middles are farther from the sheet than this part of their longest side are
divided before anything else, so that all are on the right side of the solid."""
STEEP = 0.05
"""The same, measured across the sheet: where it is steep over its footprint, as between a plane
and a cylinder that it almost touches, what is measured along the normal is many times as much."""


class CrossingError(GeometryError):
    """Sampled curves cross in the domain: they must be sampled more finely.

    Args:
        message: what is wrong near `{at}`.
        segments: (k, 2) pairs of vertices between which a curve must have more samples.
        sites: names of the sites between which the curves are.
        at: (3,) where they cross.
    """

    def __init__(self, message: str, segments: Ints, sites: Iterable[str], at: Array) -> None:
        super().__init__(message, sites, at=at)
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


@dataclass(frozen=True, eq=False)
class Footprint:
    """The footprint of one of the two sites of sheets: each of its points has one maximal ball.

    Args:
        tests: exact queries of the region.
        domain: the footprint.
        site: whose it is.
        far: the other one, the same for the sheets of an edge with itself.
    """

    tests: SheetTests
    domain: Domain
    site: int
    far: int

    def balls(self, uv: Array) -> tuple[Array, Balls]:
        """The feet (k, 3) at places (k, 2), and the maximal balls that touch there."""
        feet, inward = self.domain.lift(uv)
        return feet, self.tests.balls(feet, inward)

    def balls_inside(self, found: Triangulation, rows: Ints) -> tuple[Array, Balls]:
        """The same over the incentres of triangles."""
        weights, _ = incentres(found.corners[rows])
        return self.balls(np.einsum("ij,ijk->ik", weights, found.corners[rows]))

    def holds(self, found: Triangulation, rows: Ints, weights: Array) -> Bools:
        """Whether there are sheets over places of triangles, at barycentric weights (k, 3)."""
        feet, inward = self.domain.lift(np.einsum("ij,ijk->ik", weights, found.corners[rows]))
        return self.tests.touches(self.site, self.far, feet, inward)


@dataclass(eq=False)
class DrawnCurves:
    """The curves around sheets, and points inside these, as they are drawn.

    Args:
        vertex: (k,) the vertex that each of the first k points is; the others are inside.
        points, uv: (n, 3) and (n, 2).
        segments: (m, 2) indices of points.
        footprint: None if they are drawn in a plane that the sheets are projected to.
        sites: names of the sites.
        where: they are drawn, in messages.
    """

    vertex: Ints
    points: Array
    uv: Array
    segments: Ints
    footprint: Footprint | None
    sites: tuple[str, ...]
    where: str

    @property
    def period(self) -> Period:
        """Of the domain."""
        return PLANE if self.footprint is None else self.footprint.domain.period

    def check_crossings(self) -> None:
        """See that no two curves cross.

        Raises:
            CrossingError: they do, in some segments.
        """
        bad = crossings(self.uv, self.segments, self.period)
        if len(bad):
            segments = self.segments[np.unique(bad)]
            raise CrossingError(
                f"curves cross in {self.where} near {{at}}",
                self.vertex[segments],
                self.sites,
                self.points[segments[0, 0]],
            )

    def triangulated(
        self,
        kept: Callable[[Triangulation], list[int]],
        bent: Callable[[Triangulation, list[int]], list[int]] = lambda _, numbers: numbers,
    ) -> tuple[Triangulation, list[int]]:
        """A triangulation whose triangles follow the sheets roughly, and the sheets' components.

        Args:
            kept: numbers of the components that are sheets.
            bent: those of them that must be followed.

        Raises:
            UnevenError: there is none.
            SparseError: a periodic domain has too few points, and no more can be had.
            GeometryError: a component is neither a sheet nor none: a curve is missing.
        """
        for _ in range(ROUNDS):
            try:
                found = triangulate(self.uv, self.segments, self.period)
            except SparseError as error:
                self._fill(error)
                continue
            numbers = kept(found)
            if not self._add_where_coarse(found, bent(found, numbers)):
                return found, numbers
        raise UnevenError(
            f"the sheet between {' and '.join(self.sites)} near {{at}} cannot be triangulated",
            self.sites,
            at=self.points[0],
        )

    def numbered(self, triangles: Ints, add: Callable[[Array], int]) -> Ints:
        """The vertices (n,) that points are, -1 for what triangles (m, 3) do not need.

        Args:
            add: makes a point (3,) a vertex and returns its number.
        """
        inner = len(self.vertex)
        numbers = np.full(len(self.points), -1, dtype=np.int64)
        numbers[:inner] = self.vertex
        for k in np.unique(triangles):
            if k >= inner:
                numbers[k] = add(self.points[k])
        return numbers

    def _add(self, uv: Array, points: Array) -> None:
        self.uv = np.concatenate([self.uv, uv])
        self.points = np.concatenate([self.points, points])

    def _fill(self, error: SparseError) -> None:
        """Add points to a periodic domain that has too few, where the sheets are if possible."""
        footprint = self.footprint
        if footprint is None:
            raise error
        spots = _new(error.spots if len(error.spots) else self._grid(), self.uv, self.period)
        if not len(spots):
            raise error
        feet, inward = footprint.domain.lift(spots)
        on = footprint.tests.on(footprint.site, feet, inward)
        if not on.any():
            raise error
        self._add(spots[on], footprint.tests.balls(feet[on], inward[on]).centre)

    def _grid(self) -> Array:
        """Places (k, 2) all over the domain, more of them each time."""
        low, high = self.uv.min(axis=0), self.uv.max(axis=0)
        count = FILL + len(self.vertex) - len(self.uv)
        sides = []
        for k, period in enumerate(self.period):
            start, length = float(low[k]), float(high[k] - low[k])
            sides.append(start + (period or length) * (np.arange(count) + 0.5) / count)
        return np.array(np.meshgrid(*sides)).reshape(2, -1).T

    def _add_where_coarse(self, found: Triangulation, numbers: list[int]) -> bool:
        """Add inner points where triangles leave their sheet by much; whether there were any."""
        footprint = self.footprint
        rows = np.flatnonzero(np.isin(found.component, numbers))
        if footprint is None or not len(rows):
            return False
        corners = self.points[found.triangles[rows]]
        sides = norm(corners - np.roll(corners, 1, axis=1)).max(axis=1)
        feet, balls = footprint.balls(found.centroids[rows])
        off = balls.centre - corners.mean(axis=1)
        between = balls.foot - feet
        across = np.abs(dot(off, between)) > STEEP * sides * norm(between)
        coarse = (norm(off) > COARSE * sides) & (across | (norm(between) == 0))
        coarse &= balls.site == footprint.far
        if coarse.any():
            self._add(found.centroids[rows][coarse], balls.centre[coarse])
        return bool(coarse.any())


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
        every[len(known) :], TOLERANCE * cyclic.max()
    )
    fresh = [min(rows) == len(known) + k for k, rows in enumerate(near)]
    return np.asarray(spots[fresh])


def facing(points: Array, triangles: Ints, normals: Array) -> Ints:
    """Triangles (m, 3) of points, turned so that they face as normals (m, 3) do, most of them."""
    corners = points[triangles]
    own = cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    agree = float(dot(own, normals).sum())
    return triangles if agree >= 0 else np.ascontiguousarray(triangles[:, ::-1])
