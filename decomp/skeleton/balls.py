"""Maximal inscribed balls by shrinking (Ma, Bae and Choi, 3D medial axis point approximation using
nearest neighbors and the normal field, 2012), here with exact feet instead of sampled points.

The ball that touches the boundary at q from inside, with its centre on the inward normal, shrinks
until no boundary point lies inside it. Its centre is then a point of the skeleton: either the ball
touches a second boundary point, or its centre is the centre of curvature at q.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from decomp.boundary.topology import RegionBoundary
from decomp.errors import GeometryError
from decomp.sites import SiteIndex
from decomp.vectors import Array, Ints, dot, place

ROUNDS = 200
EMPTY = 1e-12
"""A ball counts as empty when it reaches beyond the boundary by less than this part of the size."""


@dataclass(frozen=True, eq=False)
class Balls:
    """Maximal balls that touch the boundary at given points.

    Args:
        centre: (k, 3).
        radius: (k,).
        site: the site (k,) of the second contact.
        foot: the second contact (k, 3).
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
        GeometryError: a ball does not come to rest.
    """
    size = boundary.diagonal
    radius = np.full(len(points), size)
    site = np.full(len(points), -1, dtype=np.int64)
    foot = np.array(points)
    moving = np.arange(len(points))
    for _ in range(ROUNDS):
        centre = points[moving] + radius[moving, None] * inward[moving]
        found = index.nearest(centre)
        outside = found.region != region
        # outside the region the centre itself is a point that the ball must not hold
        hit = np.where(outside[:, None], centre, found.foot)
        reach = np.where(outside, 0.0, found.distance)
        chord = hit - points[moving]
        lift = dot(chord, inward[moving])
        inside = reach < radius[moving] - EMPTY * size
        touching = ~inside
        with np.errstate(divide="ignore", invalid="ignore"):
            smaller = dot(chord, chord) / (2 * lift)
        shrinks = inside & (lift > 0) & (smaller < radius[moving])
        radius[moving[shrinks]] = smaller[shrinks]
        met = shrinks & ~outside
        site[moving[met]] = found.site[met]
        foot[moving[met]] = found.foot[met]
        if (inside & ~shrinks).any():
            bad = points[moving[inside & ~shrinks][0]]
            raise GeometryError(f"the ball that touches the boundary at {place(bad)} has no size")
        moving = moving[~touching]
        if not len(moving):
            break
    else:
        raise GeometryError(
            f"the ball that touches the boundary at {place(points[moving[0]])} "
            f"does not come to rest in {ROUNDS} rounds"
        )
    return Balls(points + radius[:, None] * inward, radius, site, foot)


def largest_gap(index: SiteIndex, region: int, centre: Array, radius: Array) -> float:
    """By how much the worst of some balls reaches beyond the boundary of a region."""
    found = index.nearest(centre)
    reach = np.where(found.region == region, found.distance, -found.distance)
    return float(np.max(radius - reach, initial=0.0))
