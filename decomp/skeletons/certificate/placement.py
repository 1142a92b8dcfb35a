"""How exactly the vertices of a skeleton lie on their sheets, loci and faces."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from decomp.boundary.topology import Edge, RegionBoundary
from decomp.carriers.axial import axial_split
from decomp.curves.circle import Circle
from decomp.errors import GeometryError
from decomp.sites.site import Site, SiteKind
from decomp.skeletons.balls.fields import site_fields
from decomp.skeletons.balls.queries import region_queries
from decomp.skeletons.certificate.evidence import Evidence, Worst, worst_of
from decomp.skeletons.model import Reflexive, Sheet
from decomp.vectors import Array, Ints, cross, dot, norm

BLOCK = 1 << 12
SEARCH, HALVINGS = 513, 40
CREPT, MERGED = 1e-14, 1e-6


def residual(evidence: Evidence) -> Worst:
    """The largest error of placement.

    On a sheet it is the difference of the distances from both sites and from the stored radius; on
    a reflexive locus the distance from the locus and the error of the radius; on a boundary face
    the distance from its carrier.
    """
    return worst_of(_residuals(evidence))


def intrusion(evidence: Evidence) -> Worst:
    """How deep the boundary enters the ball of a skeleton vertex: the worst of all.

    Vertices that the skeleton shares with the boundary have no ball; `residual` measures them.
    """
    sides = [patch for face in evidence.face_sides for patch, _ in face]
    shared = [evidence.complex.patches[patch].triangles.reshape(-1) for patch in sides]
    which = np.setdiff1d(evidence.skeleton_vertices(), np.concatenate(shared))
    if not len(which):
        return Worst(0.0)
    centre, radius = evidence.complex.points[which], evidence.radius[which]
    queries = region_queries(evidence.index, evidence.region)
    inside, reach = queries.depth(centre)
    outside = np.flatnonzero(~inside)
    if len(outside):
        reach[outside] = -evidence.index.nearest(centre[outside]).distance
    k = int(np.argmax(radius - reach))  # a NaN counts as the largest
    gap = max(float(radius[k] - reach[k]), 0.0)
    site = int(queries.nearest(centre[k : k + 1]).site[0])
    return Worst(gap / evidence.diagonal, centre[k], (site,) if site >= 0 else ())


def _residuals(evidence: Evidence) -> Iterator[Worst]:
    for sheet in evidence.sheets:
        vertices = np.unique(evidence.complex.patches[sheet.patch].triangles)
        yield _worst(evidence, vertices, _sheet_error(evidence, sheet, vertices), sheet.sites)
    for locus in evidence.reflexive:
        vertices = _locus_vertices(evidence, locus)
        yield _worst(evidence, vertices, _locus_error(evidence, locus, vertices), (locus.site,))
    for face, sides in zip(evidence.boundary.faces, evidence.face_sides, strict=True):
        carrier = evidence.boundary.carriers[face.carrier]
        for patch, _ in sides:
            vertices = np.unique(evidence.complex.patches[patch].triangles)
            off = np.abs(carrier.signed_distance(evidence.complex.points[vertices]))
            yield _worst(evidence, vertices, off, ())


def _worst(evidence: Evidence, vertices: Ints, error: Array, sites: tuple[int, ...]) -> Worst:
    if not len(vertices):
        return Worst(0.0)
    k = int(np.argmax(error))  # a NaN counts as the largest
    point = evidence.complex.points[vertices[k]]
    return Worst(float(error[k]) / evidence.diagonal, point, sites)


def _sheet_error(evidence: Evidence, sheet: Sheet, vertices: Ints) -> Array:
    points = evidence.complex.points[vertices]
    normal = evidence.complex.patches[sheet.patch].surface.normal(points)
    # the normal points from the first site's foot to the second's
    first, second = (
        _distance(evidence, number, points, _feet(evidence, sheet, number, points, towards))
        for number, towards in zip(sheet.sites, (-normal, normal), strict=True)
    )
    if sheet.sites[0] == sheet.sites[1]:
        # where the two feet merge, on the sheet's rim, Newton's method for a foot creeps
        edge = evidence.boundary.edges[evidence.sites[sheet.sites[0]].index]
        rough = np.flatnonzero(np.maximum(first, second) > evidence.radius[vertices] + CREPT)
        sides = np.zeros((len(rough), 3))
        nearest = norm(_nearest_of_edge(edge, points[rough], sides) - points[rough])
        first[rough], second[rough] = (
            np.where(np.abs(each[rough] - nearest) <= MERGED, nearest, each[rough])
            for each in (first, second)
        )
    else:
        for number, each in zip(sheet.sites, (first, second), strict=True):
            _measure_whole(evidence, number, points, vertices, each)
    off = np.abs(np.stack([first, second]) - evidence.radius[vertices]).max(axis=0)
    return np.asarray(np.maximum(off, np.abs(first - second)))


def _measure_whole(
    evidence: Evidence, number: int, points: Array, vertices: Ints, distance: Array
) -> None:
    """Replace distances (k,) from an edge that are not those of its nearest places.

    An edge is as near to a point of an axis that it winds about on several legs, and on the side
    that counts another leg may end a little farther away.
    """
    site = evidence.sites[number]
    rough = np.flatnonzero(distance > evidence.radius[vertices] + CREPT)
    if site.kind is SiteKind.EDGE and len(rough):
        edge = evidence.boundary.edges[site.index]
        nearest = _nearest_of_edge(edge, points[rough], np.zeros((len(rough), 3)))
        distance[rough] = np.minimum(distance[rough], norm(nearest - points[rough]))


def _feet(evidence: Evidence, sheet: Sheet, number: int, points: Array, towards: Array) -> Array:
    """Where a site's feet (k, 3) are searched, on the side `towards` of a sheet; edges need this.

    A sheet's tangent plane is the mid-plane of the feet of its point, so one is the mirror image of
    the other, and the nearest-site query gives one. At a seam it may give a foot on a third site:
    there the edge's nearest point on the side is taken.
    """
    site = evidence.sites[number]
    if site.kind is not SiteKind.EDGE:
        return points
    found = region_queries(evidence.index, evidence.region).nearest(points)
    across = np.asarray(dot(found.foot - points, towards))[:, None]
    feet = np.where(across > 0, found.foot, found.foot - 2 * across * towards)
    others = np.flatnonzero(~np.isin(found.site, sheet.sites))
    edge = evidence.boundary.edges[site.index]
    feet[others] = _nearest_of_edge(edge, points[others], towards[others])
    return feet


def _nearest_of_edge(edge: Edge, points: Array, towards: Array) -> Array:
    """The nearest point of an edge to each of points (k, 3) that lies to its side `towards`.

    Where none does, or `towards` is zero, the nearest of all; by thirds around a sample.
    """
    if not len(points):
        return np.empty((0, 3))
    s = np.linspace(edge.start, edge.end, SEARCH)
    middle = s[_nearest_samples(edge.curve.point(edge.curve.wrapped(s)), points, towards)]
    low, high = middle - (s[1] - s[0]), middle + (s[1] - s[0])
    if not edge.closed:
        low, high = np.maximum(low, edge.start), np.minimum(high, edge.end)

    def distance(t: Array) -> Array:
        return norm(edge.curve.point(edge.curve.wrapped(t)) - points)

    for _ in range(HALVINGS):
        third = (high - low) / 3
        left = distance(low + third) <= distance(high - third)
        low, high = np.where(left, low, low + third), np.where(left, high - third, high)
    return edge.curve.point(edge.curve.wrapped((low + high) / 2))


def _nearest_samples(samples: Array, points: Array, towards: Array) -> Ints:
    """Which of samples (s, 3) is nearest to each point among those on its side `towards`."""
    result = np.empty(len(points), dtype=np.int64)
    for start in range(0, len(points), BLOCK):
        block = slice(start, start + BLOCK)
        away = samples[None] - points[block, None]
        behind = np.asarray(dot(away, towards[block, None]) < 0)
        behind &= ~behind.all(axis=1, keepdims=True)
        result[block] = np.argmin(np.where(behind, np.inf, dot(away, away)), axis=1)
    return result


def _distance(evidence: Evidence, number: int, points: Array, feet: Array) -> Array:
    """Distance (k,) of points from a site with feet nearby."""
    which = np.full(len(points), number, dtype=np.int64)
    return site_fields(evidence.context, which, points, feet).distance


def _locus_vertices(evidence: Evidence, locus: Reflexive) -> Ints:
    if locus.line is not None:
        return np.unique(evidence.complex.lines[locus.line].vertices)
    return np.array([locus.vertex], dtype=np.int64)


def _locus_error(evidence: Evidence, locus: Reflexive, vertices: Ints) -> Array:
    points = evidence.complex.points[vertices]
    site = evidence.sites[locus.site]
    distance = np.abs(_distance(evidence, locus.site, points, points))
    off = _from_locus(evidence.boundary, site, points)
    return np.maximum(off, np.abs(distance - evidence.radius[vertices]))


def _from_locus(boundary: RegionBoundary, site: Site, points: Array) -> Array:
    """Distance (k,) from a site's reflexive locus."""
    if site.kind is SiteKind.FACE:
        carrier = boundary.carriers[boundary.faces[site.index].carrier]
        away = np.minimum(*(carrier.reflexive_gap(side, points) for side in (1, -1)))
        if np.isfinite(away).all():
            return away
    if site.kind is SiteKind.EDGE:
        curve = boundary.edges[site.index].curve
        if isinstance(curve, Circle):
            return axial_split(points, curve.centre, cross(curve.x, curve.y))[1]
    raise GeometryError(f"the {site.kind.value} {site.name} has no reflexive curve or point")
