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

from decomp.errors import GeometryError
from decomp.sites import SiteIndex
from decomp.skeletons.balls.probing import TOWARDS
from decomp.skeletons.balls.queries import RegionQueries
from decomp.skeletons.balls.region_context import RegionContext
from decomp.skeletons.balls.shrinking import OSCULATES, RESTLESS, SIZELESS, TOUCHES, Shrunk, shrink
from decomp.vectors import Array, Ints


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


def inscribed_balls(context: RegionContext, points: Array, inward: Array) -> Balls:
    """The maximal balls that touch the boundary at points (k, 3) with inward unit normals (k, 3).

    Raises:
        GeometryError: there is no ball at a point, or it is not found; says where.
    """
    queries = context.queries
    balls, state = balls_at(queries, points, inward, context.size)
    for bad, what in ((SIZELESS, "has no size"), (RESTLESS, "does not come to rest")):
        if (state == bad).any():
            raise GeometryError(
                f"the ball that touches the boundary at {{at}} {what}",
                at=points[np.argmax(state == bad)],
            )
    two = np.flatnonzero(state == TOUCHES)
    towards = balls.centre[two] + TOWARDS * (balls.foot[two] - balls.centre[two])
    balls.site[two] = queries.nearest(towards).site
    return balls


def balls_at(
    queries: RegionQueries, points: Array, inward: Array, size: float
) -> tuple[Balls, Ints]:
    """The same for points that may be off the boundary, and what `shrink` says of each (k,).

    `site` does not tell the faces of a carrier apart.
    """
    points = np.ascontiguousarray(points, dtype=np.float64)
    inward = np.ascontiguousarray(inward, dtype=np.float64)
    n = len(points)
    found = Shrunk(
        np.empty(n), np.empty((n, 3)), np.empty(n, dtype=np.int64), np.empty(n, dtype=np.int64)
    )
    shrink(queries.probe, points, inward, size, found)
    osculating = found.state == OSCULATES
    found.feet[osculating] = points[osculating]
    site = queries.kinds(found.candidates)
    centre = points + found.radius[:, None] * inward
    return Balls(centre, found.radius, site, found.feet), found.state


def largest_gap(index: SiteIndex, region: int, centre: Array, radius: Array) -> float:
    """By how much the worst of some balls reaches beyond the boundary of a region."""
    found = index.nearest(centre)
    reach = np.where(found.region == region, found.distance, -found.distance)
    return float(np.max(radius - reach, initial=0.0))
