"""Records: what kernels get by their address."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest

from decomp.kernels.compiled import scalar
from decomp.kernels.records import Record
from decomp.vectors import Array


@dataclass(frozen=True)
class Row(Record):
    """Three numbers and a factor."""

    values: Array
    factor: float


@scalar
def scaled_sum(row: Row) -> float:
    """The factor times the sum of the values."""
    total = 0.0
    for value in row.values:
        total += value
    return row.factor * total


def test_a_kernel_reads_a_record() -> None:
    assert scaled_sum(Row(np.array([1.0, 2.0, 4.0]), 2.0)) == 14.0


class Interrupted(Row):
    """One whose address is asked for as a signal comes."""

    @property
    def address(self) -> int:  # type: ignore[override]
        raise KeyboardInterrupt


def test_an_error_while_the_address_is_asked_for_comes_through() -> None:
    """There was a crash: signals raise errors wherever Python code runs."""
    with pytest.raises(KeyboardInterrupt):
        scaled_sum(Interrupted(np.array([1.0, 2.0, 4.0]), 2.0))
