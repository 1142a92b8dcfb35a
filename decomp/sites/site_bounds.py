"""Feet on edges, and what can be said of a candidate before its foot is looked for."""

from __future__ import annotations

from math import asin, inf, sqrt

from decomp.carriers.compiled_carriers import CarrierTable, foot, foot_spread, signed_distance
from decomp.kernels.compiled import inner
from decomp.sites.edge_feet import LINE, SAMPLED, arc_foot, chord_foot, line_foot, sampled_foot
from decomp.sites.site_boxes import box_distance
from decomp.sites.site_table import SiteTable


@inner
def edge_foot(
    sites: SiteTable, carriers: CarrierTable, e: int, x: float, y: float, z: float, slack: float
) -> tuple[bool, float, float, float]:
    """The nearest point of edge piece e.

    The first value is False where that is an end that is a site itself, and the point lies more
    than `slack` beyond it.
    """
    if sites.kinds[e] == SAMPLED:
        flanks = (sites.flanks[e, 0], sites.flanks[e, 1])
        span = (sites.spans[e, 0], sites.spans[e, 1])
        qx, qy, qz, which = sampled_foot(
            carriers, flanks, sites.samples, span, sites.gaps[e], (x, y, z)
        )
        beyond = (which == span[0] and sites.ended[e, 0] == 1) or (
            which == span[1] and sites.ended[e, 1] == 1
        )
        return not beyond, qx, qy, qz
    if sites.kinds[e] == LINE:
        qx, qy, qz, past = line_foot(sites.data, e, x, y, z)
    else:
        qx, qy, qz, past = arc_foot(sites.data, e, x, y, z)
        past *= sites.data[e, 9]
    return past <= slack or sites.ended[e, 0] + sites.ended[e, 1] < 2, qx, qy, qz


@inner
def at_least(
    sites: SiteTable, carriers: CarrierTable, k: int, x: float, y: float, z: float
) -> float:
    """A lower bound of the distance to candidate k."""
    faces, edges = len(sites.face_carriers), len(sites.kinds)
    if k >= faces + edges:
        v = k - faces - edges
        dx, dy, dz = (
            sites.vertices[v, 0] - x,
            sites.vertices[v, 1] - y,
            sites.vertices[v, 2] - z,
        )
        return sqrt(dx * dx + dy * dy + dz * dz)
    bound = box_distance(sites.boxes, k, x, y, z)
    if k < faces:
        return max(bound, abs(float(signed_distance(carriers, sites.face_carriers[k], x, y, z))))
    e = k - faces
    if sites.kinds[e] == SAMPLED:
        nearest = inf
        for i in range(sites.spans[e, 0], sites.spans[e, 1]):
            nearest = min(nearest, chord_foot(sites.samples, i, x, y, z))
        return max(bound, nearest - float(sites.gaps[e]))
    _, qx, qy, qz = edge_foot(sites, carriers, e, x, y, z, 0.0)
    return sqrt((qx - x) ** 2 + (qy - y) ** 2 + (qz - z) ** 2)


@inner
def possible(
    sites: SiteTable, carriers: CarrierTable, k: int, x: float, y: float, z: float, radius: float
) -> bool:
    """Whether candidate k can hold feet of points in a ball: False only if it cannot."""
    faces, edges = len(sites.face_carriers), len(sites.kinds)
    if k < faces:
        qx, qy, qz = foot(carriers, sites.face_carriers[k], x, y, z)
        spread = foot_spread(carriers, sites.face_carriers[k], x, y, z, radius)
        return box_distance(sites.boxes, k, qx, qy, qz) <= spread
    e = k - faces
    if e >= edges or sites.ended[e, 0] + sites.ended[e, 1] < 2 or sites.kinds[e] == SAMPLED:
        return True
    if sites.kinds[e] == LINE:
        _, _, _, past = line_foot(sites.data, e, x, y, z)
        return past <= radius
    _, _, _, past = arc_foot(sites.data, e, x, y, z)
    data = sites.data
    vx, vy, vz = x - data[e, 0], y - data[e, 1], z - data[e, 2]
    u = vx * data[e, 3] + vy * data[e, 4] + vz * data[e, 5]
    v = vx * data[e, 6] + vy * data[e, 7] + vz * data[e, 8]
    away = sqrt(u * u + v * v)
    return away <= radius or past <= asin(radius / away)
