"""Seams continued to where their equations lose rank: a measure that vanishes there tells where.

Seams end where two feet run together, where they land on a reflexive locus, or where they come to a
wall along which they run. Newton's method finds none of these places: the equations are singular
there, and close by rounding decides. But each has a measure that is exact at clear points before it
and vanishes linearly along the seam, if it is taken with its known order: the square of the gap
between two feet (`fins`), the root of the distance from a locus (`landing`), the gap from a wall
(`arriving`). Point and feet are smooth functions of it, and are read off at zero.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from decomp.skeletons.seams.steps.states import State
from decomp.vectors import Array, norm


def continued(states: Sequence[State], measures: Array, at: float) -> State:
    """The seam's point at a value of the measure, from points with other values (k,) of it.

    Its radius is the mean distance from its feet, its slope that of the nearest of the points.
    """
    near = states[int(np.argmin(np.abs(measures - at)))]
    point = value_at([s.point for s in states], measures, at)
    feet = value_at([s.feet for s in states], measures, at)
    tangent = value_at([s.tangent for s in states], measures, at)
    radius = float(norm(point - feet).mean())
    return replace(near, point=point, feet=feet, radius=radius, tangent=tangent / norm(tangent))


def value_at(values: Sequence[Array] | Array, known: Array, at: float) -> Array:
    """A smooth function's value, from its values at k different known places: polynomial."""
    weights = [np.prod([(at - b) / (a - b) for b in known if b != a]) for a in known]
    return np.asarray(np.tensordot(np.array(weights), np.array(values), axes=1))
