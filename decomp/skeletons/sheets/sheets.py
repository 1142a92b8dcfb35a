"""Sheets: the pieces of Vor(a, b) that the skeleton's curves cut out.

All curves that border sheets of one pair of sites are drawn in a plane domain, in which the sheets
are graphs: the footprint on one of the two sites, or a plane that the sheets lie in. They cut the
domain into components; each is in the skeleton or not, as exact queries inside it tell.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

import numpy as np
from scipy.sparse import coo_array  # type: ignore[import-untyped]
from scipy.sparse.csgraph import connected_components  # type: ignore[import-untyped]

from decomp.attempts import Way, first_of
from decomp.complex.plane.planar import MergedError, SparseError, Triangulation
from decomp.errors import GeometryError
from decomp.skeletons.curves.incidence import Incidence
from decomp.skeletons.sheets.component_votes import MissingCurveError, kept_components
from decomp.skeletons.sheets.drawn_sheets import (
    CrossingError,
    DrawnCurves,
    Footprint,
    SheetPart,
    UnevenError,
    facing,
)
from decomp.skeletons.sheets.flat_parts import flat_parts
from decomp.skeletons.sheets.sheet_domains import FLAT, Drawing, SheetDomains
from decomp.skeletons.sheets.sheet_surface import SheetSurface
from decomp.skeletons.sheets.sheet_tests import SheetTests
from decomp.vectors import Array, Bools, Ints


class NoSheetError(GeometryError):
    """No part of a drawing is a sheet: there is none, or it cannot be drawn in this way."""


class SheetMaker:
    """Triangulates the sheets of one region over given vertices.

    Args:
        incidence: of the region.
        points: (n, 3) all vertices.
        add: makes a point (3,) a vertex and returns its number.
        finest: whether the curves will not be sampled more finely.
    """

    def __init__(
        self,
        incidence: Incidence,
        points: Array,
        add: Callable[[Array], int],
        finest: bool = False,
    ) -> None:
        self._finest = finest
        self._incidence, self._points = incidence, points
        self._add = add
        self._tests = SheetTests(incidence)
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
            raise CrossingError(
                "curves have one chord near {at}",
                segments,
                self._names(pair),
                self._points[used[0]],
            )
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
        after: tuple[type[GeometryError], ...]
        after = (UnevenError, MissingCurveError, MergedError, NoSheetError)
        if self._finest:
            after = (*after, CrossingError)

        def way(what: str, other: Drawing, *errors: type[GeometryError]) -> Way[list[SheetPart]]:
            curves = self._curves(pair, used, points, local, other)
            return Way(what, lambda: self._drawn(pair, curves, surface), errors)

        def ways() -> Iterator[Way[list[SheetPart]]]:
            yield way("drawn in the footprint", drawing, *after)
            for other in self._domains.others(pair, points, feet):
                yield way("drawn otherwise", other, *after, CrossingError, SparseError)

        try:
            return first_of(ways())
        except GeometryError as error:
            kinds = {type(error).__name__, *(each.kind for each in error.tries)}
            if NoSheetError.__name__ in kinds:
                return []  # in no drawing is there one
            raise

    def _names(self, pair: tuple[int, int]) -> tuple[str, ...]:
        return tuple(self._incidence.sites[site].name for site in pair)

    def _curves(
        self, pair: tuple[int, int], used: Ints, points: Array, segments: Ints, drawing: Drawing
    ) -> DrawnCurves:
        footprint = None
        if drawing.domain is not None:
            site, far = pair[drawing.column], pair[1 - drawing.column]
            footprint = Footprint(self._tests, drawing.domain, site, far)
        names = self._names(pair)
        return DrawnCurves(used, points, drawing.uv, segments, footprint, names, "the footprint")

    def _drawn(
        self, pair: tuple[int, int], curves: DrawnCurves, surface: SheetSurface
    ) -> list[SheetPart]:
        """The sheets between their borders as they are drawn."""
        curves.check_crossings()
        found, kept = curves.triangulated(lambda found: self._kept(pair, found, curves, surface))
        if not kept:
            raise NoSheetError("no sheet is seen near {at}", curves.sites, curves.points[0])
        if len(curves.points) > len(curves.vertex):
            feet = self._incidence.feet(pair, curves.points)
            surface = SheetSurface(self._incidence, pair, curves.points, feet)
        numbers = curves.numbered(found.triangles[np.isin(found.component, kept)], self._add)
        parts = []
        for number in kept:
            triangles = found.triangles[found.component == number]
            corners = curves.points[triangles].reshape(-1, 3)
            normals = surface.normal(corners).reshape(-1, 3, 3).sum(axis=1)
            turned = facing(curves.points, triangles, normals)
            parts.append(SheetPart(pair, surface, numbers[turned]))
        return parts

    def _kept(
        self,
        pair: tuple[int, int],
        found: Triangulation,
        curves: DrawnCurves,
        surface: SheetSurface,
    ) -> list[int]:
        """Numbers of the components that are sheets."""

        def ask(rows: Ints, weights: Array) -> Bools:
            if curves.footprint is not None:
                return curves.footprint.holds(found, rows, weights)
            where = np.einsum("ij,ijk->ik", weights, curves.points[found.triangles[rows]])
            return self._tests.in_skeleton(pair, where, surface)

        name = f"between {' and '.join(curves.sites)}"
        return kept_components(found, curves.points, ask, name)


def segments_of(lines: Sequence[Ints]) -> Ints:
    """Unique segments (k, 2) of polylines."""
    parts = [np.stack([line[:-1], line[1:]], axis=1) for line in lines if len(line) > 1]
    if not parts:
        return np.empty((0, 2), dtype=np.int64)
    both = np.sort(np.concatenate(parts), axis=1)
    return np.unique(both, axis=0)


def _encloses(segments: Ints) -> bool:
    """Whether segments (m, 2) of vertices make a loop."""
    used, local = np.unique(segments, return_inverse=True)
    one, other = local.reshape(-1, 2).T
    joins = coo_array((np.ones(len(one)), (one, other)), shape=(len(used), len(used)))
    return len(segments) > len(used) - int(connected_components(joins, directed=False)[0])
