"""Many carriers packed by kind, for signed distances to all of them at once."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from decomp.carriers.base import Carrier
from decomp.carriers.cone import Cone
from decomp.carriers.cylinder import Cylinder
from decomp.carriers.plane import Plane
from decomp.carriers.sphere import Sphere
from decomp.carriers.torus import Torus
from decomp.vectors import Array, Ints, dot, norm


class CarrierTable:
    """Carriers as rows of numbers (see `Carrier.packed`), grouped by kind."""

    def __init__(self, carriers: Sequence[Carrier]) -> None:
        self.carriers = tuple(carriers)
        self.kinds: Ints = np.array([c.code for c in carriers], dtype=np.int64)
        rows = [c.packed() for c in carriers]
        self.rows: Array = np.array(rows, dtype=np.float64).reshape(len(rows), 8)
        self.groups = [
            (code, np.nonzero(self.kinds == code)[0])
            for code in (Plane.code, Sphere.code, Cylinder.code, Cone.code, Torus.code)
        ]

    def __len__(self) -> int:
        return len(self.carriers)

    def distances(self, p: Array, among: Ints | None = None) -> Array:
        """Signed distances (m, n) of points p (n, 3) to the m carriers `among` (default all)."""
        index = np.arange(len(self)) if among is None else among
        result = np.empty((len(index), len(p)))
        for code, _ in self.groups:
            rows = np.nonzero(self.kinds[index] == code)[0]
            if len(rows):
                result[rows] = _distances(code, self.rows[index[rows]], p)
        return result


def _distances(code: int, rows: Array, p: Array) -> Array:
    """The carriers' own formulas, for all pairs of rows and points."""
    away = p[None, :, :] - rows[:, None, :3]
    first, second = rows[:, None, 6], rows[:, None, 7]
    if code == Sphere.code:
        return np.asarray(norm(away) - first)
    axis = rows[:, None, 3:6]
    z = dot(away, axis)
    if code == Plane.code:
        return z
    rho = norm(away - z[..., None] * axis)
    if code == Cylinder.code:
        return np.asarray(rho - first)
    if code == Cone.code:
        along = rho * first + z * second
        return np.where(along > 0, rho * second - z * first, np.hypot(rho, z))
    return np.asarray(np.hypot(rho - first, z) - second)
