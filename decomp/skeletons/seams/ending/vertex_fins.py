"""Where two contacts of a seam run together at a vertex of the boundary.

There the equations of the seam lose rank: off the line of normals at the vertex v on which the
place is, two of the distances differ in second order only, so that rounding leaves it uncertain by
1e-8. But the line is known: a foot is at v where (p - v).t = 0, with t the tangent of its edge
at v, or where p - v is along the normal of its face. On it the place is as far from v as from a
third contact.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from decomp.sites.site import SiteKind
from decomp.skeletons.balls.fields import support_fields
from decomp.skeletons.seams.steps.points import SeamPoints
from decomp.skeletons.seams.steps.states import State
from decomp.tolerance import AT_END
from decomp.vectors import Array, norm

STEPS = 20
ACROSS = 1e-3
"""Conditions on the line that differ less than this are one."""
AT_REST = 1e-16
"""Steps below this part of the size are the last ones."""


def at_vertex(
    points: SeamPoints, state: State, pair: tuple[int, int], within: float = AT_END
) -> State | None:
    """The same end of a seam, exactly.

    Args:
        points: of the seam's region.
        state: the end, as far as it is known.
        pair: the contacts that run together.
        within: how far off, as a part of the size, the feet may be from the vertex, and the end.

    Returns:
        None if they do not meet at a vertex, or if their sites do not tell the line of normals.
    """
    vertices = np.array([v.point for v in points.boundary.vertices]).reshape(-1, 3)
    near = within * points.size
    if not len(vertices):
        return None
    gaps = norm(vertices[:, None] - state.feet[list(pair)]).max(axis=1)
    v = vertices[int(np.argmin(gaps))]
    if float(gaps.min()) > near:
        return None
    way = _line_of_normals(points, [state.sites[k] for k in pair], v)
    others = [k for k in range(len(state.sites)) if k not in pair]
    if way is None or not others:
        return None
    way = way if float(way @ (state.point - v)) > 0 else -way
    far = others[0]
    radius, foot = state.radius, state.feet[far]
    for _ in range(STEPS):
        at = support_fields(
            points.table, np.array([state.sites[far]]), (v + radius * way)[None], foot[None]
        )
        foot = at.foot[0]
        step = float(at.distance[0] - radius) / (1 - float(at.gradient[0] @ way))
        radius += step
        if abs(step) <= AT_REST * points.size:
            break
    point = v + radius * way
    if float(norm(point - state.point)) > near:
        return None
    feet = np.array(state.feet)
    feet[list(pair)], feet[far] = v, foot
    return replace(state, point=point, radius=radius, feet=feet)


def _line_of_normals(points: SeamPoints, sites: list[int], v: Array) -> Array | None:
    """The direction in which feet of sites stay at a vertex of theirs, if there is one only."""
    boundary, rows = points.boundary, []
    for number in sites:
        site = points.context.sites[number]
        if site.kind is SiteKind.EDGE:
            curve = boundary.edges[site.index].curve
            tangent = curve.derivative(curve.parameter(v))
            rows.append(tangent / norm(tangent))
        elif site.kind is SiteKind.FACE:
            n = boundary.carriers[boundary.faces[site.index].carrier].normal(v)
            rows.extend(np.eye(3) - np.outer(n, n))
    if not rows:
        return None
    _, sizes, ways = np.linalg.svd(np.array(rows))
    if len(sizes) < 2 or sizes[1] < ACROSS or (len(sizes) > 2 and sizes[2] >= ACROSS):
        return None
    return np.asarray(ways[2])
