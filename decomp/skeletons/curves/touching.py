"""Where a seam or a trim touches a trim without crossing it.

A foot can come to the end of its site and turn back. The curve and the trim over that end then have
a point and a tangent in common, at which both must be cut. Along the curve a measure of how far the
foot is from its site's end has a minimum there that is zero.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from decomp.complex.model import LineKind
from decomp.sites.site import SiteKind
from decomp.skeletons.balls.fields import site_fields
from decomp.skeletons.curves.incidence import Incidence
from decomp.skeletons.curves.pieces import CurvePiece
from decomp.skeletons.seams.minima import least_values
from decomp.tolerance import TINY
from decomp.vectors import Array, Ints, norm

CLOSE = 0.05
"""Minima of the measure (radians, or parts of the size) that are looked at more closely."""
ZERO = 1e-7
RESOLUTION, BESIDE = 1e-11, 1e-3
"""How exactly a touch is placed, and how far it must be from the ends, in parts of a chord."""

Measure = Callable[[Array], Array]


def touching_points(incidence: Incidence, pieces: Sequence[CurvePiece]) -> list[Array]:
    """Points (3,) at which seams and trims touch trims over the ends of their feet's sites."""
    found: list[Array] = []
    for piece in pieces:
        if piece.kind in (LineKind.SEAM, LineKind.TRIM):
            for contact, foot in zip(piece.contacts, piece.feet, strict=True):
                if len(contact) == 1:
                    for measure in _measures(incidence, contact[0], foot):
                        zeros = _zeros(piece, measure)
                        found += [p for p in zeros if _at_end(incidence, contact[0], foot, p)]
    return found


def _at_end(incidence: Incidence, site: int, near: Array, point: Array) -> bool:
    """Whether another site shares the contact of a site from a point (3,)."""
    which = np.array([site])
    found = site_fields(incidence.context, which, point[None], near[None])
    foot = found.foot[0]
    return len(incidence.touched(site, foot, (point - foot) / float(norm(point - foot)))) > 1


def _measures(incidence: Incidence, site: int, near: Array) -> list[Measure]:
    """Measures of how far the feet of points (k, 3) on a site are from its ends."""
    it = incidence.sites[site]
    boundary = incidence.boundary

    def feet(points: Array) -> Array:
        which = np.full(len(points), site, dtype=np.int64)
        known = np.repeat(near[None], len(points), axis=0)
        return site_fields(incidence.context, which, points, known).foot

    if it.kind is SiteKind.EDGE:

        def angle(face: int) -> Measure:
            def measure(points: Array) -> Array:
                q = feet(points)
                way = (points - q) / np.maximum(norm(points - q), TINY)[:, None]
                return norm(way - incidence.inward(face, q))

            return measure

        return [angle(face) for face in boundary.edges[it.index].faces]
    if it.kind is SiteKind.FACE:

        def gap(carrier: int) -> Measure:
            def measure(points: Array) -> Array:
                away = np.abs(boundary.carriers[carrier].signed_distance(feet(points)))
                return np.asarray(away / boundary.diagonal)

            return measure

        return [gap(carrier) for carrier in incidence.reentrant_carriers[it.index]]
    return []


def _zeros(piece: CurvePiece, measure: Measure) -> list[Array]:
    """Points inside a piece at which a measure that is never negative has a zero minimum."""
    points = piece.points
    values = measure(points)
    inner = values[1:-1]
    rows = np.flatnonzero((inner <= values[:-2]) & (inner <= values[2:]) & (inner < CLOSE)) + 1
    if not len(rows):
        return []

    def place(which: Ints, share: Array) -> Array:
        first = rows[which] - (share < 1)
        part = np.where(share < 1, share, share - 1)[:, None]
        return piece.element.place(points[first] + part * (points[first + 1] - points[first]))

    share, least = least_values(
        lambda which, share: measure(place(which, share)),
        np.zeros(len(rows)),
        np.full(len(rows), 2.0),
        RESOLUTION,
    )
    zero = np.flatnonzero((least <= ZERO) & (share > BESIDE) & (share < 2 - BESIDE))
    return list(place(zero, share[zero]))
