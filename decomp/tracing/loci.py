"""Points that are as near to many points of one face."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from decomp.boundary.topology import RegionBoundary
from decomp.carriers.reflexive import reflexive_gap
from decomp.sites.site import Site, SiteKind
from decomp.vectors import Array, Bools


def locus_gap(
    boundary: RegionBoundary, sites: Sequence[Site], which: Sequence[int], points: Array
) -> Array:
    """Distance (k,) of points (k, 3) from the nearest reflexive locus of some faces' carriers.

    Args:
        boundary: of the region.
        sites: all sites, into which `which` points.
        which: sites; those that are no faces have no locus.
        points: (k, 3).
    """
    result = np.full(len(points), np.inf)
    for number in which:
        site = sites[number]
        if site.kind is SiteKind.FACE:
            face = boundary.faces[site.index]
            gap = reflexive_gap(boundary.carriers[face.carrier], face.outward, points)
            result = np.minimum(result, gap)
    return result


def on_locus(
    boundary: RegionBoundary,
    sites: Sequence[Site],
    which: Sequence[int],
    points: Array,
    within: float,
) -> Bools:
    """Whether points (k, 3) are centres of curvature of one of some faces' carriers.

    They are no farther from one than `within`, a part of the region's size.
    """
    gap = locus_gap(boundary, sites, which, points)
    return np.asarray(gap <= within * boundary.diagonal)
