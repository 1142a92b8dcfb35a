"""Zero minima of functions that are never negative."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from decomp.skeletons.seams.minima import least_values
from decomp.vectors import Array, Ints

PLACES = st.lists(st.floats(0.05, 1.95), min_size=1, max_size=8)


@pytest.mark.parametrize("power", [0.5, 1.0, 2.0, 4.0])
@given(PLACES)
def test_zeros_are_found_in_all_intervals_together(power: float, places: list[float]) -> None:
    zeros = np.array(places)
    low, high = np.zeros(len(zeros)), np.full(len(zeros), 2.0)
    at, value = least_values(
        lambda row, x: np.abs(x - zeros[row]) ** power * (1 + x), low, high, 1e-10
    )
    assert np.abs(at - zeros).max() <= 1e-9
    assert value.max() <= 3 * 1e-9**power


@given(PLACES, st.floats(1e-3, 1.0))
def test_minima_that_are_not_zero_are_given_up_soon(places: list[float], level: float) -> None:
    lowest, asked = np.array(places), []

    def function(row: Ints, x: Array) -> Array:
        asked.append(len(x))
        return np.asarray(level + (x - lowest[row]) ** 2)

    _, value = least_values(function, np.zeros(len(lowest)), np.full(len(lowest), 2.0), 1e-10)
    assert (value >= level).all()
    assert len(asked) <= 4
