"""Boundaries and queries are the same far from the origin, 1,000 and 100,000 diagonals away."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

import decomp
from decomp.csg.solid import Solid
from decomp.errors import GeometryError
from decomp.vectors import Array, norm
from tests.laws.tangent import KINDS
from tests.solids import SOLIDS

SOME = ("through hole", "cross-drilled block", "conical pit", "half torus", "oblique cone", "slot")
FAR = (1e3, 1e5)
WAY = np.array([0.6, -0.48, 0.64])


def offset(g: decomp.Geometry, times: float) -> Array:
    return np.round(times * g.diagonal * WAY)


@pytest.mark.parametrize("times", FAR)
@pytest.mark.parametrize("name", SOME)
def test_solids_far_away(name: str, times: float) -> None:
    check(SOLIDS[name].make(), times)


@pytest.mark.parametrize("times", FAR)
@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.__name__)
def test_solids_that_touch_far_away(
    kind: Callable[[np.random.Generator], Solid], times: float
) -> None:
    made = (kind(np.random.default_rng(seed)) for seed in range(20))
    check(next(solid for solid in made if not is_refused(solid)), times)


def is_refused(solid: Solid) -> bool:
    try:
        decomp.Geometry(solid)
    except GeometryError:
        return True
    return False


def check(solid: Solid, times: float) -> None:
    here = decomp.Geometry(solid)
    away = offset(here, times)
    there = decomp.Geometry(solid.translate(away))
    size = here.diagonal
    rounding = 1e-15 * times * size
    for one, other in zip(here.regions, there.regions, strict=True):
        assert (one.euler, len(one.faces), len(one.edges)) == (
            other.euler,
            len(other.faces),
            len(other.edges),
        )
        assert other.volume == pytest.approx(one.volume, rel=1e-10)
    low, high = here.regions[0].bounds
    p = np.random.default_rng(3).uniform(low - 0.2 * size, high + 0.2 * size, (2000, 3))
    # what coordinates there cannot tell is left out
    p = (p + away) - away
    found, moved = here.nearest(p), there.nearest(p + away)
    assert np.allclose(moved.distance, found.distance, rtol=0, atol=rounding)
    assert np.allclose(norm(p + away - moved.foot), moved.distance, atol=rounding)
