"""Points that are as near to many points of one face, or of an edge that is an arc of a circle."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from decomp.curves.circle import Circle
from decomp.sites.site import SiteKind
from decomp.skeletons.balls.region_context import RegionContext
from decomp.vectors import Array, Bools


def locus_gap(context: RegionContext, which: Sequence[int], points: Array) -> Array:
    """Distance (k,) of points (k, 3) from the nearest reflexive locus of some sites.

    That of a face is its carrier's, that of an arc of a circle the circle's axis.

    Args:
        context: of the region.
        which: sites.
        points: (k, 3).
    """
    boundary, sites = context.boundary, context.sites
    result = np.full(len(points), np.inf)
    for number in which:
        site = sites[number]
        if site.kind is SiteKind.FACE:
            face = boundary.faces[site.index]
            gap = boundary.carriers[face.carrier].reflexive_gap(face.outward, points)
            result = np.minimum(result, gap)
        elif site.kind is SiteKind.EDGE:
            curve = boundary.edges[site.index].curve
            if isinstance(curve, Circle):
                result = np.minimum(result, axis_gap(curve, points))
    return result


def axis_gap(circle: Circle, points: Array) -> Array:
    """Distance (k,) of points (k, 3) from a circle's axis."""
    away = points - circle.centre
    return np.hypot(away @ circle.x, away @ circle.y)


def on_locus(
    context: RegionContext,
    which: Sequence[int],
    points: Array,
    within: float,
) -> Bools:
    """Whether points (k, 3) are on the reflexive locus of one of some sites.

    They are no farther from one than `within`, a part of the region's size.
    """
    gap = locus_gap(context, which, points)
    return np.asarray(gap <= within * context.size)


def past_locus(
    context: RegionContext,
    which: Sequence[int],
    feet: Array,
    radius: Array,
    within: float,
) -> Bools:
    """Whether balls at feet (k, 3) reach the centres of curvature of one of some faces' carriers.

    No ball is larger: along an edge a face's carrier is on one side at least. But one over a point
    where the edge runs along the carrier's strongest curvature comes to rest a little late.
    """
    boundary, sites = context.boundary, context.sites
    result = np.zeros(len(feet), dtype=np.bool_)
    for number in which:
        site = sites[number]
        if site.kind is not SiteKind.FACE:
            continue
        face = boundary.faces[site.index]
        carrier = boundary.carriers[face.carrier]
        if np.isfinite(carrier.reflexive_gap(face.outward, feet[:1])).all():
            most = carrier.inner_radius(face.outward, feet)
            result |= (most > 0) & (radius >= (1 - within) * most)
    return result
