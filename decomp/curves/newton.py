"""Newton's method onto the intersection of two carriers, for many points at once."""

from __future__ import annotations

import numpy as np

from decomp.carriers import Carrier
from decomp.vectors import Array, cross, norm

NEWTON_LAST_STEP = 1e-14
"""Steps smaller than this part of the greatest coordinate are the last."""


def onto_pair(a: Carrier, b: Carrier, p: Array, along: Array, steps: int = 6) -> Array:
    """Bring points p (..., 3) onto both carriers, moving only across the unit vectors `along`.

    In the plane across `along` the two linear equations n_a.x = -a, n_b.x = -b are solved, step
    by step; where the normals are parallel there, the least-norm solution is taken.
    """
    # compiled code takes a second to load, which whoever asks for plain solids need not wait for
    from decomp.curves.stepping import move_onto_pair, table_of

    moved = np.array(p, dtype=np.float64).reshape(-1, 3)
    ways = np.ascontiguousarray(np.broadcast_to(along, np.shape(p)), dtype=np.float64)
    small = NEWTON_LAST_STEP * float(np.max(np.abs(moved), initial=0.0))
    move_onto_pair(table_of(a, b), moved, ways.reshape(-1, 3), steps, small)
    return moved.reshape(np.shape(p))


def cross_direction(a: Carrier, b: Carrier, p: Array) -> tuple[Array, Array]:
    """Unit vectors along n_a x n_b and the lengths of these products (0 where parallel)."""
    product = cross(a.normal(p), b.normal(p))
    size = norm(product)
    return product / np.where(size > 0, size, 1.0)[..., None], size
