"""Sheets of an edge with itself that lie in a plane of symmetry, triangulated in that plane."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from decomp.complex.plane.planar import Triangulation
from decomp.skeletons.sheets.component_votes import kept_components
from decomp.skeletons.sheets.drawn_sheets import DrawnCurves, SheetPart
from decomp.skeletons.sheets.mirror_plane import MirrorPlane
from decomp.skeletons.sheets.sheet_tests import SheetTests
from decomp.tolerance import TOLERANCE
from decomp.vectors import Array, Bools, Ints


class PlaneSheets:
    """The plane sheets of one edge with itself.

    Args:
        tests: exact queries of the region.
        points: (n, 3) all vertices of the complex.
        size: of the region.
        site: the edge.
    """

    def __init__(self, tests: SheetTests, points: Array, size: float, site: int) -> None:
        self._tests, self._points, self._size, self._site = tests, points, size, site

    def plane(self, points: Array) -> MirrorPlane | None:
        """The plane that points (k, 3) lie in, None if they leave it or determine none."""
        middle = points.mean(axis=0)
        _, spread, axes = np.linalg.svd(points - middle, full_matrices=False)
        limit = TOLERANCE * self._size * np.sqrt(len(points))
        if len(points) < 3 or spread[-1] > limit or spread[1] <= limit:
            return None
        return MirrorPlane(middle, axes[2])

    def within(self, lines: Sequence[Ints]) -> list[SheetPart]:
        """The sheets that polylines of vertices border in the plane that all of them lie in.

        There are none if they lie in no plane. Where a sphere about a point holds the whole edge,
        a sheet that ends in that point can be drawn in its plane only.
        """
        plane = self.plane(self._points[np.unique(np.concatenate(list(lines)))])
        if plane is None:
            return []
        return self.sheets(
            plane, np.concatenate([np.stack([line[:-1], line[1:]], axis=1) for line in lines])
        )

    def sheets(self, plane: MirrorPlane, segments: Ints) -> list[SheetPart]:
        """The sheets in a plane that segments (k, 2) of vertices border.

        Raises:
            CrossingError: the segments must be finer.
            MissingCurveError: part of a component is a sheet and part is not.
        """
        segments = np.unique(np.sort(segments, axis=1), axis=0)
        used, local = np.unique(segments, return_inverse=True)
        local = local.reshape(segments.shape)
        points, name = self._points[used], self._tests.name(self._site)
        uv = plane.coordinates(points)
        curves = DrawnCurves(used, points, uv, local, None, (name,), "a plane of symmetry")
        curves.check_crossings()

        def kept(found: Triangulation) -> list[int]:
            def ask(rows: Ints, weights: Array) -> Bools:
                where = np.einsum("ij,ijk->ik", weights, points[found.triangles[rows]])
                return self._tests.mirror(self._site, where, plane.mirrored)

            return kept_components(found, points, ask, "of an edge with itself")

        flat, numbers = curves.triangulated(kept)
        return [
            SheetPart((self._site, self._site), plane, used[flat.triangles[flat.component == k]])
            for k in numbers
        ]
