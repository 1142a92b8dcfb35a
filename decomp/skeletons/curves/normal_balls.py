"""The balls over a curve of normals that touch a given site."""

from __future__ import annotations

import numpy as np

from decomp.errors import GeometryError
from decomp.skeletons.balls.raising import touching_radii
from decomp.skeletons.curves.edge_wells import EdgeWells
from decomp.skeletons.curves.incidence import Incidence
from decomp.skeletons.curves.normal_curves import NormalCurve
from decomp.vectors import Array, Ints, norm

ROUNDS = 8
"""So many times it is asked whether a ball that has shrunk holds another place of the edge."""


def solve_radius(
    incidence: Incidence, curve: NormalCurve, far: int, s: Array, feet: Array, guess: Array
) -> Array:
    """Radii (k,) of the balls over parameters (k,) that touch site `far` near feet (k, 3).

    Raises:
        GeometryError: there is none; says where.
    """
    r = try_radius(incidence, curve, far, s, feet, guess)
    if np.isnan(r).any():
        bad = curve.feet(s[np.isnan(r)])[0]
        raise GeometryError("the maximal ball at the boundary point {at} is not found", at=bad)
    return r


def try_radius(
    incidence: Incidence, curve: NormalCurve, far: int, s: Array, feet: Array, guess: Array
) -> Array:
    """The same, nan where there is no such ball."""
    which: Ints = np.full(len(s), far, dtype=np.int64)
    table = incidence.context.table
    size = incidence.boundary.diagonal
    return touching_radii(table, size, which, curve.feet(s), curve.directions(s), guess, feet)


def least_radius(
    incidence: Incidence, curve: NormalCurve, far: int, wells: EdgeWells, s: Array, r: Array
) -> Array:
    """Radii (k,) of the largest balls over parameters (k,) that hold no place of a curved edge.

    From a point between two legs of the edge either is as near, and which leg a ball touches first
    changes where nothing else does.

    Args:
        incidence: of the region.
        curve: the normal curve.
        far: the edge's site.
        wells: of the edge.
        s: parameters.
        r: (k,) of balls that touch the edge somewhere; nan stays.
    """
    least, q, n = np.array(r), curve.feet(s), curve.directions(s)
    rows = np.flatnonzero(np.isfinite(least))
    for _ in range(ROUNDS):
        centres = q[rows] + least[rows, None] * n[rows]
        which, feet = wells.near(centres)
        # the edge can be the one that the ball stands on
        other = norm(feet - q[rows[which]]) > 2 * wells.apart
        which, feet = which[other], feet[other]
        at = rows[which]
        tried = try_radius(incidence, curve, far, s[at], feet, least[at])
        before = np.array(least)
        np.fmin.at(least, at, tried)
        rows = rows[least[rows] < before[rows]]
        if not len(rows):
            break
    return least
