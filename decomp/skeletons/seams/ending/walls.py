"""Where a seam crosses a trim surface: a foot passes from a site to a neighbouring one.

A foot leaves a face f, or the edge e for f, where it lies on e: where the point p and its foot q
on e's curve satisfy (p - q).(n x t) = 0, with n the normal of f and t the tangent of e at q. It
leaves an edge for a vertex v, or v for the edge, where (p - v).t = 0. These functions change sign
at the wall, while the two sites' distances only touch there.
"""

from __future__ import annotations

from dataclasses import dataclass

from decomp.boundary.topology import Convexity
from decomp.carriers.compiled_carriers import normal
from decomp.kernels.compiled import inner, scalar
from decomp.kernels.records import Record
from decomp.sites.site import SiteKind
from decomp.skeletons.balls.region_context import RegionContext
from decomp.skeletons.balls.supports import SupportTable, support, tangent_at
from decomp.skeletons.seams.steps.stepping import Track, advance
from decomp.vectors import Array

ROUNDS = 80
"""Most steps of the search for a crossing."""
ON_WALL = 1e-16
"""A point nearer to a wall than this part of the size is on it."""
ALONG = 1e-13
"""Both ends of a step nearer to a wall than this part of the size: it runs along the wall."""
NO_ROW = -1
MISSED, CROSSED, JOINS = 0, 1, 2
"""A step does not cross a wall; it does; it comes to one along which it runs to its end."""


@dataclass(frozen=True)
class Wall(Record):
    """A wall between two neighbouring sites, as rows of the region's supports.

    Args:
        edge: row of the edge.
        carrier: of the face at the edge, NO_ROW for the wall between the edge and a vertex.
        vertex: row of the vertex, NO_ROW for the wall between the edge and a face.
    """

    edge: int
    carrier: int
    vertex: int


class Walls:
    """The walls of all sites of a region."""

    def __init__(self, context: RegionContext) -> None:
        boundary, table = context.boundary, context.table
        self._boundary, self._sites, self._table = boundary, context.sites, table
        self._of_face: dict[int, list[Wall]] = {}
        self._of_vertex: dict[int, list[Wall]] = {}
        for number, edge in enumerate(boundary.edges):
            if edge.convexity is Convexity.CONVEX:
                continue
            row = table.first_edge + number
            for face, carrier in zip(edge.faces, edge.carriers, strict=True):
                self._of_face.setdefault(face, []).append(Wall(row, carrier, NO_ROW))
            for vertex in edge.vertices or ():
                wall = Wall(row, NO_ROW, table.first_vertex + vertex)
                self._of_vertex.setdefault(vertex, []).append(wall)

    def of(self, site: int) -> list[Wall]:
        """The walls of a site."""
        kind, number = self._sites[site].kind, self._sites[site].index
        match kind:
            case SiteKind.FACE:
                return self._of_face.get(number, [])
            case SiteKind.VERTEX:
                return self._of_vertex.get(number, [])
            case SiteKind.EDGE:
                edge = self._boundary.edges[number]
                row = self._table.first_edge + number
                return [
                    *(Wall(row, carrier, NO_ROW) for carrier in edge.carriers),
                    *(
                        Wall(row, NO_ROW, self._table.first_vertex + vertex)
                        for vertex in edge.vertices or ()
                    ),
                ]

    def beyond(self, wall: Wall, spot: Array) -> float:
        """How far a point on a wall's edge, untrimmed, is from the edge's ends; 0 between them.

        Where a straight edge goes on smoothly into an arc, its line stays close to the arc.
        """
        return self._boundary.edges[wall.edge - self._table.first_edge].beyond(spot)


@inner
def wall_gap(table: SupportTable, wall: Wall, x: float, y: float, z: float, spot: Array) -> float:
    """On which side of a wall a point lies.

    `spot` (3,) is a point of the edge close by; the one there, or the vertex, is put into it.
    """
    edge, vertex = wall.edge, wall.vertex
    if vertex != NO_ROW:
        data = table.data
        qx, qy, qz = data[vertex, 0], data[vertex, 1], data[vertex, 2]
        tx, ty, tz = tangent_at(table, edge, qx, qy, qz)
        spot[0], spot[1], spot[2] = qx, qy, qz
        return float((x - qx) * tx + (y - qy) * ty + (z - qz) * tz)
    _, _, _, _, qx, qy, qz = support(table, edge, x, y, z, spot[0], spot[1], spot[2])
    spot[0], spot[1], spot[2] = qx, qy, qz
    tx, ty, tz = tangent_at(table, edge, qx, qy, qz)
    nx, ny, nz = normal(table.carriers, wall.carrier, qx, qy, qz)
    cx, cy, cz = ny * tz - nz * ty, nz * tx - nx * tz, nx * ty - ny * tx
    return (x - qx) * cx + (y - qy) * cy + (z - qz) * cz


@scalar
def gap_ahead(
    table: SupportTable, wall: Wall, track: Track, here: int, row: int, step: float, spot: Array
) -> tuple[bool, float]:
    """Put the point of a seam a step ahead of row `here` into another row.

    Returns:
        Whether there is one, and on which side of the wall it lies.
    """
    if not advance(table, track, here, row, step, False):
        return False, 0.0
    x, y, z = track.points[row, 0], track.points[row, 1], track.points[row, 2]
    return True, wall_gap(table, wall, x, y, z, spot)


@scalar
def cross(
    table: SupportTable,
    wall: Wall,
    track: Track,
    here: int,
    row: int,
    between: tuple[float, float],
    spot: Array,
) -> int:
    """Put the point where a seam crosses a wall into a row of a track.

    It lies between two steps from row `here`; found by regula falsi (Illinois). `spot` (3,) is a
    point of the wall's edge close by, and then the point there.

    Returns:
        CROSSED if it was found, JOINS if the place is to be read off (`arriving`), or MISSED.
    """
    low, high = between
    along, on_wall = ALONG * track.contacts.size, ON_WALL * track.contacts.size
    good, fl = gap_ahead(table, wall, track, here, row, low, spot)
    if not good:
        return MISSED
    good, fh = gap_ahead(table, wall, track, here, row, high, spot)
    if not good or (abs(fl) <= along and abs(fh) <= along):
        return MISSED
    if abs(fh) <= along:
        return JOINS
    if abs(fl) <= on_wall:
        return CROSSED if gap_ahead(table, wall, track, here, row, low, spot)[0] else MISSED
    if not fl * fh < 0.0:
        return MISSED
    side = 0
    for _ in range(ROUNDS):
        step = high - fh * (high - low) / (fh - fl)
        if not min(low, high) < step < max(low, high):
            break
        good, f = gap_ahead(table, wall, track, here, row, step, spot)
        if not good:
            return MISSED
        if abs(f) <= on_wall:
            break
        if f * fh > 0.0:
            high, fh = step, f
            if side == 1:
                fl /= 2
            side = 1
        else:
            low, fl = step, f
            if side == -1:
                fh /= 2
            side = -1
    return CROSSED
