"""Point membership by carriers, without the half-space form that it checks."""

from __future__ import annotations

import numpy as np

from benchmarks.membership import held
from decomp.csg.primitives import Primitive
from decomp.csg.solid import Solid
from decomp.vectors import Array, Bools


def contains(solid: Solid, points: Array) -> Bools:
    """Whether points (n, 3) are in the solid."""
    return held(solid, points, _by_carriers)


def _by_carriers(primitive: Primitive, points: Array) -> Bools:
    inside = np.ones(len(points), dtype=np.bool_)
    for _, carrier in primitive.half_spaces():
        inside &= carrier.signed_distance(points) < 0
    return inside
