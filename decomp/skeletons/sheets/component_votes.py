"""Which parts of a triangulated footprint are sheets: a few triangles of each are asked."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from decomp.complex.plane.planar import Triangulation
from decomp.errors import GeometryError
from decomp.vectors import Array, Bools, Ints, norm

TESTS = 7
"""Triangles of each component at which it is asked what it is."""
UNCLEAR = 0.1
"""A component with votes of more weight than this on either side is neither sheet nor none. Votes
count by inradius: a sliver beside a border can lie on its wrong side."""


class MissingCurveError(GeometryError):
    """A part of a footprint is partly sheet and partly not: a curve between them is not known."""


def kept_components(
    found: Triangulation, points: Array, ask: Callable[[Ints, Array], Bools], name: str
) -> list[int]:
    """Numbers of the components that are sheets.

    Args:
        found: the triangulation.
        points: (n, 3) on the sheets, its vertices.
        ask: whether triangles (k,) are on sheets, at barycentric coordinates (k, 3).
        name: of the sheets in messages.

    Raises:
        MissingCurveError: a component is neither a sheet nor none.
    """
    weights, inradius = incentres(found.corners)
    rows, owner = [], []
    for number in range(found.components):
        members = np.flatnonzero(found.component == number)
        chosen = members[np.argsort(-inradius[members])[:TESTS]]
        rows.extend(chosen.tolist())
        owner.extend([number] * len(chosen))
    if not rows:
        return []
    asked: Ints = np.array(rows)
    yes, owners = ask(asked, weights[asked]), np.array(owner)
    kept = []
    for number in range(found.components):
        own = owners == number
        share = float(np.average(yes[own], weights=inradius[asked][own]))
        if UNCLEAR < share < 1 - UNCLEAR:
            odd = asked[own][yes[own] != (share > 0.5)][0]
            at = weights[odd] @ points[found.triangles[odd]]
            raise MissingCurveError(f"the sheet {name} has no clear end near {{at}}", at=at)
        if share > 0.5:
            kept.append(number)
    return kept


def incentres(corners: Array) -> tuple[Array, Array]:
    """Barycentric coordinates (m, 3) of the incentres of plane triangles, and inradii (m,)."""
    a, b, c = (corners[:, k] for k in range(3))
    sides = np.stack([norm(b - c), norm(c - a), norm(a - b)], axis=1)
    perimeter = sides.sum(axis=1)
    doubled = np.abs((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0])
    return sides / perimeter[:, None], doubled / perimeter
