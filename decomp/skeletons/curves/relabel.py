"""The contacts of curve pieces, as seen from their middles.

A seam is followed over whole carriers. Where a carrier holds several faces of a region, a foot can
pass from one to the next, through a vertex in which they meet, without a change of the distance;
the piece beyond then belongs to other sites.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from decomp.boundary.topology import Convexity, Vertex
from decomp.complex.model import LineKind
from decomp.sites.site import SiteKind
from decomp.skeletons.balls.balls import inscribed_balls
from decomp.skeletons.balls.fields import site_fields
from decomp.skeletons.curves.curve_elements import RayCurve
from decomp.skeletons.curves.incidence import ANGLE, Incidence
from decomp.skeletons.curves.pieces import Contact, CurvePiece
from decomp.vectors import Array, Ints, norm

TOWARDS = 0.3
"""How far towards a foot it is asked which site has it."""
NO_BALL = 1e-6
"""A ball on a vertex that is smaller than this part of the size is none: no ray leaves there."""


def merging_rays(incidence: Incidence) -> list[CurvePiece]:
    """The normals at vertices at which all faces have one normal, up to their maximal balls.

    Contacts on these faces merge in the vertex, so the sheets that start at its convex edges end
    in its normal.
    """
    found = []
    boundary = incidence.boundary
    for vertex in boundary.vertices:
        way = _only_normal(incidence, vertex)
        pairs = {
            _sorted(*(incidence.face_site[f] for f in boundary.edges[e].faces))
            for e in vertex.edges
            if boundary.edges[e].convexity is Convexity.CONVEX
        }
        if way is None or not pairs:
            continue
        balls = inscribed_balls(incidence.context, vertex.point[None], way[None])
        radius = float(balls.radius[0])
        if radius <= NO_BALL * boundary.diagonal:
            continue
        sites = tuple(sorted({site for pair in pairs for site in pair}))
        points = vertex.point + np.linspace(0, radius, 5)[:, None] * way
        curve = RayCurve(vertex.point, way)
        feet = vertex.point[None]
        found.append(
            CurvePiece(LineKind.SEAM, (sites,), curve, points, feet, pairs=tuple(sorted(pairs)))
        )
    return found


def _sorted(a: int, b: int) -> tuple[int, int]:
    return (a, b) if a <= b else (b, a)


def _only_normal(incidence: Incidence, vertex: Vertex) -> Array | None:
    if len(vertex.faces) < 2:
        return None
    ways = np.array([incidence.inward(f, vertex.point[None])[0] for f in vertex.faces])
    return ways[0] if float(norm(ways - ways[0]).max()) <= ANGLE else None


def relabelled(incidence: Incidence, pieces: Sequence[CurvePiece]) -> list[CurvePiece]:
    """Pieces with the feet and contacts of their own middles."""
    return [
        _relabelled(incidence, piece) if piece.kind is LineKind.SEAM and not piece.pairs else piece
        for piece in pieces
    ]


def _relabelled(incidence: Incidence, piece: CurvePiece) -> CurvePiece:
    middle = piece.middle
    which: Ints = np.array([contact[0] for contact in piece.contacts])
    points = np.repeat(middle[None], len(which), axis=0)
    feet = site_fields(incidence.context, which, points, piece.feet).foot
    found = incidence.context.index.nearest(points + TOWARDS * (feet - points)).site
    contacts: list[Contact] = []
    for contact, foot, site in zip(piece.contacts, feet, found.tolist(), strict=True):
        if site in contact or not _alike(incidence, contact[0], site):
            contacts.append(contact)
            continue
        way = (middle - foot) / float(norm(middle - foot))
        contacts.append(incidence.touched(site, foot, way))
    return replace(piece, feet=feet, contacts=tuple(contacts))


def _alike(incidence: Incidence, a: int, b: int) -> bool:
    """Whether two sites are different faces on one carrier, or edges on one pair of carriers."""
    one, two, boundary = incidence.sites[a], incidence.sites[b], incidence.boundary
    if one.kind is not two.kind:
        return False
    if one.kind is SiteKind.FACE:
        return boundary.faces[one.index].carrier == boundary.faces[two.index].carrier
    if one.kind is SiteKind.EDGE:
        edges = boundary.edges[one.index], boundary.edges[two.index]
        return set(edges[0].carriers) == set(edges[1].carriers)
    return False
