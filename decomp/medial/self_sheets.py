"""Sheets of a curved reentrant edge with itself.

They are drawn in the edge's own footprint, where each stands twice, once for each of its feet. The
curves that border them cut the footprint into components, which go together in pairs: the ball of
a point in the one has its far foot in the other. One of each pair is kept.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from decomp.complex.domain_base import Domain
from decomp.complex.domain_edges import even_strip
from decomp.complex.model import SurfaceElement
from decomp.complex.planar import SparseError, Triangulation, crossings, triangulate
from decomp.errors import GeometryError
from decomp.medial.component_votes import MissingCurveError, incentres, kept_components
from decomp.medial.edge_wells import EdgeWells
from decomp.medial.footprint_lines import FootprintLines, drawn_lines
from decomp.medial.incidence import Incidence
from decomp.medial.mirror_plane import MirrorPlane
from decomp.medial.plane_sheets import PlaneSheets
from decomp.medial.rim_curve import RimCurve
from decomp.medial.self_surface import SelfSheetSurface
from decomp.medial.sheet_tests import SheetTests
from decomp.medial.sheets import COARSE, ROUNDS, CrossingError, SheetPart
from decomp.sites import SiteIndex
from decomp.tracing.balls import Balls
from decomp.vectors import Array, Bools, Ints, cross, dot, norm

TESTS = 5
"""Triangles of each component whose far feet are asked for."""

SPREAD = np.array([[1, 1, 1], [4, 1, 1], [1, 4, 1], [1, 1, 4]]) / np.array([[3], [6], [6], [6]])
"""Barycentric coordinates (4, 3) of the places in triangles where balls are made known."""


class SelfSheetMaker:
    """Triangulates the sheets of edges with themselves over given vertices.

    Args:
        index: nearest-site queries.
        incidence: of the region.
        points: (n, 3) all vertices.
        add: makes a point (3,) a vertex and returns its number.
    """

    def __init__(
        self, index: SiteIndex, incidence: Incidence, points: Array, add: Callable[[Array], int]
    ) -> None:
        self._incidence, self._points, self._add = incidence, points, add
        self._tests = SheetTests(index, incidence)

    def sheets(
        self, site: int, lines: Sequence[Ints], rims: Sequence[RimCurve | None]
    ) -> list[SheetPart]:
        """The sheets of one edge with itself.

        Args:
            site: the edge.
            lines: polylines of vertices that border them.
            rims: what those of them are on that are rims.

        Raises:
            CrossingError: the polylines must be finer.
            GeometryError: a component is neither a sheet nor none: a curve is missing.
        """
        flat = PlaneSheets(self._tests, self._points, self._incidence.boundary.diagonal, site)
        return flat.within(lines) or _EdgeSheets(
            self._incidence, self._tests, self._points, flat, site, lines, rims
        ).parts(self._add)


class _EdgeSheets:
    """The sheets of one edge with itself, as they are drawn.

    The first drawn points are those of the lines; others are inside the sheets.
    """

    def __init__(
        self,
        incidence: Incidence,
        tests: SheetTests,
        points: Array,
        flat: PlaneSheets,
        site: int,
        lines: Sequence[Ints],
        rims: Sequence[RimCurve | None],
    ) -> None:
        boundary = incidence.boundary
        self._flat = flat
        self._incidence, self._tests, self._site = incidence, tests, site
        self._size, self._name = boundary.diagonal, incidence.sites[site].name
        self._edge = boundary.edges[incidence.sites[site].index]
        self._wells = EdgeWells(self._edge)
        used = points[np.unique(np.concatenate(list(lines)))]
        reach = float(np.median(norm(used - incidence.feet((site,), used)[:, 0])))
        self._domain: Domain = even_strip(boundary, incidence.sites[site].index, reach)
        self._drawn: FootprintLines = drawn_lines(
            points, lines, self._domain, self._wells, self._edge.curve, self._size
        )
        self._rims = rims
        self._uv, self._points = self._drawn.uv, points[self._drawn.vertex]

    def parts(self, add: Callable[[Array], int]) -> list[SheetPart]:
        """The sheets; points inside them are made vertices."""
        self._check_crossings()
        for _ in range(ROUNDS):
            try:
                found = triangulate(self._uv, self._drawn.segments, self._domain.period)
            except SparseError as error:
                self._fill(error)
                continue
            one_each = self._one_of_each_pair(found)
            planes = {number: self._plane(found, number) for number in one_each}
            bent = [number for number, plane in planes.items() if plane is None]
            if not self._add_where_coarse(found, bent):
                return self._finished(found, planes, add)
        raise GeometryError(
            f"the sheet that the edge {self._name} has with itself near "
            "{at} cannot be triangulated",
            (self._name,),
            at=self._points[0],
        )

    def _check_crossings(self) -> None:
        drawn = self._drawn
        bad = crossings(drawn.uv, drawn.segments, self._domain.period)
        if len(bad):
            rows = np.unique(bad)
            raise CrossingError(
                f"curves cross in the footprint of the edge {self._name} near {{at}}",
                drawn.vertex[drawn.segments[rows]],
                (self._name,),
                self._points[drawn.segments[rows[0], 0]],
            )

    def _fill(self, error: SparseError) -> None:
        """Add points where a periodic domain has too few."""
        if not len(error.spots):
            raise error
        feet, inward = self._domain.lift(error.spots)
        balls = self._tests.balls(feet, inward)
        self._more(error.spots, balls.centre)

    def _more(self, uv: Array, points: Array) -> None:
        self._uv = np.concatenate([self._uv, uv])
        self._points = np.concatenate([self._points, points])

    def _balls(self, found: Triangulation, rows: Ints) -> tuple[Array, Balls]:
        """The feet (k, 3) over the incentres of triangles, and the balls that touch there."""
        weights, _ = incentres(found.corners[rows])
        feet, inward = self._domain.lift(np.einsum("ij,ijk->ik", weights, found.corners[rows]))
        return feet, self._tests.balls(feet, inward)

    def _one_of_each_pair(self, found: Triangulation) -> list[int]:
        """One of the two components in which each sheet is drawn."""

        def ask(rows: Ints, weights: Array) -> Bools:
            feet, inward = self._domain.lift(np.einsum("ij,ijk->ik", weights, found.corners[rows]))
            return self._tests.touches(self._site, self._site, feet, inward)

        name = f"of the edge {self._name} with itself"
        kept = kept_components(found, self._points, ask, name)
        partner = {number: self._partner(found, number) for number in kept}
        for one, other in partner.items():
            if other == one or partner.get(other) != one:
                raise MissingCurveError(
                    f"the sheet {name} near {{at}} has no second side in the edge's footprint",
                    (self._name,),
                    at=self._points[found.triangles[found.component == one][0, 0]],
                )
        # which of the two must not depend on the points inside
        first = {
            number: np.unique(found.triangles[found.component == number]).tolist()
            for number in kept
        }
        return [k for k in kept if first[k] <= first[partner[k]]]

    def _partner(self, found: Triangulation, number: int) -> int:
        """The component that holds the far feet of a component's balls, -1 if none does."""
        rows = np.flatnonzero(found.component == number)
        _, inradius = incentres(found.corners[rows])
        rows = rows[np.argsort(-inradius)[:TESTS]]
        _, balls = self._balls(found, rows)
        uv = self._domain.to_plane(balls.foot, balls.centre)
        held = _holding(found, uv, np.array([p or 0.0 for p in self._domain.period]))
        numbers = found.component[held[held >= 0]]
        values, counts = np.unique(numbers, return_counts=True)
        return int(values[np.argmax(counts)]) if len(values) else -1

    def _plane(self, found: Triangulation, number: int) -> MirrorPlane | None:
        """The plane of symmetry in which a component's sheet lies, None if there is none."""
        rows = np.flatnonzero(found.component == number)
        _, inradius = incentres(found.corners[rows])
        _, balls = self._balls(found, rows[np.argsort(-inradius)[:TESTS]])
        corners = np.unique(found.triangles[rows])
        return self._flat.plane(np.concatenate([self._points[corners], balls.centre]))

    def _add_where_coarse(self, found: Triangulation, bent: Sequence[int]) -> bool:
        """Add inner points where triangles leave their sheet by much; whether there were any."""
        rows = np.flatnonzero(np.isin(found.component, bent))
        if not len(rows):
            return False
        corners = self._points[found.triangles[rows]]
        sides = norm(corners - np.roll(corners, 1, axis=1)).max(axis=1)
        feet, inward = self._domain.lift(found.centroids[rows])
        balls = self._tests.balls(feet, inward)
        off = norm(balls.centre - corners.mean(axis=1))
        coarse = (off > COARSE * sides) & (balls.site == self._site)
        if coarse.any():
            self._more(found.centroids[rows][coarse], balls.centre[coarse])
        return bool(coarse.any())

    def _finished(
        self,
        found: Triangulation,
        planes: dict[int, MirrorPlane | None],
        add: Callable[[Array], int],
    ) -> list[SheetPart]:
        parts = [
            part
            for number, plane in planes.items()
            if plane is not None
            for part in self._flat.sheets(plane, self._border(found, number))
        ]
        planes = {n: plane for n, plane in planes.items() if plane is None}
        drawn = len(self._drawn.vertex)
        numbers = np.full(len(self._points), -1, dtype=np.int64)
        numbers[:drawn] = self._drawn.vertex
        for k in np.unique(found.triangles[np.isin(found.component, list(planes))]):
            if k >= drawn:
                numbers[k] = add(self._points[k])
        for number in planes:
            rows = np.flatnonzero(found.component == number)
            triangles = found.triangles[rows]
            surface: SurfaceElement = self._surface(found, rows)
            corners = self._points[triangles]
            normals = cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
            wanted = surface.normal(corners.mean(axis=1))
            turned = triangles[:, ::-1] if float(dot(normals, wanted).sum()) < 0 else triangles
            parts.append(SheetPart((self._site, self._site), surface, numbers[turned]))
        return parts

    def _border(self, found: Triangulation, number: int) -> Ints:
        """The segments (k, 2) of vertices of the complex that border a component."""
        inside = found.triangles[found.component == number]
        both = np.sort(np.stack([inside, np.roll(inside, -1, axis=1)], axis=-1).reshape(-1, 2))
        sides = {(int(a), int(b)) for a, b in both}
        drawn = self._drawn
        own = [k for k, (a, b) in enumerate(drawn.segments.tolist()) if (a, b) in sides]
        return drawn.vertex[drawn.segments[own]]

    def _surface(self, found: Triangulation, rows: Ints) -> SelfSheetSurface:
        """The surface of the sheet that triangles with given numbers are drawn of."""
        spots = np.einsum("ij,tjk->tik", SPREAD, found.corners[rows]).reshape(-1, 2)
        feet, inward = self._domain.lift(spots)
        balls = self._tests.balls(feet, inward)
        good = balls.site == self._site
        curve = self._edge.curve
        t = np.stack([curve.parameter(feet), curve.parameter(balls.foot)], axis=1)[good]
        inside = np.unique(found.triangles[rows])
        rims = tuple(
            rim
            for rim, on in zip(self._rims, self._drawn.of_line, strict=True)
            if rim is not None and np.isin(on, inside).all()
        )
        return SelfSheetSurface(
            self._incidence, self._site, self._wells, balls.centre[good], t, rims
        )


def _holding(found: Triangulation, uv: Array, period: Array) -> Ints:
    """The triangle that holds each of points (k, 2), -1 if none does."""
    a, b, c = (found.corners[:, k] for k in range(3))
    result = np.full(len(uv), -1, dtype=np.int64)
    for k, spot in enumerate(uv):
        for i in (0, -1, 1):
            for j in (0, -1, 1):
                at = spot + np.array([i, j]) * period
                inside = np.ones(len(a), dtype=np.bool_)
                for p, q in ((a, b), (b, c), (c, a)):
                    inside &= (q - p)[:, 0] * (at - p)[:, 1] >= (q - p)[:, 1] * (at - p)[:, 0]
                if result[k] < 0 and inside.any():
                    result[k] = int(np.argmax(inside))
    return result
