"""Points at equal distance from two, three or more sites, by minimum-norm Newton (design: 3.3).

Two sites leave a point two ways to go (a sheet), three one (a seam), four none (a junction); more
than four meet at degenerate junctions, where the system is consistent though overdetermined. Each
step is the shortest that solves the linearised equations, so a point moves straight across to its
element and not along it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from decomp.skeletons.balls.balance import balance_all
from decomp.skeletons.balls.contact_rows import contact_rows
from decomp.skeletons.balls.raising import raised
from decomp.skeletons.balls.region_context import RegionContext
from decomp.skeletons.balls.supports import SupportTable
from decomp.tolerance import CONVERGED
from decomp.vectors import Array, Bools, Ints, norm

POLISHED = 1e-6
"""How far, as a part of the size, a point over its foot is moved by Newton's method at most."""


@dataclass(frozen=True, eq=False)
class Equidistant:
    """Points brought onto their Voronoi elements.

    Args:
        points: (k, 3).
        radius: their common distance from the sites (k,).
        feet: (k, m, 3), on each site.
        residual: (k,), largest difference between the distances.
        converged: (k,), whether Newton's method came to rest.
    """

    points: Array
    radius: Array
    feet: Array
    residual: Array
    converged: Bools


def equidistant(context: RegionContext, which: Ints, points: Array, feet: Array) -> Equidistant:
    """Move points to where they are equally far from all their sites.

    Args:
        context: of the region.
        which: (k, m) sites of each point, m at least 2.
        points: (k, 3), near their elements.
        feet: (k, m, 3), a foot on each site, or close to it.
    """
    return balanced(context.table, context.size, which, points, feet)


def placed_between(context: RegionContext, which: Ints, points: Array, feet: Array) -> Equidistant:
    """Points at equal distance from two sites each.

    Newton's method takes the shortest way there, if it gets there; where it does not, as where the
    distances' gradients are equal, the point over one of the feet is taken.

    Args:
        context: of the region.
        which: (k, 2) sites of each point.
        points: (k, 3).
        feet: (k, 2, 3), a foot on each site, or close to it.
    """
    table, size = context.table, context.size
    found = balanced(table, size, which, points, feet)
    lost = np.flatnonzero(~found.converged)
    if not len(lost):
        return found
    over, touched, good = raised(table, size, which[lost], points[lost], feet[lost])
    rows = lost[good]
    again = balanced(table, size, which[rows], over[good], touched[good])
    # what rounding is left goes in one step; a way farther than that has left the sheet's branch
    near = again.converged & (norm(again.points - over[good]) <= POLISHED * size)
    rows = rows[near]
    for name in ("points", "radius", "feet", "residual", "converged"):
        getattr(found, name)[rows] = getattr(again, name)[near]
    return found


def balanced(
    table: SupportTable, size: float, which: Ints, points: Array, feet: Array
) -> Equidistant:
    """The same for rows of a table of supports of a model of a given size."""
    x = np.array(points, dtype=np.float64)
    n, count = which.shape
    found = np.array(feet, dtype=np.float64, order="C").reshape(n, count, 3)
    radius, residual = np.empty(n), np.empty(n)
    balance_all(table, contact_rows(which, found, size), x, radius, residual)
    converged = np.isfinite(x).all(axis=1) & (residual <= CONVERGED * size)
    return Equidistant(x, radius, found, residual, converged)
