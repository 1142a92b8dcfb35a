"""Which sheets meet along a curve piece, and between which sites.

Around a curve of the skeleton the sheets leave between neighbouring contacts. Where every contact
is one site, the contacts' order around the curve tells the sheets. Where sites share a contact, or
on a reflexive locus, where an arc of contacts is touched, the nearest sites of a small ring of
points around the curve are asked: a sheet leaves where the nearest foot jumps.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from decomp.complex.model import LineKind
from decomp.errors import GeometryError
from decomp.sites.occupancy import Labels
from decomp.skeletons.curves.incidence import Incidence
from decomp.skeletons.curves.pieces import CurvePiece, middle_row
from decomp.vectors import Array, frame, norm

RING = 360
REACH = 2e-3
"""Radius of the ring, as a part of the ball's radius and of the piece's length."""
JUMP = 0.02
"""Feet of neighbouring ring points that are farther apart than this part of the ball's radius, or
of all feet's spread where this is less, belong to two contacts, unless they move on steadily."""
ONE_FOOT = 1e-6
"""Feet closer to each other than this part of the radius are one."""
HALVINGS = 12

Pair = tuple[int, int]


def with_pairs(incidence: Incidence, pieces: Sequence[CurvePiece]) -> list[CurvePiece]:
    """Fill in the pairs of every piece."""
    result = []
    for piece in pieces:
        if piece.pairs:
            result.append(piece)
        elif piece.kind is LineKind.REFLEXIVE or any(len(c) > 1 for c in _beside(piece)):
            result.append(replace(piece, pairs=_ring(incidence, piece)))
        elif piece.kind is LineKind.TRIM:
            near, far = piece.contacts
            result.append(replace(piece, pairs=tuple(_pair(a, far[0]) for a in near)))
        else:
            result.append(replace(piece, pairs=_cyclic(piece)))
    return result


def _beside(piece: CurvePiece) -> tuple[tuple[int, ...], ...]:
    """The contacts that must be one site each for the simple rules: all but a trim's near one."""
    return piece.contacts[1:] if piece.kind is LineKind.TRIM else piece.contacts


def _pair(a: int, b: int) -> Pair:
    return (a, b) if a <= b else (b, a)


def _tangent(piece: CurvePiece) -> Array:
    k = middle_row(piece.points)
    along = piece.points[k + 1] - piece.points[k - 1]
    length = float(norm(along))
    if not length > 0:
        raise GeometryError("a curve turns back on itself near {at}", at=piece.points[k])
    return np.asarray(along / length)


def _cyclic(piece: CurvePiece) -> tuple[Pair, ...]:
    """Pairs of contacts that are neighbours around the curve."""
    middle, tangent = piece.middle, _tangent(piece)
    x, y = frame(tangent)
    away = middle - piece.feet
    away = away / norm(away)[:, None]
    around = away - away.mean(axis=0)
    order = np.argsort(np.arctan2(around @ y, around @ x))
    sites = [piece.contacts[k][0] for k in order]
    return tuple(_pair(a, b) for a, b in zip(sites, (*sites[1:], sites[0]), strict=True))


def _ring(incidence: Incidence, piece: CurvePiece) -> tuple[Pair, ...]:
    middle = piece.middle
    x, y = frame(_tangent(piece))
    queries = incidence.context.queries
    radius = float(queries.depth(middle[None])[1][0])
    reach = REACH * min(radius, piece.length)
    angles = np.linspace(0, 2 * np.pi, RING, endpoint=False) + 0.1234567

    def at(angle: Array) -> tuple[Labels, Array]:
        ring = middle + reach * (np.cos(angle)[:, None] * x + np.sin(angle)[:, None] * y)
        found = queries.nearest(ring)
        if (found.region != incidence.region).any():
            raise GeometryError("the sheets around {at} cannot be told apart", at=middle)
        return found.site, found.foot

    sites, feet = at(angles)
    pairs = []
    step = norm(np.roll(feet, -1, axis=0) - feet)
    # seen from far away all feet are close to each other
    spread = float(norm(feet - feet.mean(axis=0)).max())
    jump = JUMP * min(radius, max(spread, ONE_FOOT * radius))
    for k in np.flatnonzero(step > jump):
        low, high = angles[k], angles[k] + 2 * np.pi / RING
        a, b = (sites[k], feet[k]), (sites[(k + 1) % RING], feet[(k + 1) % RING])
        for _ in range(HALVINGS):
            middle_angle = (low + high) / 2
            (site,), (foot,) = at(np.array([middle_angle]))
            if float(norm(foot - a[1])) <= float(norm(foot - b[1])):
                low, a = middle_angle, (site, foot)
            else:
                high, b = middle_angle, (site, foot)
        if float(norm(a[1] - b[1])) > jump:
            pairs.append(_pair(int(a[0]), int(b[0])))
    return tuple(pairs)
