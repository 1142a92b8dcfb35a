"""Seams that come to a wall of their sites, and feet at points where carriers touch."""

from __future__ import annotations

from math import cos, nan, sin

import numpy as np
import pytest

import decomp
from decomp.sites.site import SiteKind
from decomp.skeletons.balls.fields import site_fields
from decomp.skeletons.balls.region_context import RegionContext
from decomp.skeletons.seams.ending.arriving import arrival
from tests.solids import SOLIDS

NEAR = 1e-13


def test_the_place_is_read_off_before_rounding_decides() -> None:
    """The gap falls evenly to 0 at 1.25, and is anything small from a little before that on."""

    def gap(length: float) -> float:
        if length > 1.25 - 1e-7:
            return 1e-6 * sin(1e9 * length) if length < 1.25 + 1e-6 else 0.0
        return 1.0 - cos(1.25 - length) + 0.3 * sin(1.25 - length)

    assert arrival(gap, 0.5, 1.26, NEAR, radius=1.0) == pytest.approx(1.25, abs=1e-10)


@pytest.mark.parametrize(
    "gap",
    [
        lambda length: max(1.25 - length, 0.0) ** 2,
        lambda length: nan if length < 1.249 else max(1.25 - length, 0.0),
    ],
    ids=["touched only", "not known before"],
)
def test_there_is_none_where_the_gap_does_not_fall_evenly(gap: object) -> None:
    assert arrival(gap, 1.24, 1.26, NEAR, radius=1.0) is None  # type: ignore[arg-type]


@pytest.mark.parametrize("seed", range(8))
def test_feet_stay_on_the_edge_where_its_carriers_touch(seed: int) -> None:
    """Equal cylinders touch where their edges cross: nothing tells the edges' tangents there."""
    rng = np.random.default_rng(seed)
    axis, angle, shift = rng.normal(size=3), float(rng.uniform(0, 360)), rng.normal(size=3)
    tee = SOLIDS["equal tee"].make().rotate(axis, angle).translate(shift)
    geometry = decomp.Geometry(tee)
    boundary, sites = geometry.regions[0], geometry.index.sites
    (saddle, *others) = boundary.vertices
    centre = np.mean([saddle.point, others[0].point], axis=0)
    for number, site in enumerate(sites):
        if site.kind is SiteKind.EDGE and site.region == 0:
            start = saddle.point + 1e-8 * rng.normal(size=(50, 3))
            which = np.full(len(start), number, dtype=np.int64)
            points = np.tile(centre, (len(start), 1))
            found = site_fields(RegionContext(geometry.index, 0), which, points, start)
            assert found.distance == pytest.approx(1.0, abs=1e-14)
            assert found.foot == pytest.approx(np.tile(saddle.point, (len(start), 1)), abs=1e-6)
