"""The distance from a point to one candidate, compared with the nearest so far."""

from __future__ import annotations

from math import inf, sqrt
from typing import NamedTuple

from decomp.carriers.compiled_carriers import foot, signed_distance
from decomp.kernels.compiled import inlined, inner
from decomp.sites.edge_feet import ARC, circle_distance
from decomp.sites.occupancy import OccupancyTree
from decomp.sites.on_boundary import NOWHERE, on_boundary
from decomp.sites.site_bounds import edge_foot
from decomp.sites.site_boxes import box_distance
from decomp.sites.site_table import SiteTable

NONE = -1


class Hit(NamedTuple):
    """The nearest candidate so far.

    Args:
        candidate: its number, NONE if there is none yet.
        distance: to it.
        least: the least distance seen, at most a rounding error below `distance`.
        x, y, z: foot.
        slot: for a face, what `on_boundary` said of the foot.
    """

    candidate: int
    distance: float
    least: float
    x: float
    y: float
    z: float
    slot: int


@inlined
def no_hit() -> Hit:
    """Nothing found yet."""
    return Hit(NONE, inf, inf, 0.0, 0.0, 0.0, NOWHERE)


@inlined
def better_inlined(
    occupancy: OccupancyTree,
    sites: SiteTable,
    label: int,
    k: int,
    x: float,
    y: float,
    z: float,
    hit: Hit,
) -> Hit:
    """Return candidate k instead of `hit` if it is nearer, or as near and of lower number."""
    faces, edges = len(sites.face_carriers), len(sites.kinds)
    limit = hit.least + occupancy.rounding
    if k < faces:
        carrier = sites.face_carriers[k]
        away = abs(signed_distance(occupancy.table, carrier, x, y, z))
        if away > limit or (away >= hit.least - occupancy.rounding and k > hit.candidate >= 0):
            return hit
        qx, qy, qz = foot(occupancy.table, carrier, x, y, z)
        slot = on_boundary(occupancy, label, carrier, qx, qy, qz)
        if slot == NOWHERE:
            return hit
        return Hit(k, away, min(away, hit.least), qx, qy, qz, slot)
    if k < faces + edges:
        if box_distance(sites.boxes, k, x, y, z) > limit:
            return hit
        e = k - faces
        if sites.kinds[e] == ARC and circle_distance(sites.data, e, x, y, z) > limit:
            return hit
        rounding = occupancy.rounding
        own, qx, qy, qz = edge_foot(sites, occupancy.table, k - faces, x, y, z, rounding)
        if not own:
            return hit
    else:
        v = k - faces - edges
        qx, qy, qz = sites.vertices[v, 0], sites.vertices[v, 1], sites.vertices[v, 2]
    away = sqrt((qx - x) ** 2 + (qy - y) ** 2 + (qz - z) ** 2)
    if away > limit or (away >= hit.least - occupancy.rounding and k > hit.candidate >= 0):
        return hit
    return Hit(k, away, min(away, hit.least), qx, qy, qz, NOWHERE)


@inner
def better(
    occupancy: OccupancyTree,
    sites: SiteTable,
    label: int,
    k: int,
    x: float,
    y: float,
    z: float,
    hit: Hit,
) -> Hit:
    """The same, compiled only once."""
    return better_inlined(occupancy, sites, label, k, x, y, z, hit)


def count_of(sites: SiteTable) -> int:
    """Number of candidates."""
    return len(sites.face_carriers) + len(sites.kinds) + len(sites.vertices)
