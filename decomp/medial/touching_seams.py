"""Where two seams touch each other: each is as near to the other's site in that point only.

Seams that border one sheet have two contacts in common. Where they touch the ball has the contacts
of both, and along either the other's own contact comes down to the ball and leaves it again, to
second order. Nothing leaves such a point that does not pass through it, so that tracing finds no
node there; but the curves must be cut in it.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations

import numpy as np

from decomp.complex.model import LineKind
from decomp.medial.curve_elements import SeamCurve
from decomp.medial.incidence import Incidence
from decomp.medial.pieces import CurvePiece
from decomp.medial.touching import Measure, zero_minima
from decomp.sites import SiteIndex
from decomp.tracing.contacts import ContactFinder
from decomp.tracing.fields import site_fields
from decomp.vectors import Array, Ints, norm

APART = 0.1
"""Feet on one site are of different contacts if they are farther apart than this part of the
radius."""


def touching_seams(
    index: SiteIndex, incidence: Incidence, pieces: Sequence[CurvePiece]
) -> list[Array]:
    """Points (3,) at which seams touch each other.

    Args:
        index: nearest-site queries.
        incidence: of the region.
        pieces: the region's curves.
    """
    seams = [p for p in pieces if p.kind is LineKind.SEAM and isinstance(p.element, SeamCurve)]
    boxes = [(p.points.min(axis=0), p.points.max(axis=0)) for p in seams]
    finder = ContactFinder(index, incidence.boundary, incidence.region)
    found: list[Array] = []
    for i, j in combinations(range(len(seams)), 2):
        slack = _longest(seams[i]) + _longest(seams[j])
        (low, high), (other_low, other_high) = boxes[i], boxes[j]
        if (low > other_high + slack).any() or (other_low > high + slack).any():
            continue
        own = _own_contact(incidence, seams[i], seams[j])
        if own is None:
            continue
        site, foot = own
        for point in zero_minima(seams[i], _gap(incidence, seams[i], site, foot)):
            touched = finder.at(point, incidence.boundary.tolerances.touching)
            if any(site in sharing for sharing in touched.sites):
                found.append(point)
    return found


def _longest(piece: CurvePiece) -> float:
    return float(norm(np.diff(piece.points, axis=0)).max())


def _own_contact(
    incidence: Incidence, one: CurvePiece, other: CurvePiece
) -> tuple[int, Array] | None:
    """The site and foot (3,) that another seam has beside two contacts of one, None if it has none.

    It is seen at the point of the one that is nearest to the other.
    """
    a, b = one.element, other.element
    assert isinstance(a, SeamCurve) and isinstance(b, SeamCurve)
    common = set(a.sites) & set(b.sites)
    if len(common) < 2:
        return None
    gaps = norm(a.points[:, None] - b.points[None])
    row, column = np.unravel_index(int(gaps.argmin()), gaps.shape)
    point, which = a.points[row], np.array(b.sites)
    points = np.repeat(point[None], len(which), axis=0)
    feet = site_fields(incidence.boundary, incidence.sites, which, points, b.feet[column]).foot
    radius = float(norm(point - a.feet[row, 0]))
    apart = norm(feet[:, None] - a.feet[row][None]) > APART * radius
    same = which[:, None] == np.array(a.sites)[None]
    new = np.flatnonzero((apart | ~same).all(axis=1))
    if len(new) != 1:
        return None
    k = int(new[0])
    return b.sites[k], feet[k]


def _gap(incidence: Incidence, piece: CurvePiece, site: int, near: Array) -> Measure:
    """How much farther than its balls' radii points of a seam are from another site.

    As a part of the size; `near` is a foot (3,) on the site.
    """
    boundary, element = incidence.boundary, piece.element
    assert isinstance(element, SeamCurve)

    def measure(points: Array) -> Array:
        feet = element.feet_near(points)[:, 0]
        which: Ints = np.full(len(points), element.sites[0], dtype=np.int64)
        radius = site_fields(boundary, incidence.sites, which, points, feet).distance
        which = np.full(len(points), site, dtype=np.int64)
        known = np.repeat(near[None], len(points), axis=0)
        away = site_fields(boundary, incidence.sites, which, points, known).distance
        return np.asarray(np.abs(away - radius) / boundary.diagonal)

    return measure
