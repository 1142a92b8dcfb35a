"""Where a picture is taken from: parallel projection onto a plane across the way to the eye."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from decomp.tolerance import TINY
from decomp.vectors import Array, cross

ASLANT = (0.45, -0.75, 0.48)
VIEWS = {
    "iso": ASLANT,
    "+x": (1.0, 0.0, 0.0),
    "-x": (-1.0, 0.0, 0.0),
    "+y": (0.0, 1.0, 0.0),
    "-y": (0.0, -1.0, 0.0),
    "+z": (0.0, 0.0, 1.0),
    "-z": (0.0, 0.0, -1.0),
}
"""Ways from the model to the eye, by name."""
FROM_ABOVE = 1e-6
"""The eye is right above or below if its share across z is less: then x points to the right."""


def axes(eye: Array) -> Array:
    """Unit vectors (3, 3) to the right, up, and towards the eye; z is up, or x to the right."""
    towards = eye / np.linalg.norm(eye)
    right = cross(np.array([0.0, 0.0, 1.0]), towards)
    length = float(np.linalg.norm(right))
    right = right / length if length > FROM_ABOVE else np.array([1.0, 0.0, 0.0])
    up = cross(towards, right)
    return np.stack([right, up / np.linalg.norm(up), towards])


@dataclass(frozen=True, eq=False)
class Projection:
    """From the model to pixels.

    Args:
        axes: (3, 3) as the function `axes` gives them.
        scale: pixels of a unit of length.
        shift: (2,) column and row of the model's origin.
    """

    axes: Array
    scale: float
    shift: Array

    def __call__(self, points: Array) -> Array:
        """Column, row, and depth towards the eye of points (..., 3)."""
        found = points @ self.axes.T * (self.scale, -self.scale, self.scale)
        found[..., :2] += self.shift
        return np.asarray(found)


def fitted(points: Array, eye: Array, low: Array, high: Array) -> Projection:
    """The projection in which points (n, 3) fill a rectangle.

    Args:
        points: of what is drawn.
        eye: (3,) the way to it.
        low: column and row (2,) of the rectangle's upper left corner.
        high: of its lower right corner.
    """
    frame = axes(eye)
    flat = points @ frame[:2].T
    least, most = flat.min(axis=0), flat.max(axis=0)
    scale = float(((high - low) / np.maximum(most - least, TINY)).min())
    middle = (least + most) / 2 * (scale, -scale)
    return Projection(frame, scale, (low + high) / 2 - middle)
