"""Carriers that all but coincide near a point: three bars of one radius whose axes nearly meet."""

from __future__ import annotations

import numpy as np
import pytest

import decomp
from decomp.csg.primitives import Cylinder
from decomp.csg.solid import union
from tests.laws.effort import FACTOR

TILTS = (1e-3, 5e-4, 2e-4, 1e-4)


def knot(ends: np.ndarray) -> decomp.Geometry:
    """The union of bars of radius 1 between points (k, 2, 3)."""
    return decomp.Geometry(union([Cylinder(a, b, 1.0) for a, b in ends]))


@pytest.mark.parametrize("tilt", TILTS)
def test_one_of_three_bars_is_tilted_a_little(tilt: float) -> None:
    ends = np.array(
        [
            [(0, 10, 0), (0, -10, 0)],
            [(10, 0, -10 * tilt), (-10, 0, 10 * tilt)],
            [(-7, 7, 0), (7, -7, 0)],
        ]
    )
    region = knot(ends).regions[0]
    assert (region.euler, len(region.faces), len(region.edges)) == (1, 12, 18)
    assert region.volume == pytest.approx(172.3216, abs=1e-4)


def test_two_axes_meet_and_one_passes_by() -> None:
    """Figures of the knot from an independent computation."""
    ends = np.array(
        [
            [(0.001, 10.122, 0), (0, -10.128, 0)],
            [(10.125, -0.003, -0.005), (-10.124, -0.002, 0.005)],
            [(-7.158, 7.161, 0.003), (7.163, -7.157, -0.002)],
        ]
    )
    region = knot(ends).regions[0]
    assert (region.euler, len(region.faces)) == (1, 11)
    assert region.volume == pytest.approx(175.30868, abs=1e-5)


@pytest.mark.parametrize("seed", range(int(12 * FACTOR)))
def test_bars_that_all_hold_the_origin_are_one_ball(seed: int) -> None:
    """Convex parts with a common point are star-shaped together."""
    rng = np.random.default_rng(seed)
    size = 10.0 ** rng.uniform(-5, -2)
    turns = np.array([0.0, np.pi / 2, rng.choice([np.pi / 4, np.pi / 3, 2.0])])
    ways = np.stack([np.cos(turns), np.sin(turns), np.zeros(3)], axis=1)
    digits = int(rng.choice([3, 6, 9]))
    ends = np.round(
        np.stack([10 * ways, -10 * ways], axis=1) + size * rng.uniform(-1, 1, (3, 2, 3)), digits
    )
    region = knot(ends).regions[0]
    assert region.euler == 1
    # nearly the knot whose axes meet
    plain = knot(np.stack([10 * ways, -10 * ways], axis=1)).regions[0]
    assert region.volume == pytest.approx(plain.volume, abs=30 * (size + 10.0**-digits))
