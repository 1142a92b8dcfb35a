"""A region's skeleton once its certificate has been measured, whichever way it was found."""

from __future__ import annotations

from collections.abc import Sequence

from decomp.boundary.topology import RegionBoundary
from decomp.complex.model import LineKind
from decomp.skeletons.certificate.certificate import Certified, certified
from decomp.skeletons.certificate.evidence import Evidence
from decomp.skeletons.model import Junction, Method, RegionSkeleton, SkeletonLine


def certified_region(
    evidence: Evidence,
    boundary: RegionBoundary,
    lines: Sequence[tuple[LineKind, SkeletonLine]],
    junctions: tuple[Junction, ...],
    method: Method,
) -> tuple[RegionSkeleton, Certified]:
    """The skeleton of a region, with what its certificate found.

    Args:
        evidence: the skeleton's sheets, cells and complex.
        boundary: of the region.
        lines: its seams, trims and rims.
        junctions: of its seams.
        method: how it was found.

    Raises:
        GeometryError: a ball does not come to rest, or a vertex is not finite.
    """
    found = certified(evidence)
    region = RegionSkeleton(
        boundary.name,
        boundary,
        evidence.sheets,
        tuple(line for kind, line in lines if kind is LineKind.SEAM),
        tuple(line for kind, line in lines if kind is LineKind.TRIM),
        tuple(line for kind, line in lines if kind is LineKind.RIM),
        junctions,
        evidence.reflexive,
        evidence.face_sides,
        evidence.cells,
        evidence.face_cells,
        found.certificate,
        method,
    )
    return region, found
