"""A plane of symmetry as a surface of a complex."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from decomp.vectors import Array, frame


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

    def coordinates(self, points: Array) -> Array:
        """Plane coordinates (k, 2) of points (k, 3) on it."""
        return np.asarray((points - self.point) @ np.stack(frame(self.direction), axis=1))

    def mirrored(self, points: Array) -> Array:
        """The mirror images of points (k, 3)."""
        off = (points - self.point) @ self.direction
        return np.asarray(points - 2 * off[:, None] * self.direction)
