"""Equidistant points found without algebra lie on the equations, for every pair of sites."""

from __future__ import annotations

from itertools import combinations_with_replacement

import pytest
from hypothesis import given
from hypothesis import strategies as st

from decomp.voronoi import Kind
from tests.voronoi.independent import equidistant_points, off_polynomial
from tests.voronoi.instances import FEW, SITES, surfaces_of

PAIRS = list(combinations_with_replacement(SITES, 2))


@pytest.mark.parametrize(("one", "two"), PAIRS)
@FEW
@given(st.data())
def test_equidistant_points_lie_on_the_surface(one: str, two: str, data: st.DataObject) -> None:
    f, g = data.draw(SITES[one]), data.draw(SITES[two])
    for found in surfaces_of(f, g):
        points = equidistant_points(found, seed=1, count=60)
        if found.kind is Kind.EMPTY:
            assert not len(points)
        if not len(points):
            continue
        if found.kind.dimension < 2:
            assert found.shape is not None
            # the distances touch there, so that points are off by the root of rounding
            assert found.shape.deviation(points).max() <= 1e-5 * found.size
            continue
        assert off_polynomial(found, points).max() <= 1e-9
        assert found.contains(points).all()
        if found.shape is not None:
            assert found.shape.deviation(points).max() <= 1e-9 * found.size
