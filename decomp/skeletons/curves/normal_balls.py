"""The balls over a curve of normals that touch a given site."""

from __future__ import annotations

import numpy as np

from decomp.errors import GeometryError
from decomp.skeletons.balls.raising import touching_radii
from decomp.skeletons.balls.supports import support_table
from decomp.skeletons.curves.incidence import Incidence
from decomp.skeletons.curves.normal_curves import NormalCurve
from decomp.vectors import Array, Ints


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
    table = support_table(incidence.boundary, incidence.sites)
    size = incidence.boundary.diagonal
    return touching_radii(table, size, which, curve.feet(s), curve.directions(s), guess, feet)
