"""Sheets of an edge with itself: they lie in the edge's planes of symmetry."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from decomp.complex.planar import crossings, triangulate
from decomp.errors import GeometryError
from decomp.medial.incidence import Incidence
from decomp.medial.sheets import CrossingError, MissingCurveError, SheetPart, segments_of
from decomp.sites import SiteIndex
from decomp.vectors import Array, Bools, Ints, cross, dot, norm, place

FLAT = 1e-9
TESTS = 7


@dataclass(frozen=True, eq=False)
class MirrorPlane:
    """A plane of symmetry as a surface of a complex: `point` and unit `direction` across."""

    point: Array
    direction: Array

    def place(self, points: Array) -> Array:
        """Points (k, 3) moved to the plane."""
        return np.asarray(points - self._off(points)[:, None] * self.direction)

    def normal(self, points: Array) -> Array:
        """The plane's unit normal, once for each point."""
        return np.broadcast_to(self.direction, points.shape).copy()

    def mirrored(self, points: Array) -> Array:
        """The mirror images of points (k, 3)."""
        return np.asarray(points - 2 * self._off(points)[:, None] * self.direction)

    def _off(self, points: Array) -> Array:
        return np.asarray((points - self.point) @ self.direction)


class SelfSheetMaker:
    """Triangulates the sheets of edges with themselves over given vertices."""

    def __init__(self, index: SiteIndex, incidence: Incidence, points: Array) -> None:
        self._index, self._incidence, self._points = index, incidence, points
        self._size = incidence.boundary.diagonal

    def sheets(self, site: int, lines: Sequence[Ints]) -> list[SheetPart]:
        """The sheets of one edge with itself.

        Raises:
            CrossingError: the polylines must be finer.
            GeometryError: they lie in no plane.
        """
        found: list[SheetPart] = []
        for group in self._by_plane(site, lines):
            found.extend(self._in_plane(site, group))
        return found

    def _by_plane(self, site: int, lines: Sequence[Ints]) -> list[list[Ints]]:
        """Lines that hang together, by the plane that they lie in."""
        groups: list[list[Ints]] = []
        for line in lines:
            held = set(line.tolist())
            near = [g for g in groups if any(held & set(other.tolist()) for other in g)]
            groups = [g for g in groups if all(g is not other for other in near)]
            groups.append([line, *(other for g in near for other in g)])
        return groups

    def _in_plane(self, site: int, lines: Sequence[Ints]) -> list[SheetPart]:
        segments = segments_of(lines)
        used = np.unique(segments)
        points = self._points[used]
        middle = points.mean(axis=0)
        _, spread, axes = np.linalg.svd(points - middle, full_matrices=False)
        if spread[-1] > FLAT * self._size * np.sqrt(len(points)):
            raise GeometryError(
                f"the sheet of the edge {self._incidence.sites[site].name} with itself near "
                f"{place(middle)} lies in no plane; such sheets are not supported"
            )
        plane = MirrorPlane(middle, axes[2])
        local = np.searchsorted(used, segments)
        uv = (points - middle) @ axes[:2].T
        bad = crossings(uv, local)
        if len(bad):
            rows = np.unique(bad)
            raise CrossingError(
                f"curves cross in the plane of symmetry near {place(points[local[rows[0], 0]])}",
                used[local[rows]],
            )
        found = triangulate(uv, local)
        parts = []
        for number in range(found.components):
            triangles = found.triangles[found.component == number]
            if self._is_sheet(site, plane, points[triangles].mean(axis=1)):
                corners = points[triangles]
                normals = cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
                turned = triangles[:, ::-1] if float(dot(normals, axes[2]).sum()) < 0 else triangles
                parts.append(SheetPart((site, site), plane, used[turned]))
        return parts

    def _is_sheet(self, site: int, plane: MirrorPlane, points: Array) -> bool:
        rows = np.linspace(0, len(points) - 1, min(TESTS, len(points))).astype(np.int64)
        votes = self._in_skeleton(site, plane, points[rows])
        if votes.any() and not votes.all():
            raise MissingCurveError(
                f"the sheet of the edge {self._incidence.sites[site].name} with itself has no "
                f"clear end near {place(points[rows[~votes][0]])}"
            )
        return bool(votes.all())

    def _in_skeleton(self, site: int, plane: MirrorPlane, points: Array) -> Bools:
        """Whether the edge is nearest to points (k, 3), in two feet that mirror each other."""
        found = self._index.nearest(points)
        good = (found.region == self._incidence.region) & (found.site == site)
        image = plane.mirrored(found.foot)
        apart = norm(image - found.foot) > 1e-6 * self._size
        toward = self._index.nearest(points + 0.3 * (image - points))
        touched = np.abs(toward.distance - 0.7 * found.distance) <= 1e-9 * self._size
        return np.asarray(good & apart & touched)
