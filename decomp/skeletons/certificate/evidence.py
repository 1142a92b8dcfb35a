"""What the certificate of one region's skeleton is computed from."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from decomp.boundary.topology import RegionBoundary
from decomp.complex.model import Complex
from decomp.sites import SiteIndex
from decomp.sites.site import Site
from decomp.skeletons.balls.region_context import RegionContext
from decomp.skeletons.model import Cell, Reflexive, Sheet, Skeleton
from decomp.vectors import Array, Ints


@dataclass(frozen=True, eq=False)
class Evidence:
    """A region's skeleton before it has a certificate.

    Args:
        index: queries on the model.
        region: index of the region.
        diagonal: the model's, to which lengths are relative.
        complex: all triangles and lines of the model.
        radius: distance (n,) of the complex's points from the boundary.
        sheets, reflexive, face_sides, cells, face_cells: as in `RegionSkeleton`.
    """

    index: SiteIndex
    region: int
    diagonal: float
    complex: Complex
    radius: Array
    sheets: tuple[Sheet, ...]
    reflexive: tuple[Reflexive, ...]
    face_sides: tuple[tuple[tuple[int, int], ...], ...]
    cells: tuple[Cell, ...]
    face_cells: tuple[Cell, ...]

    @staticmethod
    def of(skeleton: Skeleton, index: SiteIndex, region: int) -> Evidence:
        """What a finished skeleton's certificate can be computed from again."""
        parts = skeleton.regions[region]
        return Evidence(
            index,
            region,
            skeleton.diagonal,
            skeleton.complex,
            skeleton.radius,
            parts.sheets,
            parts.reflexive,
            parts.face_sides,
            parts.cells,
            parts.face_cells,
        )

    @cached_property
    def context(self) -> RegionContext:
        """Of the region."""
        return RegionContext(self.index, self.region)

    @property
    def boundary(self) -> RegionBoundary:
        """The region's exact boundary."""
        return self.index.boundary(self.region)

    @property
    def sites(self) -> tuple[Site, ...]:
        """All sites of the model."""
        return self.index.sites

    def sheet_triangles(self) -> Ints:
        """Triangles (m, 3) of all sheets."""
        parts = [self.complex.patches[sheet.patch].triangles for sheet in self.sheets]
        return np.concatenate([np.empty((0, 3), dtype=np.int64), *parts])

    def reflexive_segments(self) -> Ints:
        """Segments (m, 2) of all reflexive curves."""
        chains = [self.complex.lines[r.line].vertices for r in self.reflexive if r.line is not None]
        parts = [np.stack([chain[:-1], chain[1:]], axis=1) for chain in chains]
        return np.concatenate([np.empty((0, 2), dtype=np.int64), *parts])

    def reflexive_points(self) -> Ints:
        """Vertices (m,) of all isolated reflexive points."""
        return np.array(
            [r.vertex for r in self.reflexive if r.vertex is not None], dtype=np.int64
        ).reshape(-1)

    def skeleton_vertices(self) -> Ints:
        """All vertices (k,) of sheets and reflexive loci."""
        parts = (self.sheet_triangles(), self.reflexive_segments(), self.reflexive_points())
        return np.unique(np.concatenate([part.reshape(-1) for part in parts]))


@dataclass(frozen=True, eq=False)
class Worst:
    """A figure and where it is attained.

    Args:
        value: relative to the model's diagonal.
        point: (3,), None if the figure is not tied to a place.
        sites: indices of the sites concerned.
    """

    value: float
    point: Array | None = None
    sites: tuple[int, ...] = ()


def worst_of(found: Iterable[Worst]) -> Worst:
    """The one with the largest value; a value that is no number counts as infinite."""
    result = Worst(0.0)
    for each in found:
        value = each.value if np.isfinite(each.value) else np.inf
        if value > result.value:
            result = Worst(value, each.point, each.sites)
    return result
