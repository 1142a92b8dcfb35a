"""Contacts of points in rows, as compiled kernels read them and bring them up to date."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from decomp.kernels.records import Record
from decomp.vectors import Array, Ints


@dataclass(frozen=True, eq=False)
class ContactRows(Record):
    """Contacts of k points, m for each, one point's after the other's.

    Args:
        which: supports (k * m,).
        feet: (k * m, 3), on them or close to them.
        work: scratch (m + 3, 7).
        count: m.
        size: of the region.
    """

    which: Ints
    feet: Array
    work: Array
    count: int
    size: float


def contact_rows(which: Ints, feet: Array, size: float) -> ContactRows:
    """Rows of contacts.

    Args:
        which: supports (k, m).
        feet: (k, m, 3), C-contiguous; changed in place.
        size: of the region.
    """
    count = which.shape[1]
    rows = np.array(which, dtype=np.int64).reshape(-1)
    return ContactRows(rows, feet.reshape(-1, 3), np.empty((count + 3, 7)), count, size)
