"""Many carriers packed by kind, for signed distances to all of them at once."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from decomp.carriers.base import ROW, Carrier
from decomp.carriers.kinds import KINDS, codes_of
from decomp.vectors import Array, Ints


class CarrierTable:
    """Carriers as rows of numbers (see `Carrier.packed`).

    Raises:
        TypeError: a carrier is of an unknown kind.
    """

    def __init__(self, carriers: Sequence[Carrier]) -> None:
        self.carriers = tuple(carriers)
        self.kinds: Ints = codes_of(carriers)
        rows = [c.packed() for c in carriers]
        self.rows: Array = np.array(rows, dtype=np.float64).reshape(len(rows), ROW)

    def __len__(self) -> int:
        return len(self.carriers)

    def distances(self, p: Array, among: Ints | None = None) -> Array:
        """Signed distances (m, n) of points p (n, 3) to the m carriers `among` (default all)."""
        index = np.arange(len(self)) if among is None else among
        result = np.empty((len(index), len(p)))
        kinds = self.kinds[index]
        for code in np.unique(kinds).tolist():
            rows = np.flatnonzero(kinds == code)
            result[rows] = KINDS[code].distances_of(self.rows[index[rows]], p)
        return result
