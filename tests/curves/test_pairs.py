"""Every pair of the five carriers, at random: exact, complete, each part once."""

from __future__ import annotations

from itertools import combinations, combinations_with_replacement

import numpy as np
import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

from decomp.carriers import Carrier
from decomp.curves import TracedCurve, may_meet, meeting_pairs
from decomp.errors import ContactError
from tests.curves.cases import (
    KINDS,
    ORIGIN,
    TOLERANCE,
    WINDOW,
    carriers,
    complete,
    meet,
)

PAIRS = list(combinations_with_replacement(KINDS, 2))


def distinct(a: Carrier, b: Carrier) -> bool:
    return not a.coincides(b, 1e-6, WINDOW)


@pytest.mark.parametrize("pair", PAIRS, ids="-".join)
@settings(
    max_examples=15,
    deadline=None,
    derandomize=True,
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.filter_too_much],
)
@given(data=st.data())
def test_curves_are_exact_and_complete(pair: tuple[str, str], data: st.DataObject) -> None:
    a, b = data.draw(carriers(pair[0])), data.draw(carriers(pair[1]))
    assume(distinct(a, b))
    try:
        found = meet(a, b, WINDOW)
    except ContactError:
        assume(False)
    complete(found, a, b)
    if found.curves:
        assert may_meet(a, b, TOLERANCE)
        assert meeting_pairs([a, b], ORIGIN, WINDOW, TOLERANCE) == [(0, 1)]
    # no two curves share a part
    for one, two in combinations(found.curves, 2):
        t = np.linspace(*one.curve.domain, 33)[1:-1]
        p = one.curve.point(t)
        gap = np.linalg.norm(two.curve.point(two.curve.parameter(p)) - p, axis=-1)
        assert np.median(gap) > 1e-7


@pytest.mark.parametrize("pair", PAIRS, ids="-".join)
@settings(max_examples=5, deadline=None, derandomize=True)
@given(data=st.data())
def test_derivative_agrees_with_differences(pair: tuple[str, str], data: st.DataObject) -> None:
    a, b = data.draw(carriers(pair[0])), data.draw(carriers(pair[1]))
    assume(distinct(a, b))
    try:
        found = meet(a, b, WINDOW)
    except ContactError:
        assume(False)
    for one in found.curves:
        curve = one.curve
        knots = curve.knots if isinstance(curve, TracedCurve) else np.linspace(*curve.domain, 33)
        inner = slice(2, -2) if len(knots) > 8 else slice(None)
        t, h = ((knots[1:] + knots[:-1]) / 2)[inner], 1e-3 * np.diff(knots)[inner]
        steps = (-2, -1, 1, 2)
        p = [curve.point(t + k * h) for k in steps]
        slope = (p[0] - 8 * p[1] + 8 * p[2] - p[3]) / (12 * h)[:, None]
        exact = curve.derivative(t)
        size = np.linalg.norm(exact, axis=-1).max()
        noise = 1e-14 / h.min()
        assert np.abs(slope - exact).max() <= 1e-8 * size + noise
