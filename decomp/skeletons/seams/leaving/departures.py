"""The seams that truly leave a point along a facet of the hull of its contact gradients.

To first order all contacts of a facet stay equally near along the facet's normal n. Those of a
facet with more than three corners can part at second order: then several seams leave in the same
direction, with thin sheets between. A little way ahead, at p + h n, the distances d_k to the
contacts are nearly affine across n: d_k + g_k.u, with the g_k on a circle. The points u where three
or more of them are equal and no other is less are the seams; they are the cells of the regular
subdivision of the facet by the heights d_k, and fill it.

Seen from there a contact's foot may be on any of the sites that share it at p, and on several of
them: a foot at a vertex can unfold into one on each of two edges.
"""

from __future__ import annotations

from itertools import combinations

import numpy as np

from decomp.curves.line import Line
from decomp.errors import GeometryError
from decomp.sites.site import SiteKind
from decomp.skeletons.balls.contacts import Contacts
from decomp.skeletons.balls.fields import support_fields
from decomp.skeletons.balls.probing import TOWARDS
from decomp.skeletons.seams.leaving.local import SeamRay
from decomp.skeletons.seams.steps.points import SeamPoints
from decomp.skeletons.seams.steps.states import State
from decomp.vectors import Array, Ints, frame, norm

AHEAD = (1e-2, 1e-3, 1e-4, 1e-5, 3e-2, 1e-1, 1e-6, 1e-7)
"""How far ahead it is looked, as parts of the radius, in this order."""
APART = 1e-12
"""Heights that differ by less than this part of the size are equal."""
SAME = 1e-2
"""Feet nearer than this part of the way ahead are one."""
NEARER = 0.1
ASIDE = 0.5
"""Seams farther aside than this part of the way ahead leave in another direction."""
IN_LINE = 1e-12
"""Corners span a facet if it has at least this area: no three are in line."""


def departures(
    points: SeamPoints, point: Array, touching: Contacts, ray: SeamRay
) -> list[tuple[tuple[int, ...], State]]:
    """The seams that leave along a ray: their contacts, in cyclic order, and a first point each.

    A contact whose foot unfolds stands several times.

    Raises:
        GeometryError: they cannot be told apart.
    """
    for part in AHEAD:
        found = _at(points, point, touching, ray, part * touching.radius)
        if found is not None:
            return found
    if all(len(touching.sites[k]) == 1 for k in ray.contacts):
        # the seam may be shorter than it is looked ahead: it starts at the point itself
        which = [touching.sites[k][0] for k in ray.contacts]
        feet = touching.feet[list(ray.contacts)]
        state = points.state(which, point, feet, ray.direction)
        if state is not None:
            return [(ray.contacts, state)]
    raise GeometryError("the seams that leave {at} cannot be told apart", at=point)


def _at(
    points: SeamPoints, point: Array, touching: Contacts, ray: SeamRay, h: float
) -> list[tuple[tuple[int, ...], State]] | None:
    """The same as seen a length h ahead, None if that is not conclusive."""
    ahead = point + h * ray.direction
    local = _local(points, ahead, touching, ray, h)
    if local is None:
        return None
    contacts, feet, distance = local
    apart = APART * points.size
    cells = _cells((ahead - feet) / distance[:, None], distance, ray.direction, apart)
    if len(cells) == 1 and len(cells[0][0]) > 3 and float(norm(cells[0][1])) <= ASIDE * h:
        # contacts that part at a higher order do so beside the point where the others meet
        beside = ahead + cells[0][1]
        again = _local(points, beside, touching, ray, h)
        if again is not None:
            ahead, (contacts, feet, distance) = beside, again
            cells = _cells((ahead - feet) / distance[:, None], distance, ray.direction, apart)
    unfolds = len(set(contacts.tolist())) < len(contacts)
    found: list[tuple[tuple[int, ...], State]] = []
    for corners, across in cells:
        chosen = list(corners)
        if float(norm(across)) > ASIDE * h:
            if unfolds:
                continue
            return None
        start = ahead + across
        state = points.settled(start, feet[chosen], ray.direction)
        if state is None or not _holds_before(points, point, state, ray):
            return None
        leaving = tuple(contacts[chosen].tolist())
        unfolded = _unfolded(points, touching, ray, leaving, state)
        unfolds |= unfolded is not None
        found.append(unfolded or (leaving, state))
    if unfolds:
        whole = {c for corners, _ in found for c in corners} == set(contacts.tolist())
    else:
        whole = sum(len(c) - 2 for c, _ in found) == len(contacts) - 2
    return found if whole else None


def _unfolded(
    points: SeamPoints, touching: Contacts, ray: SeamRay, leaving: tuple[int, ...], state: State
) -> tuple[tuple[int, ...], State] | None:
    """A seam's contacts and first point if its foot on a bent edge unfolds into two on this edge.

    At p, an end of the edge's sheet with itself, both are one, from which neither is found alone.
    """
    sites = [points.context.sites[k] for k in state.sites]
    edges = [points.boundary.edges[s.index] for s in sites if s.kind is SiteKind.EDGE]
    if all(isinstance(edge.curve, Line) for edge in edges):
        return None
    ahead = points.contacts.at(state.point, points.tolerances.same)
    if len(ahead.feet) != len(leaving) + 1:
        return None
    nearest = norm(ahead.feet[:, None] - touching.feet[None, list(leaving)]).argmin(axis=1)
    order = _around(ray.direction, state.point, ahead.feet)
    whole = points.settled(state.point, ahead.feet[order], ray.direction)
    if whole is None or set(nearest.tolist()) != set(range(len(leaving))):
        return None
    return tuple(leaving[k] for k in nearest[order].tolist()), whole


def _around(direction: Array, point: Array, feet: Array) -> Ints:
    """The cyclic order of feet (m, 3) of a point, seen along a direction."""
    x, y = frame(direction)
    away = feet - point
    return np.argsort(np.arctan2(-away @ y, -away @ x))


def _holds_before(points: SeamPoints, point: Array, state: State, ray: SeamRay) -> bool:
    """Whether a seam has the same sites on the way to its first point."""
    nearer = point + NEARER * (state.point - point)
    before = points.state(state.sites, nearer, state.feet, ray.direction)
    return before is not None and points.holds(before)


def _local(
    points: SeamPoints, ahead: Array, touching: Contacts, ray: SeamRay, h: float
) -> tuple[Ints, Array, Array] | None:
    """The feet of a point on the boundary near those of a ray's contacts.

    Returns:
        For each foot the contact (m,) that it comes from, the foot (m, 3) and the distance (m,), in
        cyclic order.
    """
    listed = [(c, site) for c in ray.contacts for site in touching.sites[c]]
    contacts, sites = (np.array(column, dtype=np.int64) for column in zip(*listed, strict=True))
    copies = np.repeat(ahead[None], len(sites), axis=0)
    feet = support_fields(points.table, sites, copies, touching.feet[contacts]).foot
    distance = norm(ahead - feet)
    found = points.queries.nearest(ahead + TOWARDS * (feet - ahead)).distance
    true = np.abs(found - (1 - TOWARDS) * distance) <= points.tolerances.converged
    true &= norm(feet - touching.feet[contacts]) <= 0.5 * touching.radius
    kept: list[int] = []
    for k in np.flatnonzero(true):
        if points.contacts.is_on(int(sites[k]), feet[k]) and all(
            float(norm(feet[k] - feet[j])) > SAME * h for j in kept
        ):
            kept.append(int(k))
    if set(contacts[kept].tolist()) != set(ray.contacts):
        return None
    rows = np.array(kept)[_around(ray.direction, ahead, feet[kept])]
    return contacts[rows], feet[rows], distance[rows]


def _cells(
    gradients: Array, distance: Array, direction: Array, apart: float
) -> list[tuple[tuple[int, ...], Array]]:
    """Where three or more of the functions d_k + g_k.u are equal and none is less.

    Returns:
        The functions of each such point, in their order, and u (3,).
    """
    if len(gradients) == 3:
        return [((0, 1, 2), np.zeros(3))]
    x, y = frame(direction)
    plane = np.stack([gradients @ x, gradients @ y], axis=1)
    found: dict[tuple[int, ...], Array] = {}
    for triple in combinations(range(len(gradients)), 3):
        first, *rest = triple
        matrix = plane[rest] - plane[first]
        if abs(np.linalg.det(matrix)) <= IN_LINE:
            continue
        u = np.linalg.solve(matrix, distance[first] - distance[rest])
        value = distance + plane @ u
        level = value[first]
        if (value < level - apart).any():
            continue
        corners = tuple(np.flatnonzero(value <= level + apart).tolist())
        found.setdefault(corners, u[0] * x + u[1] * y)
    largest = [c for c in found if not any(set(c) < set(other) for other in found)]
    return [(corners, found[corners]) for corners in largest]
