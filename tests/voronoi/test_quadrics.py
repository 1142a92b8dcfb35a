"""Where a Voronoi surface is of degree 2 or less, its invariants tell the same kind as geometry."""

from __future__ import annotations

from itertools import combinations_with_replacement

import pytest
from hypothesis import given
from hypothesis import strategies as st

from decomp.voronoi import Kind
from tests.voronoi.instances import FEW, SITES, surfaces_of
from tests.voronoi.quadrics import quadric_kind

PAIRS = list(combinations_with_replacement(SITES, 2))


@pytest.mark.parametrize(("one", "two"), PAIRS)
@FEW
@given(st.data())
def test_kind_agrees_with_invariants(one: str, two: str, data: st.DataObject) -> None:
    f, g = data.draw(SITES[one]), data.draw(SITES[two])
    for found in surfaces_of(f, g):
        if found.polynomial is None:
            assert found.kind is Kind.EMPTY
        elif found.polynomial.degree <= 2 and found.kind.dimension == 2:
            assert found.kind is quadric_kind(found.polynomial)
        else:
            assert found.kind in (
                Kind.GENERAL,
                Kind.TORUS,
                Kind.REVOLVED_PARABOLA,
                Kind.REVOLVED_ELLIPSE,
                Kind.REVOLVED_HYPERBOLA,
                Kind.TWO_SURFACES,
                Kind.EMPTY,
                Kind.LINE,
                Kind.POINT,
            )
