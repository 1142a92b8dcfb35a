"""Skeletons made by hand, exactly: what is tested on them needs no computation of skeletons."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np

import decomp
from decomp.carriers import Carrier
from decomp.complex.model import Complex, Line, LineKind, Patch, PatchKind
from decomp.curves.circle import Circle
from decomp.skeletons.cells.partition import face_cells, skeleton_cells
from decomp.skeletons.certificate.evidence import Evidence
from decomp.skeletons.model import (
    Certificate,
    Junction,
    Parity,
    Reflexive,
    RegionSkeleton,
    Sheet,
    Skeleton,
    SkeletonLine,
    TrimSurface,
)
from decomp.vectors import Array, Ints, dot, norm

HOLDS = Certificate(0.0, 0.0, 0, 0, 0.0, 1, 1, 0.0, 0.0)


@dataclass(frozen=True, eq=False)
class Flat:
    """A plane through a point, with a unit normal."""

    point: Array
    unit: Array

    def place(self, points: Array) -> Array:
        return np.asarray(points - dot(points - self.point, self.unit)[:, None] * self.unit)

    def normal(self, points: Array) -> Array:
        return np.broadcast_to(self.unit, points.shape)


@dataclass(frozen=True, eq=False)
class Round:
    """A carrier of a face; its normal points out of the carrier."""

    carrier: Carrier

    def place(self, points: Array) -> Array:
        return self.carrier.project(points)

    def normal(self, points: Array) -> Array:
        return self.carrier.normal(points)


@dataclass(frozen=True, eq=False)
class Straight:
    """A line through a point along a unit vector."""

    point: Array
    along: Array

    def place(self, points: Array) -> Array:
        return np.asarray(self.point + dot(points - self.point, self.along)[:, None] * self.along)


@dataclass(frozen=True, eq=False)
class Around:
    """A circle."""

    circle: Circle

    def place(self, points: Array) -> Array:
        return self.circle.point(self.circle.parameter(points))


def flat_patch(kind: PatchKind, points: Array, polygon: list[int], towards: Array) -> Patch:
    """A convex polygon as a fan, with its normal to the side of `towards` (a vector)."""
    a, b, c = points[polygon[:3]]
    unit = np.cross(b - a, c - a)
    unit /= np.linalg.norm(unit)
    if unit @ towards < 0:
        polygon, unit = polygon[::-1], -unit
    fan = [[polygon[0], polygon[k], polygon[k + 1]] for k in range(1, len(polygon) - 1)]
    return Patch(kind, Flat(points[polygon[0]], unit), np.array(fan))


def straight(kind: LineKind, points: Array, ends: tuple[int, int]) -> Line:
    """A segment."""
    way = points[ends[1]] - points[ends[0]]
    return Line(kind, Straight(points[ends[0]], way / np.linalg.norm(way)), np.array(ends))


@dataclass(frozen=True, eq=False)
class Made:
    """A skeleton, and what it was made from."""

    geometry: decomp.Geometry
    skeleton: Skeleton
    evidence: Evidence


BLOCK_FACES = ("xmin", "xmax", "ymin", "ymax", "zmin", "zmax")
INWARD = np.stack([np.eye(3), -np.eye(3)], axis=1).reshape(6, 3)


@cache
def block() -> Made:
    """The block 4 x 3 x 2: 13 sheets, 12 seams, 12 junctions, 34 triangles with the boundary.

    Points 0 to 7 are the corners (x fastest, then y), 8 to 11 the inner junctions (likewise).
    """
    geometry = decomp.Geometry(decomp.Block((0, 0, 0), (4, 3, 2), name="block"))
    boundary = geometry.regions[0]
    index = geometry.index
    number = {s.name.removeprefix("block."): k for k, s in enumerate(index.sites) if s.region == 0}
    site = [number[name] for name in BLOCK_FACES]
    corners = [[x, y, z] for z in (0, 2) for y in (0, 3) for x in (0, 4)]
    inner = [[x, y, 1] for y in (1, 2) for x in (1, 3)]
    points = np.array(corners + inner, dtype=float)
    radius = np.array([0.0] * 8 + [1.0] * 4)

    def corner(x: int, y: int, z: int) -> int:
        return x + 2 * y + 4 * z

    def junction(x: int, y: int) -> int:
        return 8 + x + 2 * y

    # pairs of faces (numbers into BLOCK_FACES) and the polygon of their sheet
    polygons = [((4, 5), [junction(x, y) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))])]
    for z in (0, 1):
        for k in (0, 1):
            across = [corner(k, 0, z), corner(k, 1, z), junction(k, 1), junction(k, 0)]
            along = [corner(0, k, z), corner(1, k, z), junction(1, k), junction(0, k)]
            polygons += [((k, 4 + z), across), ((2 + k, 4 + z), along)]
    polygons += [
        ((x, 2 + y), [corner(x, y, 0), corner(x, y, 1), junction(x, y)])
        for y in (0, 1)
        for x in (0, 1)
    ]
    patches = [
        flat_patch(PatchKind.SHEET, points, polygon, INWARD[f] - INWARD[g])
        for (f, g), polygon in polygons
    ]
    sheets = tuple(
        Sheet(
            (site[f], site[g]),
            Parity.EVEN,
            k,
            polygon_area(points, polygon),
            extent(radius, polygon),
        )
        for k, ((f, g), polygon) in enumerate(polygons)
    )
    face_sides: dict[str, tuple[tuple[int, int], ...]] = {}
    for f, name in enumerate(BLOCK_FACES):
        axis, end = divmod(f, 2)
        low = points[:8].min(axis=0) if end == 0 else points[:8].max(axis=0)
        ring = [k for k in range(8) if points[k, axis] == low[axis]]
        polygon = [ring[0], ring[1], ring[3], ring[2]]
        face_sides[name] = ((len(patches), 1),)
        patches.append(flat_patch(PatchKind.FACE, points, polygon, -INWARD[f]))
    seams, lines = [], []

    def seam(ends: tuple[int, int], faces: tuple[int, ...]) -> None:
        touching = [
            k
            for k, ((f, g), polygon) in enumerate(polygons)
            if set(ends) <= set(polygon) and {f, g} <= set(faces)
        ]
        length = float(np.linalg.norm(points[ends[1]] - points[ends[0]]))
        seams.append(
            SkeletonLine(tuple(site[f] for f in faces), tuple(touching), len(lines), length, False)
        )
        lines.append(straight(LineKind.SEAM, points, ends))

    for z in (0, 1):
        for y in (0, 1):
            for x in (0, 1):
                seam((corner(x, y, z), junction(x, y)), (x, 2 + y, 4 + z))
    for k in (0, 1):
        seam((junction(k, 0), junction(k, 1)), (k, 4, 5))
        seam((junction(0, k), junction(1, k)), (2 + k, 4, 5))
    for edge in boundary.edges:
        ends = [int(np.argmin(norm(points - p))) for p in (edge.samples[0], edge.samples[-1])]
        lines.append(straight(LineKind.EDGE, points, (ends[0], ends[1])))
    junctions = [
        Junction(corner(x, y, z), 0.0, (site[x], site[2 + y], site[4 + z]))
        for z in (0, 1)
        for y in (0, 1)
        for x in (0, 1)
    ]
    junctions += [
        Junction(junction(x, y), 1.0, (site[x], site[2 + y], site[4], site[5]))
        for y in (0, 1)
        for x in (0, 1)
    ]
    ordered = tuple(face_sides[face.name.removeprefix("block.")] for face in boundary.faces)
    return made(
        geometry,
        Complex(points, tuple(patches), tuple(lines)),
        radius,
        sheets,
        tuple(seams),
        tuple(junctions),
        (),
        ordered,
        (),
    )


def polygon_area(points: Array, polygon: list[int]) -> float:
    """Area of a convex plane polygon."""
    away = points[polygon] - points[polygon[0]]
    return float(np.linalg.norm(np.cross(away[1:-1], away[2:]).sum(axis=0)) / 2)


def extent(radius: Array, polygon: list[int]) -> tuple[float, float]:
    """Least and greatest radius."""
    return float(radius[polygon].min()), float(radius[polygon].max())


@cache
def capsule(around: int = 48, rings: int = 12) -> Made:
    """A rod with round ends (r = 1, 3 long in the middle): no sheet, an axis, two disc trims.

    The balls' centres are the ends of the axis.
    """
    rod = decomp.Cylinder((0, 0, 0), (0, 0, 3), 1, name="rod")
    low = decomp.Sphere((0, 0, 0), 1, name="low")
    geometry = decomp.Geometry(rod | low | decomp.Sphere((0, 0, 3), 1, name="high"))
    boundary, index = geometry.regions[0], geometry.index
    names = [face.name for face in boundary.faces]
    turn = 2 * np.pi * np.arange(around) / around
    circle = np.stack([np.cos(turn), np.sin(turn), 0 * turn], axis=1)
    tilts = np.arange(rings) / rings * np.pi / 2
    caps = [
        np.concatenate(
            [circle * np.cos(t) + np.array([0, 0, side * np.sin(t)]) for t in tilts]
            + [np.array([[0.0, 0.0, side]])]
        )
        for side in (-1.0, 1.0)
    ]
    size = around * rings + 1
    centres = np.array([[0.0, 0, 0], [0, 0, 3]])
    points = np.concatenate([caps[0], caps[1] + centres[1], centres])
    radius = np.zeros(len(points))
    radius[-2:] = 1.0
    ends = (len(points) - 2, len(points) - 1)
    k, n = np.arange(around), (np.arange(around) + 1) % around

    def dome(first: int, turned: bool) -> Ints:
        parts = [
            part + first + around * ring
            for ring in range(rings - 1)
            for part in (np.stack([k, n, n + around], 1), np.stack([k, n + around, k + around], 1))
        ]
        tip = np.full(around, first + size - 1)
        last = first + around * (rings - 1)
        parts.append(np.stack([k + last, n + last, tip], 1))
        return np.concatenate(parts)[:, :: -1 if turned else 1]

    wall = np.concatenate([np.stack([k, n, n + size], 1), np.stack([k, n + size, k + size], 1)])
    discs = [np.stack([np.full(around, ends[j]), k + size * j, n + size * j], 1) for j in (0, 1)]
    up = np.array([0.0, 0, 1])

    def carrier_of(name: str) -> Round:
        return Round(boundary.carriers[boundary.face_named(name).carrier])

    patches = (
        Patch(PatchKind.FACE, carrier_of("low.surface"), dome(0, True)),
        Patch(PatchKind.FACE, carrier_of("rod.side"), wall),
        Patch(PatchKind.FACE, carrier_of("high.surface"), dome(size, False)),
        Patch(PatchKind.TRIM, Flat(centres[0], up), discs[0]),
        Patch(PatchKind.TRIM, Flat(centres[1], up), discs[1]),
    )
    order = ("low.surface", "rod.side", "high.surface")
    faces = [names.index(name) for name in order]
    site = {s.name: j for j, s in enumerate(index.sites) if s.region == 0}
    lines = [straight(LineKind.REFLEXIVE, points, ends)]
    for j in (0, 1):
        ring = Circle(centres[j], np.array([1.0, 0, 0]), np.array([0, 1.0, 0]), 1.0)
        lines.append(Line(LineKind.EDGE, Around(ring), np.append(k, 0) + size * j))
    sides = tuple(((order.index(name), 1),) for name in names)
    return made(
        geometry,
        Complex(points, patches, tuple(lines)),
        radius,
        (),
        (),
        (),
        (
            Reflexive(site["rod.side"], 1, 0, None, 3.0, False),
            Reflexive(site["low.surface"], 0, None, ends[0], 0.0, False),
            Reflexive(site["high.surface"], 0, None, ends[1], 0.0, False),
        ),
        sides,
        (TrimSurface(3, (faces[0], faces[1])), TrimSurface(4, (faces[1], faces[2]))),
    )


def made(
    geometry: decomp.Geometry,
    mesh: Complex,
    radius: Array,
    sheets: tuple[Sheet, ...],
    seams: tuple[SkeletonLine, ...],
    junctions: tuple[Junction, ...],
    reflexive: tuple[Reflexive, ...],
    face_sides: tuple[tuple[tuple[int, int], ...], ...],
    trims: tuple[TrimSurface, ...],
) -> Made:
    """Put a skeleton of one region together; every face site is its own owner."""
    boundary, index = geometry.regions[0], geometry.index
    owner = {k: s.index for k, s in enumerate(index.sites) if s.region == 0}
    cells = face_cells(mesh, boundary, face_sides, sheets, trims, owner)
    joined = skeleton_cells(mesh, boundary, cells, trims)
    region = RegionSkeleton(
        boundary.name,
        boundary,
        sheets,
        seams,
        (),
        (),
        junctions,
        reflexive,
        face_sides,
        joined,
        cells,
        HOLDS,
    )
    evidence = Evidence(
        index, 0, geometry.diagonal, mesh, radius, sheets, reflexive, face_sides, joined, cells
    )
    skeleton = Skeleton(
        geometry.model.name,
        geometry.diagonal,
        5e-4 * geometry.diagonal,
        index.sites,
        mesh,
        radius,
        (region,),
    )
    return Made(geometry, skeleton, evidence)
