"""Where a seam comes to a wall along which it then runs.

So it does on a reflexive locus, from every point of which a whole arc is as near: the seam's feet
stay on the arc's ends. Where the last one comes to its end the edge keeps its distance to fourth
order, and the foot can be found anywhere near. So the place is read off at clear points before it.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from decomp.skeletons.seams.steps.continuing import value_at

HALVINGS = 40
CLEAR, APART = 4, 5e-4
"""At so many points before the wall it is read off where it is, so far apart in radii."""
BENT = 0.1
"""The gaps there grow evenly, but for this part."""


def arrival(
    gap: Callable[[float], float], low: float, high: float, near: float, radius: float
) -> float | None:
    """The length along a seam at which it comes to a wall, by inverse interpolation.

    Args:
        gap: from the wall at a length, not finite where it is not known.
        low, high: lengths before the wall and on it.
        near: gaps below say nothing.
        radius: of the seam's balls there.

    Returns:
        None if the gap does not vanish linearly there.
    """
    for _ in range(HALVINGS):
        middle = (low + high) / 2
        if abs(gap(middle)) > near:
            low = middle
        else:
            high = middle
    steps = np.arange(1.0, CLEAR + 1)
    lengths = high - APART * radius * steps
    gaps = np.array([gap(float(length)) for length in lengths])
    if not (np.abs(gaps - steps * gaps[0]) <= BENT * np.abs(gaps)).all():
        return None
    return float(value_at(lengths, gaps, 0.0))
