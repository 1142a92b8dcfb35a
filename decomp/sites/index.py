"""Point queries on a model: which region, which site is nearest, how far, and where."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from decomp.boundary.topology import RegionBoundary
from decomp.csg.halfspaces import HalfSpaceForm
from decomp.errors import GeometryError, InputError
from decomp.shown import Shown
from decomp.sites.box_tree import BoxTree, box_tree
from decomp.sites.candidates import CandidateTree, candidate_tree
from decomp.sites.crowded import FaceFinder, FaceLookup
from decomp.sites.nearest import nearest_in_region
from decomp.sites.occupancy import Labels, OccupancyTree, labels_of, occupancy_tree, private
from decomp.sites.occupancy_leaves import OUTSIDE
from decomp.sites.points import QUERIES_AT_ONCE, checked_points
from decomp.sites.site import Site, sites_of
from decomp.sites.site_boxes import bounds_of
from decomp.sites.site_table import RegionSites, region_sites
from decomp.vectors import Array, Bools, Ints


@dataclass(frozen=True, eq=False)
class Nearest(Shown):
    """The nearest sites of n points.

    Args:
        site: numbers (n,), indices into `Geometry.sites`.
        distance: to the boundary (n,), never negative.
        foot: the nearest boundary points (n, 3).
        region: the region (n,) that holds each point, -1 outside.
    """

    site: Labels
    distance: Array
    foot: Array
    region: Labels


@dataclass(frozen=True, eq=False)
class RegionIndex:
    """All that is needed for the points of one region.

    Args:
        boundary: of the region.
        sites: as arrays.
        candidates, boxes: from which the nearest are found.
        finder: names faces, where a carrier has several.
        first: the number of the region's first site in `SiteIndex.sites`.
    """

    boundary: RegionBoundary
    sites: RegionSites
    candidates: CandidateTree
    boxes: BoxTree
    finder: FaceFinder
    first: int


class SiteIndex:
    """Exact nearest-site queries, ready for any number of points.

    A point inside a region looks for that region's boundary; a point outside all regions looks
    for the outside's. Spatial structures are built when they are first needed.

    Args:
        form: the model's carriers and program.
        boundaries: one for each region.
        outside: the boundary of the outside of all regions, or what makes it.
        face_at: tells which faces of a region (-1 for the outside) hold points of a carrier; needed
            where a carrier has several faces of one region.
    """

    def __init__(
        self,
        form: HalfSpaceForm,
        boundaries: Sequence[RegionBoundary],
        outside: RegionBoundary | Callable[[], RegionBoundary],
        face_at: FaceLookup | None = None,
    ) -> None:
        self._form = form
        self._boundaries = tuple(boundaries)
        self._outside = outside
        self._face_at: FaceLookup = face_at or _no_lookup
        self._parts: dict[int, RegionIndex] = {}
        self._laid_out: dict[int, RegionSites] = {}

    def unbuilt(self) -> SiteIndex:
        """The same with no spatial structure built yet."""
        return SiteIndex(self._form, self._boundaries, self._outside, self._face_at)

    @cached_property
    def occupancy(self) -> OccupancyTree:
        """The octree that tells regions apart."""
        boxes = np.array([bounds_of(b) for b in self._boundaries])
        return occupancy_tree(
            self._form, np.array([boxes[:, 0].min(axis=0), boxes[:, 1].max(axis=0)])
        )

    @cached_property
    def sites(self) -> tuple[Site, ...]:
        """All sites: of the regions in their order, then of the outside."""
        labels = [*range(len(self._boundaries)), OUTSIDE]
        return tuple(
            site
            for label in labels
            for site in sites_of(self.boundary(label), label, self._sites(label))
        )

    @cached_property
    def _outer(self) -> RegionBoundary:
        return self._outside() if callable(self._outside) else self._outside

    def boundary(self, region: int) -> RegionBoundary:
        """The boundary of a region, or of the outside (-1)."""
        return self._outer if region == OUTSIDE else self._boundaries[region]

    def part(self, label: int) -> RegionIndex:
        """What the queries of a region, or of the outside (-1), need; made once."""
        if label not in self._parts:
            boundary, sites = self.boundary(label), self._sites(label)
            before = range(len(self._boundaries) if label == OUTSIDE else label)
            self._parts[label] = RegionIndex(
                boundary,
                sites,
                candidate_tree(self.occupancy, sites.table, label),
                box_tree(sites.table),
                FaceFinder(boundary, label, self.occupancy, self._face_at),
                sum(self._sites(k).count for k in before),
            )
        return self._parts[label]

    def region_of(self, points: ArrayLike) -> Labels:
        """The region (n,) that holds each point (n, 3), -1 outside.

        A point within rounding of a boundary goes to either side.
        """
        given = checked_points(points)
        labels = np.empty(len(given), dtype=np.int32)
        labels_of(private(self.occupancy), given, labels)
        return labels

    def contains(self, points: ArrayLike) -> Bools:
        """Whether points (n, 3) are in any region."""
        return np.asarray(self.region_of(points) != OUTSIDE)

    def distance(self, points: ArrayLike) -> Array:
        """Distance (n,) from points (n, 3) to the boundary of their region, negative inside."""
        found = self.nearest(points)
        np.negative(found.distance, out=found.distance, where=found.region != OUTSIDE)
        return found.distance

    def nearest(self, points: ArrayLike) -> Nearest:
        """The nearest site, distance and foot for points (n, 3), and the regions they are in.

        Where several sites are equally near, a face comes before an edge and an edge before a
        vertex, then the lower number.
        """
        given = checked_points(points)
        n = len(given)
        result = Nearest(
            np.empty(n, dtype=np.int32),
            np.empty(n),
            np.empty((n, 3)),
            np.empty(n, dtype=np.int32),
        )
        labels_of(private(self.occupancy), given, result.region)
        for start in range(0, n, QUERIES_AT_ONCE):
            block = slice(start, min(start + QUERIES_AT_ONCE, n))
            for label in np.unique(result.region[block]):
                self._fill(int(label), given[block], result, block)
        return result

    def _fill(self, label: int, points: Array, result: Nearest, block: slice) -> None:
        """Find the nearest sites of those points of a block that carry a label."""
        part = self.part(label)
        labels = result.region[block]
        found = np.empty(len(points), dtype=np.int64)
        slots = np.empty(len(points), dtype=np.int64)
        feet = result.foot[block]
        nearest_in_region(
            private(self.occupancy),
            part.sites.table,
            part.candidates,
            part.boxes,
            label,
            points,
            labels,
            found,
            result.distance[block],
            feet,
            slots,
        )
        here = np.flatnonzero(labels == label)
        found, slots = found[here], slots[here]
        if (found < 0).any():
            lost = points[here[found < 0][0]]
            raise GeometryError(f"no boundary of region {label} found from {{at}}", at=lost)
        site = part.sites.site_of[found]
        faces = len(part.boundary.faces)
        crowded = np.zeros(len(here), dtype=np.bool_)
        crowded[found < faces] = part.sites.crowded[found[found < faces]] > 0
        if crowded.any():
            carriers = part.sites.table.face_carriers[found[crowded]]
            site[crowded] = part.finder.find(carriers, feet[here[crowded]], slots[crowded])
        result.site[block][here] = part.first + site

    def _sites(self, label: int) -> RegionSites:
        if label not in self._laid_out:
            self._laid_out[label] = region_sites(self.boundary(label), self.occupancy.table)
        return self._laid_out[label]


def _no_lookup(region: int, carrier: int, points: Array) -> Ints:
    raise InputError(
        f"carrier {carrier} has several faces of region {region}: SiteIndex needs face_at"
    )
