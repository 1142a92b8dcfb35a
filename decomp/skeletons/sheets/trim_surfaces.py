"""Trim surfaces: the normals along an edge, from the edge to the skeleton.

Beside the surface the nearest site changes from a face to the edge, but the nearest point does not
jump, so it is no part of the skeleton. It parts face cells.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np
from scipy.spatial import cKDTree  # type: ignore[import-untyped]

from decomp.complex.plane.planar import triangulate
from decomp.skeletons.curves.normal_curves import NormalCurve
from decomp.vectors import Array, Ints, cross, dot, norm

RUNGS = (0.0, 0.3, 0.6, 0.8, 0.9, 0.95, 0.98, 0.99, 0.995)
"""Parts of the normals' lengths at which points are known."""
CLOSE = 16
"""So many known points are looked at."""
FLAT = 1e-9
"""A triangle whose area is less than this part of its terms is flat."""


@dataclass(frozen=True, eq=False)
class RuledSurface:
    """The surface of a normal curve's normals, from the boundary up to the trim.

    Far from the boundary normals meet, so a point alone does not tell which one it is on; known
    points close by do.

    Args:
        curve: of the normals.
        sense: +1 or -1: multiplies tangent x direction to a normal.
        s, height: parameters (k,) and lengths of normals up to the trim.
    """

    curve: NormalCurve
    sense: float
    s: Array
    height: Array
    _tree: cKDTree = field(init=False)
    _feet: Array = field(init=False)
    _ways: Array = field(init=False)

    def __post_init__(self) -> None:
        feet, ways = self.curve.feet(self.s), self.curve.directions(self.s)
        known = [feet + (rung * self.height)[:, None] * ways for rung in RUNGS]
        object.__setattr__(self, "_tree", cKDTree(np.concatenate(known)))
        object.__setattr__(self, "_feet", feet)
        object.__setattr__(self, "_ways", ways)

    def place(self, points: Array) -> Array:
        """Points (k, 3) moved to the normal through their foot."""
        feet, ways, _ = self.curve.rulings(points, self._near(points))
        return np.asarray(feet + dot(points - feet, ways)[:, None] * ways)

    def normal(self, points: Array) -> Array:
        """Unit normals (k, 3): across the ruling and the change along the curve."""
        feet, ways, change = self.curve.rulings(points, self._near(points))
        along = change(dot(points - feet, ways))
        across = self.sense * cross(along, ways)
        length = norm(across)
        return np.asarray(across / np.where(length > 0, length, 1.0)[:, None])

    def _near(self, points: Array) -> Array:
        """Parameters (k,) of the normals closest to points, of those through known points close by.

        Close to where normals of several parts of the edge meet, the closest known point may be
        on a normal of another part.
        """
        rows = self._tree.query(points, k=min(CLOSE, self._tree.n))[1] % len(self.s)
        away = points[:, None] - self._feet[rows]
        up = np.clip(dot(away, self._ways[rows]), 0.0, self.height[rows])
        off = norm(away - up[..., None] * self._ways[rows])
        return np.asarray(self.s[rows[np.arange(len(points)), np.argmin(off, axis=1)]])


def strip(lower: Ints, lower_s: Array, upper: Ints, upper_s: Array, height: Array) -> Ints:
    """Triangles (m, 3) between two polylines of vertices over one parameter.

    Args:
        lower, upper: vertices from the least to the greatest parameter.
        lower_s, upper_s: their parameters, ascending.
        height: of the upper vertices above the lower border, in units of the parameter.
    """
    i = j = 0
    triangles = []
    while i + 1 < len(lower) or j + 1 < len(upper):
        go_lower = j + 1 >= len(upper) or (i + 1 < len(lower) and lower_s[i + 1] <= upper_s[j + 1])
        if go_lower:
            triangles.append((lower[i], lower[i + 1], upper[j]))
            i += 1
        elif len(lower) > 1 and _leaves(lower_s[i], upper_s[j : j + 2], height[j : j + 2]):
            return _delaunay(lower, lower_s, upper, upper_s, height)
        else:
            triangles.append((lower[i], upper[j + 1], upper[j]))
            j += 1
    return _proper(np.array(triangles, dtype=np.int64).reshape(-1, 3))


def _leaves(below: float, above: Array, height: Array) -> bool:
    """Whether the triangle of a lower vertex and two upper ones lies above the upper border."""
    one, two = (above[0] - below) * height[1], (above[1] - below) * height[0]
    return bool(one - two > FLAT * (abs(one) + abs(two)))


def _delaunay(lower: Ints, lower_s: Array, upper: Ints, upper_s: Array, height: Array) -> Ints:
    """The same where the upper border has hollows: triangulated in parameter and height."""
    vertices, place = list(lower), [(s, 0.0) for s in lower_s]
    ends = {0: 0, len(upper) - 1: len(lower) - 1}
    border = list(range(len(lower)))
    above = []
    for j, vertex in enumerate(upper):
        if j in ends and vertex == lower[ends[j]]:
            above.append(ends[j])
            continue
        above.append(len(vertices))
        vertices.append(vertex)
        place.append((upper_s[j], height[j]))
    loop = [*border, *above[::-1], border[0]]
    segments = np.array([side for side in pairwise(loop) if side[0] != side[1]])
    found = triangulate(np.array(place), segments)
    return _proper(np.array(vertices)[found.triangles[found.component >= 0]])


def _proper(triangles: Ints) -> Ints:
    """Those with three different vertices."""
    a, b, c = triangles.T
    return np.asarray(triangles[(a != b) & (b != c) & (c != a)])
