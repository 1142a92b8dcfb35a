"""Membership of one region, seen from a carrier: the on-boundary test (design: section 3.1)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from decomp.csg.halfspaces import HalfSpaceForm
from decomp.vectors import Array, Bools


@dataclass(frozen=True, eq=False)
class Member:
    """One region of a half-space form, or with `region` None the union of all its regions."""

    form: HalfSpaceForm
    region: int | None

    @property
    def name(self) -> str:
        """How messages call the region."""
        return self.form.names[self.region] if self.region is not None else "model"

    def holds(self, inside: Bools) -> Bools:
        """Whether points with given insides (..., n_carriers) belong to the region."""
        return self.selected(self.form.program.evaluate(inside))

    def selected(self, filled: Bools) -> Bools:
        """From what fills places (..., n_regions), whether this region does (...)."""
        return np.asarray(filled.any(axis=-1) if self.region is None else filled[..., self.region])

    def sides_at(self, carrier: int, points: Array) -> tuple[Bools, Bools]:
        """Whether the region holds the inner and the outer side of a carrier at points on it."""
        inside = self.form.signed_distances(points) < 0
        inside[..., carrier] = True
        inner = self.holds(inside)
        inside[..., carrier] = False
        return inner, self.holds(inside)

    def is_face(self, carrier: int, outward: int, points: Array) -> Bools:
        """Whether points on a carrier lie on a face whose outward normal is `outward` its own."""
        inner, outer = self.sides_at(carrier, points)
        return inner & ~outer if outward > 0 else outer & ~inner
