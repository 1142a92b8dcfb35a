"""General surfaces that are empty, or lines where the sites only touch."""

from __future__ import annotations

import pytest

from decomp.voronoi import (
    CarrierSite,
    ConeSite,
    CylinderSite,
    Kind,
    PlaneSite,
    SphereSite,
    TorusSite,
    surface,
)
from tests.voronoi.independent import equidistant_points

UP = (0, 0, 1)
TUBE = CylinderSite((0, 0, 0), UP, 2)
RING = TorusSite((0, 0, 0), UP, 4, 1)
CONE = ConeSite((0, 0, 0), UP, "3/5", "4/5")
CASES = [
    (TUBE, SphereSite((5, 0, 0), 1), Kind.GENERAL, Kind.EMPTY),
    (TUBE, SphereSite((1, 0, 0), "1/2"), Kind.EMPTY, Kind.GENERAL),
    (TUBE, SphereSite((2, 0, 0), 1), Kind.GENERAL, Kind.GENERAL),
    (TUBE, SphereSite((3, 0, 0), 1), Kind.GENERAL, Kind.LINE),
    (TUBE, SphereSite((1, 0, 0), 1), Kind.LINE, Kind.GENERAL),
    (TUBE, CylinderSite((0, 4, 0), (1, 0, 0), 1), Kind.GENERAL, Kind.EMPTY),
    (TUBE, CylinderSite((0, 3, 0), (1, 0, 0), 1), Kind.GENERAL, Kind.LINE),
    (TUBE, CylinderSite((0, 1, 0), (1, 0, 0), 1), Kind.GENERAL, Kind.GENERAL),
    (RING, SphereSite((4, "1/4", 0), "1/4"), Kind.EMPTY, Kind.GENERAL),
    (RING, SphereSite((0, 1, 0), "3/2"), Kind.GENERAL, Kind.EMPTY),
    (RING, CylinderSite((0, 0, 3), (1, 0, 0), 1), Kind.GENERAL, Kind.EMPTY),
    (CONE, SphereSite((3, 0, -4), 1), Kind.GENERAL, Kind.EMPTY),
    (CONE, SphereSite((1, 0, 9), 1), Kind.EMPTY, Kind.GENERAL),
    (PlaneSite((0, 0, 3), (0, 3, 4)), RING, Kind.GENERAL, Kind.GENERAL),
    (PlaneSite((0, 0, 9), (0, 3, 4)), RING, Kind.EMPTY, Kind.GENERAL),
]


@pytest.mark.parametrize(("f", "g", "even", "odd"), CASES)
def test_what_there_is(f: CarrierSite, g: CarrierSite, even: Kind, odd: Kind) -> None:
    """Points found without algebra bear it out; the equation is told all the same."""
    for parity, kind in (("even", even), ("odd", odd)):
        found = surface(f, g, parity)
        assert found.kind is kind
        points = equidistant_points(found, seed=2, count=80)
        if kind is Kind.EMPTY:
            assert not len(points)
            assert found.degree == surface(f, g, parity, exists=True).degree
        elif kind is Kind.GENERAL:
            assert len(points)
        else:
            assert found.shape is not None
            assert found.shape.deviation(points).max(initial=0.0) <= 1e-5 * found.size
            assert found.contains(found.shape.origin)


@pytest.mark.parametrize("y", [0, -1, "1/3"])
def test_line_through_an_apex(y: str) -> None:
    """It meets the inside of the cone nowhere: the apex alone, wherever the line's own point is."""
    assert surface(CONE, CylinderSite((0, y, 0), (0, 1, 0), 0), "odd").kind is Kind.POINT
