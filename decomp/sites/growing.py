"""Small helpers for kernels that fill arrays of unknown length."""

from __future__ import annotations

from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from decomp.kernels.compiled import inner_kernel, kernel
from decomp.vectors import Ints

T = TypeVar("T", bound=np.generic)


@kernel
def counted(start: int, count: int) -> Ints:
    """Consecutive integers."""
    numbers = np.empty(count, dtype=np.int64)
    for i in range(count):
        numbers[i] = start + i
    return numbers


@inner_kernel
def grown(array: NDArray[T], size: int) -> NDArray[T]:
    """The array itself, or a longer copy where it is shorter than `size`."""
    if size <= len(array):
        return array
    longer = np.empty(2 * size, dtype=array.dtype)
    for i in range(len(array)):
        longer[i] = array[i]
    return longer
