"""Sheets of a curved reentrant edge with itself.

They are drawn in the edge's own footprint, where each stands twice, once for each of its feet. The
curves that border them cut the footprint into components, which go together in pairs: the ball of
a point in the one has its far foot in the other. One of each pair is kept.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from decomp.complex.footprints.domain_base import Domain
from decomp.complex.footprints.domain_edges import even_strip
from decomp.complex.model import SurfaceElement
from decomp.complex.plane.planar import Triangulation
from decomp.skeletons.curves.edge_wells import EdgeWells
from decomp.skeletons.curves.incidence import Incidence
from decomp.skeletons.curves.rim_curve import RimCurve
from decomp.skeletons.sheets.component_votes import MissingCurveError, incentres, kept_components
from decomp.skeletons.sheets.drawn_sheets import DrawnCurves, Footprint, SheetPart, facing
from decomp.skeletons.sheets.footprint_lines import FootprintLines, drawn_lines
from decomp.skeletons.sheets.mirror_plane import MirrorPlane
from decomp.skeletons.sheets.plane_sheets import PlaneSheets
from decomp.skeletons.sheets.self_surface import SelfSheetSurface
from decomp.skeletons.sheets.sheet_tests import SheetTests
from decomp.vectors import Array, Bools, Ints, norm

TESTS = 5
"""Triangles of each component whose far feet are asked for."""

SPREAD = np.array([[1, 1, 1], [4, 1, 1], [1, 4, 1], [1, 1, 4]]) / np.array([[3], [6], [6], [6]])
"""Barycentric coordinates (4, 3) of the places in triangles where balls are made known."""


class SelfSheetMaker:
    """Triangulates the sheets of edges with themselves over given vertices.

    Args:
        incidence: of the region.
        points: (n, 3) all vertices.
        add: makes a point (3,) a vertex and returns its number.
    """

    def __init__(self, incidence: Incidence, points: Array, add: Callable[[Array], int]) -> None:
        self._incidence, self._points, self._add = incidence, points, add
        self._tests = SheetTests(incidence)

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
        domain: Domain = even_strip(boundary, incidence.sites[site].index, reach)
        self._drawn: FootprintLines = drawn_lines(
            points, lines, domain, self._wells, self._edge.curve, self._size
        )
        self._rims = rims
        self._footprint = Footprint(tests, domain, site, site)
        self._curves = DrawnCurves(
            self._drawn.vertex,
            points[self._drawn.vertex],
            self._drawn.uv,
            self._drawn.segments,
            self._footprint,
            (self._name,),
            f"the footprint of the edge {self._name}",
        )

    def parts(self, add: Callable[[Array], int]) -> list[SheetPart]:
        """The sheets; points inside them are made vertices."""
        self._curves.check_crossings()
        found, one_each = self._curves.triangulated(self._one_of_each_pair, self._bent)
        planes = {number: self._plane(found, number) for number in one_each}
        parts = [
            part
            for number, plane in planes.items()
            if plane is not None
            for part in self._flat.sheets(plane, self._border(found, number))
        ]
        bent = [number for number, plane in planes.items() if plane is None]
        numbers = self._curves.numbered(found.triangles[np.isin(found.component, bent)], add)
        for number in bent:
            rows = np.flatnonzero(found.component == number)
            triangles = found.triangles[rows]
            surface: SurfaceElement = self._surface(found, rows)
            points = self._curves.points
            turned = facing(points, triangles, surface.normal(points[triangles].mean(axis=1)))
            parts.append(SheetPart((self._site, self._site), surface, numbers[turned]))
        return parts

    def _bent(self, found: Triangulation, numbers: list[int]) -> list[int]:
        """The components whose sheets lie in no plane of symmetry."""
        return [number for number in numbers if self._plane(found, number) is None]

    def _one_of_each_pair(self, found: Triangulation) -> list[int]:
        """One of the two components in which each sheet is drawn."""

        def ask(rows: Ints, weights: Array) -> Bools:
            return self._footprint.holds(found, rows, weights)

        name, points = f"of the edge {self._name} with itself", self._curves.points
        kept = kept_components(found, points, ask, name)
        partner = {number: self._partner(found, number) for number in kept}
        for one, other in partner.items():
            if other == one or partner.get(other) != one:
                raise MissingCurveError(
                    f"the sheet {name} near {{at}} has no second side in the edge's footprint",
                    (self._name,),
                    at=points[found.triangles[found.component == one][0, 0]],
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
        _, balls = self._footprint.balls_inside(found, rows)
        uv = self._footprint.domain.to_plane(balls.foot, balls.centre)
        held = _holding(found, uv, np.array([p or 0.0 for p in self._curves.period]))
        numbers = found.component[held[held >= 0]]
        values, counts = np.unique(numbers, return_counts=True)
        return int(values[np.argmax(counts)]) if len(values) else -1

    def _plane(self, found: Triangulation, number: int) -> MirrorPlane | None:
        """The plane of symmetry in which a component's sheet lies, None if there is none."""
        rows = np.flatnonzero(found.component == number)
        _, inradius = incentres(found.corners[rows])
        _, balls = self._footprint.balls_inside(found, rows[np.argsort(-inradius)[:TESTS]])
        corners = np.unique(found.triangles[rows])
        return self._flat.plane(np.concatenate([self._curves.points[corners], balls.centre]))

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
        feet, balls = self._footprint.balls(spots)
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
