"""Supports of sites as arrays, and compiled kernels for distance, gradient and foot.

A site's support is its untrimmed extent: a face's carrier, an edge's curve near a known foot, a
vertex's point. So the distance is smooth where the site itself ends. All reentrant and smooth edges
and all vertices have supports, whether they are sites or not.

Kernels take a point as three numbers, as they return it; so the lists of arguments of those for
feet and distances are long: a point, a foot close by, and what they are looked for on.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import sqrt
from weakref import WeakKeyDictionary

import numpy as np

from decomp.boundary.topology import Edge, RegionBoundary
from decomp.carriers.compiled_carriers import (
    CarrierTable,
    Triple,
    carrier_table,
    foot,
    normal,
    signed_distance,
)
from decomp.curves.base import Curve
from decomp.curves.circle import Circle
from decomp.curves.ellipse import Ellipse
from decomp.curves.line import Line
from decomp.kernels.compiled import inner
from decomp.kernels.records import Record
from decomp.sites.site import Site, SiteKind
from decomp.skeletons.balls.curve_feet import curve_foot
from decomp.skeletons.balls.ellipse_feet import ellipse_foot, ellipse_tangent
from decomp.vectors import Array, Ints

FACE, LINE, CIRCLE, CURVE, POINT, NOTHING, ELLIPSE = range(7)
SEARCHED = (CURVE, ELLIPSE)
"""Supports on which a foot is searched from a known one."""

Field = tuple[float, float, float, float, float, float, float]
ON_AXIS = 1e-15
"""A point nearer to the axis of a circle than this part of its radius is on it, to rounding."""


@dataclass(frozen=True, eq=False)
class SupportTable(Record):
    """Supports of all sites, in their order, then of the region's edges, then of its vertices.

    Args:
        kinds: (n,), NOTHING for sites of other regions.
        signs: (n,), by which a face's signed distance is positive inside the region.
        flanks: carriers (n, 2) of an edge; a face's own carrier first.
        data: (n, 10): line: origin, direction; circle: centre, x, y, radius; ellipse: centre and
            both semi-axes; point: itself.
        ends: (n, 2), where a straight edge begins and ends along its line; else infinite.
        carriers: of the model.
        first_edge: row of the region's first edge.
        first_vertex: row of its first vertex.
    """

    kinds: Ints
    signs: Array
    flanks: Ints
    data: Array
    ends: Array
    carriers: CarrierTable
    first_edge: int
    first_vertex: int


_TABLES: WeakKeyDictionary[RegionBoundary, tuple[Sequence[Site], SupportTable]] = (
    WeakKeyDictionary()
)


def support_table(boundary: RegionBoundary, sites: Sequence[Site]) -> SupportTable:
    """Lay out the supports of a region; made once for each boundary and its sites."""
    known = _TABLES.get(boundary)
    if known is None or known[0] is not sites:
        known = (sites, _laid_out(boundary, sites))
        _TABLES[boundary] = known
    return known[1]


def _laid_out(boundary: RegionBoundary, sites: Sequence[Site]) -> SupportTable:
    edges, vertices = boundary.edges, boundary.vertices
    count = len(sites) + len(edges) + len(vertices)
    kinds = np.full(count, NOTHING)
    signs = np.ones(count)
    flanks = np.zeros((count, 2), dtype=np.int64)
    data = np.zeros((count, 10))
    ends = np.tile([-np.inf, np.inf], (count, 1))

    def put_edge(row: int, edge: Edge) -> None:
        flanks[row] = edge.carriers
        kinds[row], data[row] = curve_support(edge.curve)
        if isinstance(edge.curve, Line):
            ends[row] = edge.start, edge.end

    for row, site in enumerate(sites):
        if site.kind is SiteKind.FACE and site.index < len(boundary.faces):
            face = boundary.faces[site.index]
            kinds[row], signs[row], flanks[row] = FACE, -face.outward, face.carrier
        elif site.kind is SiteKind.EDGE and site.index < len(edges):
            put_edge(row, edges[site.index])
        elif site.kind is SiteKind.VERTEX and site.index < len(vertices):
            kinds[row], data[row, :3] = POINT, vertices[site.index].point
    for row, edge in enumerate(edges, len(sites)):
        put_edge(row, edge)
    for row, vertex in enumerate(vertices, len(sites) + len(edges)):
        kinds[row], data[row, :3] = POINT, vertex.point
    return SupportTable(
        kinds,
        signs,
        flanks,
        data,
        ends,
        carrier_table(boundary.carriers),
        len(sites),
        len(sites) + len(edges),
    )


def curve_support(curve: Curve) -> tuple[int, Array]:
    """The kind of an edge's support and its row (10,) of data."""
    row = np.zeros(10)
    if isinstance(curve, Line):
        row[:6] = *curve.origin, *curve.direction
        return LINE, row
    if isinstance(curve, Circle):
        row[:] = *curve.centre, *curve.x, *curve.y, curve.radius
        return CIRCLE, row
    if isinstance(curve, Ellipse):
        row[:9] = *curve.centre, *curve.a * curve.x, *curve.b * curve.y
        return ELLIPSE, row
    return CURVE, row


@inner
def support(
    table: SupportTable, k: int, x: float, y: float, z: float, qx: float, qy: float, qz: float
) -> Field:
    """Distance from support k, its gradient and the foot; (qx, qy, qz) is a foot close by."""
    kind, data = table.kinds[k], table.data
    if kind == FACE:
        carrier, sign = table.flanks[k, 0], table.signs[k]
        away = signed_distance(table.carriers, carrier, x, y, z)
        nx, ny, nz = normal(table.carriers, carrier, x, y, z)
        qx, qy, qz = foot(table.carriers, carrier, x, y, z)
        return sign * away, sign * nx, sign * ny, sign * nz, qx, qy, qz
    if kind == LINE:
        dx, dy, dz = data[k, 3], data[k, 4], data[k, 5]
        along = (x - data[k, 0]) * dx + (y - data[k, 1]) * dy + (z - data[k, 2]) * dz
        qx, qy, qz = data[k, 0] + along * dx, data[k, 1] + along * dy, data[k, 2] + along * dz
    elif kind == CIRCLE:
        vx, vy, vz = x - data[k, 0], y - data[k, 1], z - data[k, 2]
        u = vx * data[k, 3] + vy * data[k, 4] + vz * data[k, 5]
        v = vx * data[k, 6] + vy * data[k, 7] + vz * data[k, 8]
        rho = sqrt(u * u + v * v)
        if rho <= ON_AXIS * data[k, 9]:
            # on the axis every point of the circle is a foot
            u, v, rho = 1.0, 0.0, 1.0
        u, v = data[k, 9] * (u / rho), data[k, 9] * (v / rho)
        qx = data[k, 0] + u * data[k, 3] + v * data[k, 6]
        qy = data[k, 1] + u * data[k, 4] + v * data[k, 7]
        qz = data[k, 2] + u * data[k, 5] + v * data[k, 8]
    elif kind == ELLIPSE:
        qx, qy, qz = ellipse_foot(data, k, x, y, z, qx, qy, qz)
    elif kind == CURVE:
        a, b = table.flanks[k, 0], table.flanks[k, 1]
        qx, qy, qz = curve_foot(table.carriers, a, b, x, y, z, qx, qy, qz)
    else:
        qx, qy, qz = data[k, 0], data[k, 1], data[k, 2]
    gx, gy, gz = x - qx, y - qy, z - qz
    away = sqrt(gx * gx + gy * gy + gz * gz)
    if away > 0.0:
        gx, gy, gz = gx / away, gy / away, gz / away
    return away, gx, gy, gz, qx, qy, qz


@inner
def past_end(table: SupportTable, k: int, qx: float, qy: float, qz: float) -> float:
    """How far a foot on a straight edge's line is beyond the edge; negative inside it."""
    if table.kinds[k] != LINE:
        return -1.0
    data = table.data
    along = (
        (qx - data[k, 0]) * data[k, 3]
        + (qy - data[k, 1]) * data[k, 4]
        + (qz - data[k, 2]) * data[k, 5]
    )
    return float(max(table.ends[k, 0] - along, along - table.ends[k, 1]))


@inner
def tangent_at(table: SupportTable, k: int, qx: float, qy: float, qz: float) -> Triple:
    """Unit tangent of an edge's curve at a point on it; its sense is arbitrary but continuous."""
    kind, data = table.kinds[k], table.data
    if kind == LINE:
        return data[k, 3], data[k, 4], data[k, 5]
    if kind == CIRCLE:
        vx, vy, vz = qx - data[k, 0], qy - data[k, 1], qz - data[k, 2]
        u = vx * data[k, 3] + vy * data[k, 4] + vz * data[k, 5]
        v = vx * data[k, 6] + vy * data[k, 7] + vz * data[k, 8]
        rho = sqrt(u * u + v * v)
        u, v = u / rho, v / rho
        return (
            u * data[k, 6] - v * data[k, 3],
            u * data[k, 7] - v * data[k, 4],
            u * data[k, 8] - v * data[k, 5],
        )
    if kind == ELLIPSE:
        return ellipse_tangent(data, k, qx, qy, qz)
    nx, ny, nz = normal(table.carriers, table.flanks[k, 0], qx, qy, qz)
    mx, my, mz = normal(table.carriers, table.flanks[k, 1], qx, qy, qz)
    tx, ty, tz = ny * mz - nz * my, nz * mx - nx * mz, nx * my - ny * mx
    length = sqrt(tx * tx + ty * ty + tz * tz)
    if length == 0.0:
        return 0.0, 0.0, 0.0
    return tx / length, ty / length, tz / length
