"""The complex of all regions of a model, and the skeleton that it shows."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from decomp.complex.refining.refine import refined
from decomp.geometry import Geometry
from decomp.skeletons.balls.queries import region_queries
from decomp.skeletons.certificate.certificate import VOLUME, Certified, explained, shortcomings
from decomp.skeletons.certificate.shortcoming import Shortcoming
from decomp.skeletons.curves.region_curves import RegionCurves
from decomp.skeletons.drafts import Draft
from decomp.skeletons.model import RegionSkeleton, Skeleton
from decomp.skeletons.traced_region import TracedRegion
from decomp.vectors import Array


@dataclass(frozen=True, eq=False)
class Result:
    """What has come of a try.

    Args:
        skeleton: None if it fails its certificate.
        failures: why.
        excess: (r,) how many times what is allowed the largest error of a volume or chord is, of
            each region; 0 where none is too large, or more than they fails.
    """

    skeleton: Skeleton | None
    failures: list[Shortcoming]
    excess: Array


class Whole:
    """The complex of all regions, refined, and what its parts are."""

    def __init__(
        self,
        geometry: Geometry,
        relative: float,
        fineness: Array,
        curves: Sequence[RegionCurves],
        draft: Draft,
    ) -> None:
        self._geometry, self._relative = geometry, relative
        self._curves, self._draft = curves, draft
        self.complex, self._number = refined(
            draft.complex, draft.patch_limits(fineness * geometry.diagonal)
        )

    def result(self) -> Result:
        """The finished skeleton, or what its certificate lacks."""
        geometry = self._geometry
        radius = self._radius()
        regions: list[RegionSkeleton] = []
        failures: list[Shortcoming] = []
        short: set[str] = set()
        for number in range(len(geometry.regions)):
            region, found = self._region(number, radius)
            regions.append(region)
            short |= set(shortcomings(found.certificate, self._relative))
            lines = explained(found, self._relative, geometry.sites)
            failures += [replace(line, text=f"region {region.name}: {line.text}") for line in lines]
        made = Skeleton(
            geometry.model.name,
            geometry.diagonal,
            self._relative * geometry.diagonal,
            geometry.sites,
            self.complex,
            radius,
            tuple(regions),
            geometry.model.source,
        )
        return Result(
            None if failures else made,
            failures,
            self._excess(regions)
            if short and short <= {"volume_error", "chord_error"}
            else np.zeros(len(regions)),
        )

    def _excess(self, regions: Sequence[RegionSkeleton]) -> Array:
        found = [region.certificate for region in regions]
        return np.array(
            [max(one.volume_error / VOLUME, one.chord_error / self._relative) for one in found]
        )

    def _radius(self) -> Array:
        points = self.complex.points
        radius = np.zeros(len(points))
        boundary = [p.triangles for p in self.complex.patches[: len(self._draft.surface.patches)]]
        on = np.zeros(len(points), dtype=np.bool_)
        for triangles in boundary:
            on[triangles] = True
        rows = np.flatnonzero(~on)
        index = self._geometry.index
        for region in range(len(self._geometry.regions)):
            inside, depth = region_queries(index, region).depth(points[rows])
            radius[rows[inside]] = depth[inside]
            rows = rows[~inside]
        if len(rows):
            radius[rows] = index.nearest(points[rows]).distance
        return radius

    def _region(self, number: int, radius: Array) -> tuple[RegionSkeleton, Certified]:
        draft, boundary = self._draft, self._geometry.regions[number]
        traced = TracedRegion(
            number,
            self._curves[number],
            draft.parts[number],
            draft.sheet_patches[number],
            draft.trims[number],
            draft.part_lines[number],
            draft.surface.face_sides(number, len(boundary.faces)),
        )
        return traced.finished(self._geometry, self.complex, radius, self._number)
