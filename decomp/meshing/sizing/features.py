"""The smallest features of a model, from which the mesh's tolerance is taken."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from decomp.boundary.topology import Convexity, RegionBoundary
from decomp.geometry import Geometry
from decomp.meshing.sizing.ball_walls import ball_walls
from decomp.meshing.sizing.necks import narrowest
from decomp.meshing.sizing.sheet_walls import reflexive_walls, sheet_walls
from decomp.meshing.sizing.wall import FACING, Wall
from decomp.meshing.surface.layout import samples
from decomp.meshing.surface.surface import MeshSurface
from decomp.sites.site import SiteKind
from decomp.tolerance import TINY
from decomp.vectors import Array, Ints, dot, norm

ANGLES_ALONG = 9
"""Angles are measured at so many points of an edge."""
FEATURE_SAMPLES = 12.0
"""Features are looked for at points this part of a region's diagonal apart."""
USUAL = 5e-3
"""The tolerance relative to the smallest region's diagonal, where nothing asks for less."""
OF_LENGTH = 0.1
"""The tolerance relative to the shortest edges wanted. A mesher that tests triangles by samples
about as far apart takes time with the square of their ratio."""
OF_THICKNESS, OF_EDGE = 0.2, 0.12
"""The tolerance is at most these parts of the least thickness, and of the shortest edge."""
OF_THIN, SLENDER = 0.15, 3.0
"""And at most the first of the least thickness where the largest edges are more than so many times
as long: nothing holds such triangles off each other in between."""
OF_NECK, OF_ALL = 0.3, 0.1
"""And at most the first part of the narrowest place of a face, but no less on its account than the
second part of what it is else: over narrower ones a mesher may draw edges together."""
WIDE_DEGREES = 30.0
"""Where a sheet ends in an edge at less than this angle (degrees) to the faces, the tolerance is
smaller: the mesher lets it end the tolerance / sin(angle) before the edge."""
ZOOMS, PROMISING, CLOSE_TO_LEAST = 4, 6, 2.0
"""A wall's narrowest place is looked for in so many rounds, with samples a quarter as far apart in
each, for so many walls in which samples find the least, and less than so many times the least."""
SETTLED = 0.98
"""A look that finds no less than this part of what was known is the last."""
LEAST_TOLERANCE = 1e-5
"""The tolerance is at least this part of the model's diagonal."""


def usual_tolerance(geometry: Geometry, length: float, cusp: float = 0.0) -> float:
    """The tolerance as far as it is known without the skeleton, for edges of a length.

    Angles below that of a cusp (degrees) do not count.
    """
    smallest = min(region.diagonal for region in geometry.regions)
    tolerance = min(USUAL * smallest, OF_LENGTH * length)
    sharpest = min(sharpest_angle(region, cusp) for region in geometry.regions) / 2
    narrow = np.sin(np.radians(sharpest)) / np.sin(np.radians(WIDE_DEGREES))
    tolerance *= min(1.0, float(narrow**2))
    edges = [edge.length for region in geometry.regions for edge in region.edges]
    return max(
        min(tolerance, OF_EDGE * min(edges, default=np.inf)), LEAST_TOLERANCE * geometry.diagonal
    )


def sharpest_angle(boundary: RegionBoundary, cusp: float = 0.0) -> float:
    """The least interior angle (degrees) between two faces along a convex edge; 180 for none.

    Only angles of at least `cusp` count.
    """
    least = 180.0
    for edge in boundary.edges:
        if edge.convexity is Convexity.CONVEX:
            at = edge.curve.point(np.linspace(edge.start, edge.end, ANGLES_ALONG))
            one, two = (
                boundary.faces[face].outward
                * boundary.carriers[boundary.faces[face].carrier].normal(at)
                for face in edge.faces
            )
            angles = np.degrees(np.arccos(np.clip(-dot(one, two), -1, 1)))
            least = min(least, float(angles[angles >= cusp].min(initial=180.0)))
    return least


def fitting_tolerance(
    geometry: Geometry, surface: MeshSurface, tolerance: float, longest: float
) -> float:
    """A tolerance, no larger than a given one, that thin walls, narrow gaps and faces allow.

    Args:
        geometry: of the model.
        surface: its boundary and skeleton.
        tolerance: the largest.
        longest: the length of the largest edges.
    """
    numbers = range(len(surface.regions))
    thin = min(least_thickness(geometry, surface, number) for number in numbers)
    part = OF_THIN if longest > SLENDER * thin else OF_THICKNESS
    tolerance = min(tolerance, part * thin)
    neck = min(narrowest(region, tolerance / OF_NECK) for region in geometry.regions)
    tolerance = min(tolerance, max(OF_NECK * neck, OF_ALL * tolerance))
    while tolerance > LEAST_TOLERANCE * geometry.diagonal and has_gap(
        geometry, surface, tolerance / OF_THICKNESS
    ):
        tolerance /= 2
    return max(tolerance, LEAST_TOLERANCE * geometry.diagonal)


def has_gap(geometry: Geometry, surface: MeshSurface, width: float) -> bool:
    """Whether boundaries face each other across the outside, less than a width apart.

    Faces that meet in an edge make a groove there, not a gap, and tangent ones a cusp.
    """
    mesh = surface.complex
    index = geometry.index
    edges = [edge for region in geometry.regions for edge in region.edges]
    meeting = {frozenset(edge.carriers) for edge in edges} | geometry.boundaries.tangent
    for region in surface.regions:
        boundary = region.boundary
        for face, sides in zip(boundary.faces, region.face_sides, strict=True):
            for patch, sign in sides:
                own = mesh.patches[patch]
                apart = max(boundary.diagonal / FEATURE_SAMPLES, width)
                some = own.surface.place(samples(mesh.points, own.triangles, apart)[0])
                out = sign * own.surface.normal(some)
                asked = some + width / 2 * out
                found = index.nearest(asked)
                outside = index.region_of(some + 0.01 * width * out) < 0
                way = (found.foot - asked) / np.maximum(found.distance, TINY)[:, None]
                near = (found.distance < 0.45 * width) & (dot(way, out) > -FACING)
                for row in np.flatnonzero(outside & ((found.region >= 0) | near)):
                    site = geometry.sites[found.site[row]]
                    other = index.boundary(site.region)
                    if site.kind is SiteKind.FACE:
                        pair = frozenset((face.carrier, other.faces[site.index].carrier))
                        if len(pair) == 2 and pair not in meeting:
                            return True
    return False


def thickness(
    geometry: Geometry, surface: MeshSurface, number: int, largest: float
) -> tuple[Array, Array]:
    """Points of a region's walls, inside them and on both their sides, with thicknesses.

    Args:
        geometry: of the model.
        surface: its boundary, and its skeleton if that is known.
        number: of the region.
        largest: length of its edges.
    """
    points, thick = [], []
    for wall in _walls(geometry, surface, number):
        some, _ = samples(surface.complex.points, wall.triangles, largest / 2)
        across, wide = wall.measured(some)
        points += list(across)
        thick += [wide] * len(across)
    for ends, wide in _curves(geometry, surface, number):
        points += list(ends)
        thick += [wide] * len(ends)
    return (
        np.concatenate([np.empty((0, 3)), *points]),
        np.concatenate([np.empty(0), *thick]),
    )


def least_thickness(geometry: Geometry, surface: MeshSurface, number: int) -> float:
    """The least local thickness of a region, infinite where no feet face each other."""
    length = surface.regions[number].boundary.diagonal / FEATURE_SAMPLES
    least = [float(wide.min(initial=np.inf)) for _, wide in _curves(geometry, surface, number)]
    looks = [
        (_looked(surface, own, own.triangles, length), own)
        for own in _walls(geometry, surface, number)
    ]
    looks = sorted(looks, key=lambda each: each[0].thick)[:PROMISING]
    least += [look.thick for look, _ in looks]
    for look, own in looks:
        for zoom in range(1, ZOOMS):
            if not look.thick < CLOSE_TO_LEAST * min(least):
                break
            apart, before = length / 4**zoom, look.thick
            look = _looked(surface, own, look.triangles, apart, look)
            least.append(look.thick)
            if look.thick > SETTLED * before:
                break
    return min(least, default=np.inf)


def _walls(geometry: Geometry, surface: MeshSurface, number: int) -> list[Wall]:
    """What tells the thickness of a region: its sheets where they are known, else its faces."""
    known = sheet_walls if surface.has_skeleton else ball_walls
    return known(geometry, surface, number)


def _curves(
    geometry: Geometry, surface: MeshSurface, number: int
) -> list[tuple[tuple[Array, Array], Array]]:
    """What else does: reflexive curves, for balls on faces tell of these themselves."""
    return reflexive_walls(geometry, surface, number) if surface.has_skeleton else []


class _Look(NamedTuple):
    """The thinnest of a wall's samples, infinite if there is none, where, and triangles near it."""

    thick: float
    middle: Array
    triangles: Ints


def _looked(
    surface: MeshSurface,
    own: Wall,
    triangles: Ints,
    length: float,
    before: _Look | None = None,
) -> _Look:
    """Look at samples a length apart on triangles of a wall, about the place of a coarser look."""
    some, which = samples(surface.complex.points, triangles, length / 2)
    if before is not None:
        near = norm(some - before.middle) < 4 * length
        some, which = some[near], which[near]
    (places, *_), wide = own.measured(some)
    if not len(wide):
        return _Look(np.inf, np.zeros(3), triangles)
    middle = places[np.argmin(wide)]
    near = norm(some - middle) < length
    return _Look(float(wide.min()), middle, triangles[np.unique(which[near])])
