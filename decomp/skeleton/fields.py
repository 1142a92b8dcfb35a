"""Distance from a site and its gradient, smooth across the site's own ends.

A site counts here as its untrimmed support: a face as its carrier, an edge as its curve near a
known foot, a vertex as its point. So the distance is smooth and Newton's method may step past a
site's end; whether the site is truly nearest is for the nearest-site query to say.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from decomp.boundary.topology import Edge, RegionBoundary
from decomp.carriers import Carrier
from decomp.curves.circle import Circle
from decomp.curves.line import Line
from decomp.sites.site import Site, SiteKind
from decomp.vectors import Array, Ints, cross, dot, norm

FOOT_STEPS = 20


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


def site_fields(
    boundary: RegionBoundary, sites: Sequence[Site], which: Ints, points: Array, feet: Array
) -> Field:
    """Distance from site `which[i]` at points[i].

    Args:
        boundary: of the region.
        sites: all sites, into which `which` points.
        which: site of each point (k,).
        points: (k, 3).
        feet: a foot of each point or of one close by (k, 3), from which curved edges are searched.
    """
    result = Field(np.empty(len(points)), np.empty((len(points), 3)), np.empty((len(points), 3)))
    for number in np.unique(which):
        rows = np.flatnonzero(which == number)
        part = _field(boundary, sites[number], points[rows], feet[rows])
        result.distance[rows] = part.distance
        result.gradient[rows] = part.gradient
        result.foot[rows] = part.foot
    return result


def _field(boundary: RegionBoundary, site: Site, points: Array, feet: Array) -> Field:
    match site.kind:
        case SiteKind.FACE:
            face = boundary.faces[site.index]
            carrier = boundary.carriers[face.carrier]
            foot = carrier.foot(points)
            inward = -float(face.outward)
            return Field(
                inward * carrier.signed_distance(points), inward * carrier.normal(points), foot
            )
        case SiteKind.EDGE:
            return _from_foot(points, edge_foot(boundary, boundary.edges[site.index], points, feet))
        case SiteKind.VERTEX:
            point = boundary.vertices[site.index].point
            return _from_foot(points, np.broadcast_to(point, points.shape))


def _from_foot(points: Array, foot: Array) -> Field:
    away = points - foot
    distance = norm(away)
    clear = distance > 0
    return Field(distance, away / np.where(clear, distance, 1.0)[:, None], np.array(foot))


def edge_foot(boundary: RegionBoundary, edge: Edge, points: Array, feet: Array) -> Array:
    """The foot (k, 3) of each point on an edge's untrimmed curve, near a known one."""
    curve = edge.curve
    if isinstance(curve, Line):
        along = dot(points - curve.origin, curve.direction)
        return np.asarray(curve.origin + along[:, None] * curve.direction)
    if isinstance(curve, Circle):
        return curve.point(curve.parameter(points))
    a, b = (boundary.carriers[k] for k in edge.carriers)
    foot = np.array(feet)
    for _ in range(FOOT_STEPS):
        na, nb = a.normal(foot), b.normal(foot)
        tangent = cross(na, nb)
        tangent = tangent / norm(tangent)[:, None]
        residual = [-a.signed_distance(foot), -b.signed_distance(foot), dot(points - foot, tangent)]
        # the last row is d/dx of (p - x).t, with the curve's own bending in it
        bend = _bending(a, b, foot, tangent)
        stretch = 1 - dot(points - foot, bend)
        rows = np.stack([na, nb, tangent * stretch[:, None]], axis=1)
        # the pseudo-inverse, as the carriers may touch at the curve's ends
        right = np.stack(residual, axis=1)[..., None]
        step = np.asarray((np.linalg.pinv(rows, rcond=1e-9) @ right)[..., 0], dtype=np.float64)
        foot = np.asarray(foot + step, dtype=np.float64)
        if norm(step).max(initial=0.0) <= 1e-15 * (1 + np.abs(foot).max(initial=0.0)):
            break
    return foot


def _bending(a: Carrier, b: Carrier, foot: Array, tangent: Array) -> Array:
    """Curvature vector (k, 3) of the curve in which carriers a and b meet.

    It lies across the tangent and has normal components -H_a(t, t) and -H_b(t, t).
    """
    na, nb = a.normal(foot), b.normal(foot)
    ha = -a.normal_curvature(foot, tangent)
    hb = -b.normal_curvature(foot, tangent)
    c = dot(na, nb)
    s2 = np.maximum(1 - c**2, 1e-12)
    return ((ha - c * hb) / s2)[:, None] * na + ((hb - c * ha) / s2)[:, None] * nb
