"""The kinds of carriers there are, by their codes."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from decomp.carriers.base import Carrier
from decomp.carriers.cone import Cone
from decomp.carriers.cylinder import Cylinder
from decomp.carriers.elliptic_cylinder import EllipticCylinder
from decomp.carriers.plane import Plane
from decomp.carriers.sphere import Sphere
from decomp.carriers.torus import Torus
from decomp.vectors import Ints

KINDS: dict[int, type[Carrier]] = {
    kind.code: kind for kind in (Plane, Sphere, Cylinder, Cone, Torus, EllipticCylinder)
}


def codes_of(carriers: Sequence[Carrier]) -> Ints:
    """The carriers' codes (n,), by which tables and kernels tell kinds apart.

    Raises:
        TypeError: a carrier is of a kind that they do not know.
    """
    for carrier in carriers:
        if KINDS.get(carrier.code) is not type(carrier):
            known = ", ".join(kind.kind for kind in KINDS.values())
            raise TypeError(f"{type(carrier).__name__} is no known kind of carrier, only {known}")
    return np.array([carrier.code for carrier in carriers], dtype=np.int64)
