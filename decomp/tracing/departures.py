"""The seams that truly leave a junction along a facet of the hull of its contact gradients.

To first order all contacts of a facet stay equally near along the facet's normal n. Those of a
facet with more than three corners can part at second order: then several seams leave in the same
direction, with thin sheets between. A little way ahead, at p + h n, the distances d_k to the
contacts are nearly affine across n: d_k + g_k.u, with the g_k on a circle. The points u where three
or more of them are equal and no other is less are the seams; they are the cells of the regular
subdivision of the facet by the heights d_k, and fill it.

Seen from there a contact's foot may be on any of the sites that share it at p.
"""

from __future__ import annotations

from itertools import combinations

import numpy as np

from decomp.errors import GeometryError
from decomp.tracing.contacts import Contacts
from decomp.tracing.fields import support_fields
from decomp.tracing.local import SeamRay
from decomp.tracing.probing import TOWARDS
from decomp.tracing.seams import SeamTracer, State
from decomp.vectors import Array, Ints, frame, norm, place

AHEAD = (1e-3, 1e-4, 1e-2, 1e-5, 3e-2, 1e-1)
"""How far ahead it is looked, as parts of the radius, in this order."""
APART = 1e-12
"""Heights that differ by less than this part of the size are equal."""
PASSES = 6


def departures(
    tracer: SeamTracer, point: Array, touching: Contacts, ray: SeamRay
) -> list[tuple[tuple[int, ...], State]]:
    """The seams that leave along a ray: their contacts, in the ray's order, and a first point each.

    Raises:
        GeometryError: they cannot be told apart.
    """
    for part in AHEAD:
        found = _at(tracer, point, touching, ray, part * touching.radius)
        if found is not None:
            return found
    raise GeometryError(f"the seams that leave {place(point)} cannot be told apart")


def _at(
    tracer: SeamTracer, point: Array, touching: Contacts, ray: SeamRay, h: float
) -> list[tuple[tuple[int, ...], State]] | None:
    """The same as seen a length h ahead, None if that is not conclusive."""
    ahead = point + h * ray.direction
    chosen = list(ray.contacts)
    local = _local(tracer, ahead, touching.feet[chosen])
    if local is None:
        return None
    feet, distance = local
    gradients = (ahead - feet) / distance[:, None]
    found: list[tuple[tuple[int, ...], State]] = []
    for corners, across in _cells(gradients, distance, ray.direction, APART * tracer.size):
        if float(norm(across)) > 0.5 * h:
            return None
        state = tracer.settled(ahead + across, feet[list(corners)], ray.direction)
        if state is None:
            return None
        found.append((tuple(chosen[k] for k in corners), state))
    return found if sum(len(c) - 2 for c, _ in found) == len(chosen) - 2 else None


def _local(tracer: SeamTracer, ahead: Array, feet: Array) -> tuple[Array, Array] | None:
    """Feet (m, 3) of a point on the boundary near known ones, and their distances (m,)."""
    sites: Ints | None = None
    for _ in range(PASSES):
        site = tracer.queries.nearest(ahead + TOWARDS * (feet - ahead)).site.astype(np.int64)
        if sites is not None and (site == sites).all():
            return feet, norm(ahead - feet)
        sites = site
        points = np.repeat(ahead[None], len(feet), axis=0)
        feet = support_fields(tracer.table, sites, points, feet).foot
    return None


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
        if abs(np.linalg.det(matrix)) <= 1e-12:
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
