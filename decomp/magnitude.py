"""How large and how small the numbers of a model may be.

Carriers and Voronoi surfaces are polynomials of degree up to six or so in coordinates and lengths;
within these limits their values stay far from where double precision ends (1e308, 1e-308).
"""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

from decomp.errors import InputError

LARGEST: Final = 1e50
"""Coordinates and lengths are at most this."""
SMALLEST: Final = 1e-50
"""Lengths above zero are at least this."""
RESOLUTION: Final = 1e-15
"""Of coordinates; a radius below this part of them is no radius."""
FARTHEST: Final = 1e13
"""So many diagonals a model may be away from the origin: its coordinates have 16 digits."""


def check_magnitude(values: float | NDArray[np.float64], what: str) -> None:
    """Refuse numbers that computing would take out of double precision, and what is no number.

    Raises:
        InputError: a value is infinite, not a number, or too large; the message names `what`.
    """
    array = np.ravel(values)
    wrong = array[~(np.abs(array) <= LARGEST)]
    if not len(wrong):
        return
    if not np.isfinite(wrong).all():
        raise InputError(f"{what} must be finite, got {_shown(array)}")
    raise InputError(
        f"{what} is too large to compute with, got {_shown(array)}: coordinates and lengths may be "
        f"up to {LARGEST:g}; choose another unit"
    )


def check_length(value: float, what: str) -> None:
    """Refuse a length above zero that is too small, as `check_magnitude` does what is too large.

    Raises:
        InputError: it is out of range.
    """
    check_magnitude(value, what)
    if value < SMALLEST:
        raise InputError(
            f"{what} is too small to compute with, got {value:g}: lengths must be at least "
            f"{SMALLEST:g}; choose another unit"
        )


def _shown(values: NDArray[np.float64]) -> str:
    if len(values) == 1:
        return f"{values[0]:g}"
    if len(values) == 3:
        return "(" + ", ".join(f"{x:g}" for x in values) + ")"
    return f"{values[~(np.abs(values) <= LARGEST)][0]:g} among its numbers"
