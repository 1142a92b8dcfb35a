"""What must hold before a boundary is handed out: bounded, disjoint regions; where these touch."""

from __future__ import annotations

import numpy as np

from decomp.boundary.arcs import Arrangement, Contact
from decomp.boundary.member import Member
from decomp.boundary.wedges import Star
from decomp.carriers import Carrier
from decomp.csg.halfspaces import HalfSpaceForm
from decomp.errors import OverlapError, UnboundedRegionError
from decomp.places import place, triple
from decomp.tolerance import TOLERANCE
from decomp.vectors import Array, Bools, cross, norm, perpendicular

INTO_REGIONS = 1e-6
"""Where regions overlap is told this part of the scale off the face."""
OPPOSITE_WAYS = 1e-6
"""Length of the sum of two unit vectors below which they are opposite: it has no direction."""


def refuse_unbounded(arrangement: Arrangement, member: Member) -> None:
    """Raise UnboundedRegionError if the region reaches the window's end.

    Its edges are checked where they are made. A face that reaches infinity without such an edge
    covers the far end of its carrier; a region without such a face holds all far points or none.
    """
    form, radius = arrangement.form, arrangement.radius
    for index, carrier in enumerate(form.carriers):
        for point in carrier.far_points(form.centre, radius):
            inner, outer = member.sides_at(index, point)
            if bool(inner) != bool(outer):
                _raise_unbounded(member, point)
    odd_direction = np.array([0.5331, -0.6207, 0.5747])
    far = form.centre + 4 * radius * odd_direction / norm(odd_direction)
    if bool(member.holds(form.signed_distances(far) < 0)):
        _raise_unbounded(member, far)


def _raise_unbounded(member: Member, point: Array) -> None:
    away = point - member.form.centre
    raise UnboundedRegionError(
        f"region {member.name!r} is unbounded: it reaches infinity in direction "
        f"{triple(away / norm(away))}; intersect it with a block or add half-spaces"
    )


def refuse_overlaps(form: HalfSpaceForm, arrangement: Arrangement, stars: list[Star]) -> None:
    """Raise OverlapError if two regions share interior points.

    Their common part has a boundary, which has an edge, where a wedge is filled twice, or else is
    a whole sphere or torus.
    """
    if len(form.names) < 2:
        return
    for star in stars:
        for wedge in np.flatnonzero(star.filled.sum(axis=1) > 1):
            _raise_overlap(form, star.filled[wedge], _point_in_wedge(form, star, int(wedge)))
    touched = {k for star in stars for k in (s.carrier for s in star.sheets)}
    rng = np.random.default_rng(0)
    for index, carrier in enumerate(form.carriers):
        if index in touched and carrier.closed:
            continue
        scatter = form.centre + form.scale * rng.normal(size=(64, 3))
        points = carrier.project(scatter)
        for side in (True, False):
            inside = form.signed_distances(points) < 0
            inside[:, index] = side
            filled = form.program.evaluate(inside)
            double = np.flatnonzero(filled.sum(axis=1) > 1)
            if len(double):
                row = int(double[0])
                normal = carrier.normal(points[row])
                step = np.asarray(
                    points[row] + (-1 if side else 1) * INTO_REGIONS * form.scale * normal
                )
                _raise_overlap(form, filled[row], step)


def _point_in_wedge(form: HalfSpaceForm, star: Star, wedge: int) -> Array:
    first = star.sheets[wedge]
    second = star.sheets[(wedge + 1) % len(star.sheets)]
    between = first.direction + second.direction
    gap = (second.angle - first.angle) % (2 * np.pi)
    if gap > np.pi:
        between = -between
    if float(norm(between)) < OPPOSITE_WAYS:
        between = cross(cross(first.direction, second.direction), first.direction)
    for step in form.scale * 10.0 ** -np.arange(1, 12):
        point = star.point + step * between / (norm(between) or 1.0)
        if form.regions_at(point).sum() > 1:
            return np.asarray(point)
    return star.point


def _raise_overlap(form: HalfSpaceForm, filled: Array, point: Array) -> None:
    names = [form.names[k] for k in np.flatnonzero(filled)]
    raise OverlapError(
        f"regions {names[0]!r} and {names[1]!r} overlap: both hold the point {{at}}; "
        "subtract one from the other",
        at=point,
    )


def touch_between(arrangement: Arrangement, contact: Contact, member: Member) -> str | None:
    """Says that a region's boundary touches itself at an isolated point; None if it does not.

    Two carriers that touch leave three layers along their common normal: below both, between
    them all around the point, above both. The region is pinched when it fills only the middle
    layer, or all but the middle one.
    """
    form, point = arrangement.form, contact.point
    i, j = contact.carriers
    inside = np.repeat((form.signed_distances(point) < 0)[None, :], 3, axis=0)
    inside[:, (i, j)] = _layers(form.carriers[i], form.carriers[j], point, form.scale)
    below, between, beyond = member.holds(inside)
    if not below == beyond != between:
        return None
    return (
        f"region {member.name!r} touches itself at the point {place(point)}, where "
        f"{form.carrier_name(i)} and {form.carrier_name(j)} are tangent: leave a gap or let "
        "the parts overlap"
    )


def _layers(a: Carrier, b: Carrier, point: Array, scale: float) -> Bools:
    """Insides (3, 2) of two touching carriers in the layers below, between and above them."""
    for first, second, order in ((a, b, (0, 1)), (b, a, (1, 0))):
        tip, inward = first.tip, first.tip_axis
        if tip is not None and inward is not None and norm(point - tip) <= TOLERANCE * scale:
            within = bool(second.signed_distance(point + 1e-3 * scale * inward) < 0)
            rows = np.array([[True, within], [False, within], [False, not within]])
            return rows[:, order]
    normal = a.normal(point)
    agree = float(normal @ b.normal(point)) > 0
    x = perpendicular(normal)
    lift = 0.0
    for direction in (x, cross(normal, x)):
        bend_b = float(b.normal_curvature(point, direction)) * (1 if agree else -1)
        lift += float(a.normal_curvature(point, direction)) - bend_b
    above = lift > 0  # b runs above a, seen along a's normal
    return np.array([[True, agree], [not above, agree == above], [False, not agree]])
