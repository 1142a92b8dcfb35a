"""What an equation's zeros are: true points, or points with equidistant stationary feet."""

from __future__ import annotations

from itertools import combinations_with_replacement

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from decomp.vectors import Array, norm
from decomp.voronoi import CarrierSite, Polynomial
from decomp.voronoi.stationary import stationary_feet
from tests.voronoi.instances import FEW, SITES, surfaces_of

PAIRS = list(combinations_with_replacement(SITES, 2))


def zeros(polynomial: Polynomial, middle: Array, size: float, count: int = 10) -> Array:
    """Zeros (k, 3) on random lines: bracketed, then bisected to rounding."""
    rng = np.random.default_rng(7)
    start = middle + rng.uniform(-1, 1, size=(count, 3)) * size
    way = rng.normal(size=(count, 3))
    way /= norm(way)[:, None]
    t = np.linspace(-3, 3, 241) * size
    values = polynomial(start[:, None] + t[:, None] * way[:, None])
    rows, at = np.nonzero(values[:, 1:] * values[:, :-1] < 0)
    low, high = t[at], t[at + 1]
    sign = np.sign(values[rows, at])
    for _ in range(60):
        mid = (low + high) / 2
        left = np.sign(polynomial(start[rows] + mid[:, None] * way[rows])) == sign
        low, high = np.where(left, mid, low), np.where(left, high, mid)
    return np.asarray(start[rows] + low[:, None] * way[rows])


def closest_stationary(f: CarrierSite, g: CarrierSite, p: Array) -> float:
    """Least difference between distances from p to points where normals through p meet f and g."""
    u = norm(stationary_feet(f, p) - p)
    v = norm(stationary_feet(g, p) - p)
    return float(np.abs(u[:, None] - v[None]).min())


@pytest.mark.parametrize(("one", "two"), PAIRS)
@FEW
@given(st.data())
def test_zeros_are_true_or_stationary(one: str, two: str, data: st.DataObject) -> None:
    """The trimmed part is equidistant to 1e-9; elsewhere feet are stationary but not nearest."""
    f, g = data.draw(SITES[one]), data.draw(SITES[two])
    for found in surfaces_of(f, g):
        if found.polynomial is None or found.kind.dimension < 2:
            continue
        middle = np.array([[float(c) for c in s.reference] for s in (f, g)]).mean(axis=0)
        p = zeros(found.polynomial, middle, found.size)
        slope = norm(found.polynomial.gradient(p)) if len(p) else np.zeros(0)
        p = p[slope > 1e-5 * slope.max(initial=0.0)]
        true = found.contains(p)
        gap = np.abs(found.difference(p[true]))
        assert gap.max(initial=0.0) <= 1e-9 * found.size
        for q in p:
            assert closest_stationary(f, g, q) <= 1e-8 * found.size
