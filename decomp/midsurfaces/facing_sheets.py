"""Sheets that can be asked at which angle a point of theirs sees its two feet."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from decomp.boundary.topology import RegionBoundary
from decomp.errors import InputError
from decomp.sites.site import Site
from decomp.skeletons.balls.fields import support_fields
from decomp.skeletons.balls.supports import support_table
from decomp.skeletons.model import Skeleton
from decomp.skeletons.sheets.mirror_plane import MirrorPlane
from decomp.skeletons.sheets.sheet_family import CLEAR
from decomp.skeletons.sheets.sheet_surface import SheetSurface
from decomp.vectors import Array, dot, nearest_rows, norm

SAMPLES_ASIDE = 2
"""So many samples beside the nearest one feet are looked for too."""


class FacingSheet(Protocol):
    """A sheet's exact surface."""

    def place(self, points: Array) -> Array:
        """Move points (k, 3) straight onto the surface."""
        ...

    def facing(self, points: Array) -> tuple[Array, Array]:
        """Angle (k,) between the feet of points (k, 3) on it, nan where there is none; radius."""
        ...


@dataclass(frozen=True, eq=False)
class MirrorSheet:
    """A sheet of an edge with itself: one foot is the mirror image of the other.

    Args:
        plane: of symmetry, that it lies in.
        boundary: of the region.
        sites: all sites of the model.
        site: the edge.
    """

    plane: MirrorPlane
    boundary: RegionBoundary
    sites: Sequence[Site]
    site: int

    def place(self, points: Array) -> Array:
        return self.plane.place(points)

    def facing(self, points: Array) -> tuple[Array, Array]:
        away = self._feet(points) - points
        across = np.abs(dot(away, self.plane.direction))
        along = norm(away - dot(away, self.plane.direction)[:, None] * self.plane.direction)
        radius = norm(away)
        lost = radius <= CLEAR * self.boundary.diagonal
        return np.where(lost, np.nan, 2 * np.arctan2(across, along)), radius

    def _feet(self, points: Array) -> Array:
        """The nearest feet (k, 3), looked for from the nearest sample and from both sides of it.

        Over a place where the edge turns away, Newton's method stays there: it is no nearest point.
        """
        table = support_table(self.boundary, self.sites)
        samples = self.boundary.edges[self.sites[self.site].index].samples
        nearest = nearest_rows(samples, points)
        which = np.full(len(points), self.site, dtype=np.int64)
        found, least = np.zeros_like(points), np.full(len(points), np.inf)
        for step in (0, -SAMPLES_ASIDE, SAMPLES_ASIDE):
            start = samples[(nearest + step) % len(samples)]
            field = support_fields(table, which, points, start)
            nearer = field.distance < least
            found[nearer], least[nearer] = field.foot[nearer], field.distance[nearer]
        return found


def facing_sheets(skeleton: Skeleton) -> list[FacingSheet]:
    """All sheets of a skeleton, in the order of their numbers through all regions.

    Raises:
        InputError: a sheet is one that an edge has with itself, in no plane of symmetry.
    """
    found: list[FacingSheet] = []
    for region in skeleton.regions:
        for k, sheet in enumerate(region.sheets):
            surface = skeleton.complex.patches[sheet.patch].surface
            if isinstance(surface, SheetSurface):
                found.append(surface)
            elif isinstance(surface, MirrorPlane):
                found.append(MirrorSheet(surface, region.boundary, skeleton.sites, sheet.sites[0]))
            else:
                raise InputError(
                    f"sheet {k} of region {region.name} is one that the edge "
                    f"{skeleton.sites[sheet.sites[0]].name} has with itself, in no plane of "
                    "symmetry; angles between feet are not known there"
                )
    return found
