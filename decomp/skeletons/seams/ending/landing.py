"""Where a seam comes down to a reflexive locus in a parabola and ends there.

Such are the seams between edges of one round face that ends in an edge across. The distance from
the locus vanishes with the square of the way that is left, so the seam is a smooth function of the
distance's root: the end is read off at points before it, and these are moved closer to it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable

import numpy as np

from decomp.skeletons.seams.steps.continuing import continued
from decomp.skeletons.seams.steps.states import State
from decomp.vectors import Array, norm

CLEAR = 5
"""Points from which the end is read off."""
NEAREST = 1e-3
"""They are brought so close to the end, in parts of the radius."""
CLOSER = np.linspace(0.3, 0.9, CLEAR)
"""Roots at the next points, in parts of the least before."""
ROUNDS = 8
FARTHEST = 0.2
"""The end is no farther ahead than this part of the radius."""
BENT = 0.1
"""Roots grow evenly with the way from the end, but for this part."""

Settle = Callable[[State], State | None]
APART = 1e-3
"""Roots differ by more than this part of the least."""


def landing(
    ahead: Callable[[float], State | None],
    settle: Settle,
    off: Callable[[Array], float],
    last: State,
) -> tuple[list[State], State] | None:
    """The end of a seam on a locus.

    Args:
        ahead: the seam's point at a length from `last`, None where there is none.
        settle: a point near the seam moved onto it, likewise.
        off: the distance of a point (3,) from the locus.
        last: a point of the seam next to the end.

    Returns:
        Points between `last` and the end, and the end; None if it does not end so.
    """
    left = _left(ahead, off, last, NEAREST * last.radius)
    if left is None or left > FARTHEST * last.radius:
        return None
    step = max(0.5 * left, NEAREST * last.radius)
    states, between = _all(ahead(-float(step * k)) for k in range(CLEAR)), list[State]()
    for _ in range(ROUNDS):
        if len(states) < CLEAR:
            return None
        roots = np.array([off(state.point) ** 0.5 for state in states])
        if not _distinct(roots):
            return None
        end = continued(states, roots, 0.0)
        ways = np.array([norm(state.point - end.point) for state in states])
        if not (np.abs(roots / ways * ways[0] / roots[0] - 1) <= BENT).all():
            return None
        if ways.min() <= NEAREST * last.radius:
            return between, end
        targets = float(roots.min()) * CLOSER
        states = _all(settle(continued(states, roots, float(root))) for root in targets)
        between += states[::-1]
    return None


def _left(
    ahead: Callable[[float], State | None], off: Callable[[Array], float], last: State, step: float
) -> float | None:
    """The way to where the root would vanish if it went on as it has changed."""
    before = ahead(-step)
    if before is None:
        return None
    here, there = off(last.point) ** 0.5, off(before.point) ** 0.5
    return step * here / (there - here) if there > here else None


def _all(states: Iterable[State | None]) -> list[State]:
    return [state for state in states if state is not None]


def _distinct(roots: Array) -> bool:
    """Whether roots are all different and none vanishes."""
    return bool(roots.min() > 0 and np.diff(np.sort(roots)).min() > APART * roots.min())
