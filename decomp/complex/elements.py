"""Carriers and edges as the surfaces and curves of a complex."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from decomp.carriers import Carrier
from decomp.carriers.compiled_carriers import carrier_table
from decomp.carriers.on_carriers import normals_at, projected
from decomp.curves.base import Curve
from decomp.vectors import Array, Bools, Ints


@dataclass(frozen=True, eq=False)
class CarrierSurface:
    """A carrier as a surface of a complex.

    Args:
        carrier: the surface.
        sign: +1 if normals are the carrier's outward normals, -1 if they are the opposite ones.
    """

    carrier: Carrier
    sign: int

    @property
    def family(self) -> type[CarrierFamily]:
        """All carriers are of one family."""
        return CarrierFamily

    @staticmethod
    def of_family(members: Sequence[CarrierSurface]) -> CarrierFamily:
        """The family that some of them make."""
        return CarrierFamily(members)

    def place(self, points: Array) -> Array:
        return self.carrier.project(points)

    def normal(self, points: Array) -> Array:
        return np.asarray(self.sign * self.carrier.normal(points))


class CarrierFamily:
    """Carriers that are asked for points of all of them at once."""

    def __init__(self, members: Sequence[CarrierSurface]) -> None:
        self._table = carrier_table([member.carrier for member in members])
        self._signs = np.array([member.sign for member in members])

    def place(self, which: Ints, points: Array) -> tuple[Array, Bools]:
        """Points (k, 3), each moved onto a given member (k,), which always succeeds."""
        return projected(self._table, which, points), np.ones(len(points), dtype=np.bool_)

    def normal(self, which: Ints, points: Array) -> tuple[Array, Bools]:
        """Unit normals (k, 3) at points (k, 3) on given members (k,), all of them good."""
        normals = normals_at(self._table, which, points)
        return self._signs[which, None] * normals, np.ones(len(points), dtype=np.bool_)


@dataclass(frozen=True, eq=False)
class EdgeCurve:
    """The curve of an edge as a curve of a complex.

    Args:
        curve: untrimmed.
    """

    curve: Curve

    def place(self, points: Array) -> Array:
        return self.curve.point(self.curve.parameter(points))
