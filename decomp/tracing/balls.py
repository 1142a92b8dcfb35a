"""Maximal inscribed balls by shrinking (Ma, Bae and Choi, 3D medial axis point approximation using
nearest neighbors and the normal field, 2012), here with exact feet instead of sampled points.

The ball that touches the boundary at q from inside, with its centre on the inward normal, shrinks
until no boundary point lies inside it. Its centre is then a point of the skeleton: either the ball
touches a second boundary point, or its centre is the centre of curvature at q. A second contact is
made exact by Newton's method on d(q + r n) = r for the radius r, with d the distance from the site.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from decomp.boundary.topology import RegionBoundary
from decomp.errors import GeometryError
from decomp.sites import SiteIndex
from decomp.tracing.fields import site_fields
from decomp.tracing.probing import TOWARDS, probe
from decomp.tracing.shrinking import OSCULATES, RESTLESS, SIZELESS, TOUCHES, shrink
from decomp.vectors import Array, Ints, dot, norm, place

POLISHINGS = 4


@dataclass(frozen=True, eq=False)
class Balls:
    """Maximal balls that touch the boundary at given points.

    Args:
        centre: (k, 3).
        radius: (k,).
        site: the site (k,) of the second contact; -1 where there is none, the centre being the
            centre of curvature at the point itself.
        foot: the second contact (k, 3); the point itself where there is none.
    """

    centre: Array
    radius: Array
    site: Ints
    foot: Array


def inscribed_balls(
    index: SiteIndex, boundary: RegionBoundary, region: int, points: Array, inward: Array
) -> Balls:
    """The maximal balls that touch the boundary at points (k, 3) with inward unit normals (k, 3).

    Raises:
        GeometryError: there is no ball at a point, or it is not found; says where.
    """
    balls, state = balls_at(index, boundary, region, points, inward)
    for bad, what in ((SIZELESS, "has no size"), (RESTLESS, "does not come to rest")):
        if (state == bad).any():
            where = place(points[np.argmax(state == bad)])
            raise GeometryError(f"the ball that touches the boundary at {where} {what}")
    return balls


def balls_at(
    index: SiteIndex, boundary: RegionBoundary, region: int, points: Array, inward: Array
) -> tuple[Balls, Ints]:
    """The same for points that may be off the boundary, and what `shrink` says of each (k,)."""
    points = np.ascontiguousarray(points, dtype=np.float64)
    inward = np.ascontiguousarray(inward, dtype=np.float64)
    size, n = boundary.diagonal, len(points)
    radius, foot = np.empty(n), np.empty((n, 3))
    state = np.empty(n, dtype=np.int64)
    queries = probe(index, region, size)
    shrink(queries, points, inward, size, np.full(n, size), radius, foot, state)
    foot[state == OSCULATES] = points[state == OSCULATES]
    site = np.full(n, -1, dtype=np.int64)
    two = np.flatnonzero(state == TOUCHES)
    centre = points[two] + radius[two, None] * inward[two]
    site[two] = index.nearest(centre + TOWARDS * (foot[two] - centre)).site
    found = Balls(points + radius[:, None] * inward, radius, site, foot)
    return _polished(index, boundary, points, inward, found, two), state


def _polished(
    index: SiteIndex,
    boundary: RegionBoundary,
    points: Array,
    inward: Array,
    balls: Balls,
    two: Ints,
) -> Balls:
    """Make second contacts exact, where they are far enough from the first for that."""
    size = boundary.diagonal
    radius, foot = balls.radius[two], balls.foot[two]
    site, start, normal = balls.site[two], points[two], inward[two]
    for _ in range(POLISHINGS):
        field = site_fields(boundary, index.sites, site, start + radius[:, None] * normal, foot)
        slope = 1 - dot(field.gradient, normal)
        step = (field.distance - radius) / np.where(slope > 0, slope, 1.0)
        near = (
            (slope > 1e-6)
            & (np.abs(step) <= 1e-4 * np.minimum(radius, size))
            & (norm(field.foot - foot) <= 1e-2 * radius)
        )
        radius = np.where(near, radius + step, radius)
        foot = np.where(near[:, None], field.foot, foot)
    result = Balls(balls.centre, balls.radius, balls.site, balls.foot)
    result.radius[two], result.foot[two] = radius, foot
    result.centre[two] = start + radius[:, None] * normal
    return result


def largest_gap(index: SiteIndex, region: int, centre: Array, radius: Array) -> float:
    """By how much the worst of some balls reaches beyond the boundary of a region."""
    found = index.nearest(centre)
    reach = np.where(found.region == region, found.distance, -found.distance)
    return float(np.max(radius - reach, initial=0.0))
