"""How exactly the vertices of a skeleton lie on their sheets, loci and faces."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from decomp.boundary.topology import RegionBoundary
from decomp.carriers import Carrier, Cone, Cylinder, Sphere, Torus
from decomp.carriers.axial import axial_split
from decomp.curves.circle import Circle
from decomp.errors import GeometryError
from decomp.sites.site import Site, SiteKind
from decomp.skeleton.balls import largest_gap
from decomp.skeleton.certificate_evidence import Evidence, Worst, worst_of
from decomp.skeleton.fields import site_fields
from decomp.skeleton.result import Reflexive, Sheet
from decomp.vectors import Array, Ints, cross, dot, norm

BLOCK = 1 << 12


def residual(evidence: Evidence) -> Worst:
    """The largest error of placement.

    On a sheet it is the difference of the distances from both sites and from the stored radius; on
    a reflexive locus the distance from the locus and the error of the radius; on a boundary face
    the distance from its carrier.
    """
    return worst_of(_residuals(evidence))


def intrusion(evidence: Evidence) -> Worst:
    """How deep the boundary enters the ball of a skeleton vertex: the worst of all."""
    which = evidence.skeleton_vertices()
    centre, radius = evidence.complex.points[which], evidence.radius[which]
    # each ball by itself would tell where; the maximum over blocks is found first, as it is cheap
    blocks = [slice(k, k + BLOCK) for k in range(0, len(which), BLOCK)]
    gaps = [largest_gap(evidence.index, evidence.region, centre[b], radius[b]) for b in blocks]
    if not gaps or max(gaps) == 0.0:
        return Worst(0.0)
    block = blocks[int(np.argmax(gaps))]
    found = evidence.index.nearest(centre[block])
    reach = np.where(found.region == evidence.region, found.distance, -found.distance)
    k = int(np.argmax(radius[block] - reach))
    return Worst(max(gaps) / evidence.diagonal, centre[block][k], (int(found.site[k]),))


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
    # the normal points from the first site's side to the second's, as its foot does
    first = _distance(evidence, sheet.sites[0], points, -normal)
    second = _distance(evidence, sheet.sites[1], points, normal)
    off = np.abs(np.stack([first, second]) - evidence.radius[vertices]).max(axis=0)
    return np.asarray(np.maximum(off, np.abs(first - second)))


def _distance(evidence: Evidence, number: int, points: Array, towards: Array) -> Array:
    """Distance (k,) from a site whose foot lies in direction `towards` (k, 3) from each point."""
    boundary, site = evidence.boundary, evidence.sites[number]
    feet = points
    if site.kind is SiteKind.EDGE:
        feet = _edge_seeds(boundary.edges[site.index].samples, points, towards)
    which = np.full(len(points), number, dtype=np.int64)
    return site_fields(boundary, evidence.sites, which, points, feet).distance


def _edge_seeds(samples: Array, points: Array, towards: Array) -> Array:
    """The nearest sample (k, 3) of an edge on the side of each point where its foot lies."""
    result = np.empty(points.shape)
    for start in range(0, len(points), BLOCK):
        block = slice(start, start + BLOCK)
        away = samples[None] - points[block, None]
        square = dot(away, away)
        behind = np.asarray(dot(away, towards[block, None]) < 0)
        behind &= ~behind.all(axis=1, keepdims=True)
        hidden = np.where(behind, np.inf, square)
        result[block] = samples[np.argmin(hidden, axis=1)]
    return result


def _locus_vertices(evidence: Evidence, locus: Reflexive) -> Ints:
    if locus.line is not None:
        return np.unique(evidence.complex.lines[locus.line].vertices)
    return np.array([locus.vertex], dtype=np.int64)


def _locus_error(evidence: Evidence, locus: Reflexive, vertices: Ints) -> Array:
    points = evidence.complex.points[vertices]
    site = evidence.sites[locus.site]
    distance = np.abs(_distance(evidence, locus.site, points, np.zeros(points.shape)))
    off = _from_locus(evidence.boundary, site, points)
    return np.maximum(off, np.abs(distance - evidence.radius[vertices]))


def _from_locus(boundary: RegionBoundary, site: Site, points: Array) -> Array:
    """Distance (k,) from a site's reflexive locus."""
    if site.kind is SiteKind.FACE:
        return _from_carrier_locus(boundary.carriers[boundary.faces[site.index].carrier], points)
    if site.kind is SiteKind.EDGE:
        curve = boundary.edges[site.index].curve
        if isinstance(curve, Circle):
            return axial_split(points, curve.centre, cross(curve.x, curve.y))[1]
    raise GeometryError(f"the {site.kind.value} {site.name} has no reflexive curve or point")


def _from_carrier_locus(carrier: Carrier, points: Array) -> Array:
    match carrier:
        case Sphere():
            return norm(points - carrier.centre)
        case Cylinder():
            return axial_split(points, carrier.point, carrier.axis)[1]
        case Cone():
            return axial_split(points, carrier.apex, carrier.axis)[1]
        case Torus():
            z, rho, _ = axial_split(points, carrier.centre, carrier.axis)
            return np.minimum(rho, np.hypot(rho - carrier.major, z))
        case _:
            raise GeometryError(f"a {carrier.kind} has no reflexive locus")
