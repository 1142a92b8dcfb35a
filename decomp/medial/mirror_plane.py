"""A plane of symmetry as a surface of a complex."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from decomp.vectors import Array


@dataclass(frozen=True, eq=False)
class MirrorPlane:
    """The plane through `point` across unit `direction`."""

    point: Array
    direction: Array

    def place(self, points: Array) -> Array:
        """Points (k, 3) moved to the plane."""
        off = (points - self.point) @ self.direction
        return np.asarray(points - off[:, None] * self.direction)

    def normal(self, points: Array) -> Array:
        """The plane's unit normal, once for each point."""
        return np.broadcast_to(self.direction, points.shape).copy()
