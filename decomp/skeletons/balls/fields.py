"""Distance from a site and its gradient, smooth across the site's own ends.

A site counts here as its untrimmed support, see `supports`. So the distance is smooth and Newton's
method may step past a site's end; whether the site is truly nearest is for the nearest-site query
to say.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from decomp.boundary.topology import Edge, RegionBoundary
from decomp.carriers.compiled_carriers import carrier_table
from decomp.curves.circle import Circle
from decomp.curves.line import Line
from decomp.skeletons.balls.balance import fields_at
from decomp.skeletons.balls.region_context import RegionContext
from decomp.skeletons.balls.supports import SupportTable, curve_support
from decomp.vectors import Array, Ints, dot


@dataclass(frozen=True, eq=False)
class Field:
    """Distances of k points from a site each.

    Args:
        distance: (k,), positive inside the region; for a face it is the signed distance to the
            carrier, so that it is smooth across the boundary.
        gradient: (k, 3), unit vectors.
        foot: (k, 3).
    """

    distance: Array
    gradient: Array
    foot: Array


def site_fields(context: RegionContext, which: Ints, points: Array, feet: Array) -> Field:
    """Distance from site `which[i]` at points[i].

    Args:
        context: of the region.
        which: site of each point (k,).
        points: (k, 3).
        feet: a foot of each point or of one close by (k, 3), from which curved edges are searched.
    """
    return support_fields(context.table, which, points, feet)


def support_fields(table: SupportTable, which: Ints, points: Array, feet: Array) -> Field:
    """The same for rows of a table of supports."""
    points = np.ascontiguousarray(points, dtype=np.float64)
    found = Field(np.empty(len(points)), np.empty((len(points), 3)), np.array(feet, np.float64))
    which = np.ascontiguousarray(which, dtype=np.int64)
    fields_at(table, which, points, found.foot, found.distance, found.gradient)
    return found


def edge_foot(boundary: RegionBoundary, edge: Edge, points: Array, feet: Array) -> Array:
    """The foot (k, 3) of each point on an edge's untrimmed curve, near a known one."""
    curve = edge.curve
    if isinstance(curve, Line):
        along = dot(points - curve.origin, curve.direction)
        return np.asarray(curve.origin + along[:, None] * curve.direction)
    if isinstance(curve, Circle):
        return curve.point(curve.parameter(points))
    pair = carrier_table([boundary.carriers[k] for k in edge.carriers])
    kind, row = curve_support(curve)
    table = SupportTable(
        np.array([kind]),
        np.ones(1),
        np.array([[0, 1]]),
        row[None],
        np.array([[-np.inf, np.inf]]),
        pair,
        1,
        1,
    )
    return support_fields(table, np.zeros(len(points), dtype=np.int64), points, feet).foot
