"""Trim surfaces: the normals along an edge, from the edge to the skeleton.

Beside the surface the nearest site changes from a face to the edge, but the nearest point does not
jump, so it is no part of the skeleton. It parts face cells.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from decomp.skeleton.normal_curves import NormalCurve
from decomp.vectors import Array, Ints, cross, dot, norm


@dataclass(frozen=True, eq=False)
class RuledSurface:
    """The surface of a normal curve's normals.

    Its own normals point from the face's (or first site's) side to the edge's, see `sense`.

    Args:
        curve: of the normals.
        sense: +1 or -1: multiplies tangent x direction.
    """

    curve: NormalCurve
    sense: float

    def place(self, points: Array) -> Array:
        """Points (k, 3) moved to the normal through the foot of their parameter."""
        s = self.curve.parameter(points)
        feet, ways = self.curve.feet(s), self.curve.directions(s)
        return np.asarray(feet + dot(points - feet, ways)[:, None] * ways)

    def normal(self, points: Array) -> Array:
        """Unit normals (k, 3): across the ruling and the change along the curve."""
        s = self.curve.parameter(points)
        h = 1e-6 * (self.curve.end - self.curve.start)
        feet, ways = self.curve.feet(s), self.curve.directions(s)
        height = dot(points - feet, ways)
        low = s - h, self.curve.feet(s - h), self.curve.directions(s - h)
        high = s + h, self.curve.feet(s + h), self.curve.directions(s + h)
        along = (high[1] + height[:, None] * high[2]) - (low[1] + height[:, None] * low[2])
        # where the surface ends in a point the rulings fan out
        flat = norm(along) <= 1e-12 * (1 + np.abs(height))
        along[flat] = (high[2] - low[2])[flat]
        across = self.sense * cross(along, ways)
        length = norm(across)
        return np.asarray(across / np.where(length > 0, length, 1.0)[:, None])


def strip(lower: Ints, lower_s: Array, upper: Ints, upper_s: Array) -> Ints:
    """Triangles (m, 3) between two polylines of vertices over one parameter.

    Args:
        lower, upper: vertices from the least to the greatest parameter.
        lower_s, upper_s: their parameters, ascending.
    """
    i = j = 0
    triangles = []
    while i + 1 < len(lower) or j + 1 < len(upper):
        go_lower = j + 1 >= len(upper) or (i + 1 < len(lower) and lower_s[i + 1] <= upper_s[j + 1])
        if go_lower:
            triangles.append((lower[i], lower[i + 1], upper[j]))
            i += 1
        else:
            triangles.append((lower[i], upper[j + 1], upper[j]))
            j += 1
    found = np.array(triangles, dtype=np.int64).reshape(-1, 3)
    a, b, c = found.T
    return np.asarray(found[(a != b) & (b != c) & (c != a)])
