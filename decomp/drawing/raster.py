"""Triangles painted with a depth buffer: pictures must come out on machines without a display."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from decomp.drawing.camera import Projection
from decomp.kernels.compiled import scalar
from decomp.tolerance import TINY
from decomp.vectors import Array, Bools, cross, norm

LIGHT = np.array([0.2, -0.6, 0.77])
EDGE, DARK = 0.8, 0.45
"""Half an edge's width in painted pixels; its brightness."""


@dataclass(frozen=True, eq=False)
class Triangles:
    """What is painted.

    Args:
        corners: (k, 3, 3).
        sides: (k, 3) whether a line is drawn along the side opposite to each corner.
        colours: (k, 3) red, green and blue from 0 to 1.
    """

    corners: Array
    sides: Bools
    colours: Array


def joined(parts: list[Triangles]) -> Triangles:
    """All triangles of several."""
    return Triangles(
        np.concatenate([np.empty((0, 3, 3)), *(part.corners for part in parts)]),
        np.concatenate([np.empty((0, 3), dtype=np.bool_), *(part.sides for part in parts)]),
        np.concatenate([np.empty((0, 3)), *(part.colours for part in parts)]),
    )


def painted(triangles: Triangles, projection: Projection, width: int, height: int) -> Array:
    """An image (height, width, 3) of triangles, lit from above, on white."""
    corners = triangles.corners
    normal = cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normal /= np.maximum(norm(normal), TINY)[:, None]
    bright = 0.55 + 0.45 * np.abs(normal @ (LIGHT / np.linalg.norm(LIGHT)))
    image = np.ones((height, width, 3))
    depth = np.full((height, width), -np.inf)
    colours = triangles.colours * bright[:, None]
    draw(projection(corners), colours, triangles.sides, image, depth)
    return image


@scalar
def draw(screen: Array, colours: Array, sides: Bools, image: Array, depth: Array) -> None:
    """Fill triangles (k, 3, 3) into the picture where nothing nearer is; their lines are darker."""
    height, width = depth.shape
    for k in range(len(screen)):
        ax, ay, az = screen[k, 0, 0], screen[k, 0, 1], screen[k, 0, 2]
        bx, by, bz = screen[k, 1, 0], screen[k, 1, 1], screen[k, 1, 2]
        cx, cy, cz = screen[k, 2, 0], screen[k, 2, 1], screen[k, 2, 2]
        area = (bx - ax) * (cy - ay) - (cx - ax) * (by - ay)
        if area == 0.0:
            continue
        # heights of the corners over the opposite sides, in pixels; without a line, out of reach
        far = 1e300
        ha = abs(area) / max(((bx - cx) ** 2 + (by - cy) ** 2) ** 0.5, TINY)
        hb = abs(area) / max(((ax - cx) ** 2 + (ay - cy) ** 2) ** 0.5, TINY)
        hc = abs(area) / max(((ax - bx) ** 2 + (ay - by) ** 2) ** 0.5, TINY)
        for row in range(max(0, int(min(ay, by, cy))), min(height, int(max(ay, by, cy)) + 1)):
            y = row + 0.5
            for column in range(max(0, int(min(ax, bx, cx))), min(width, int(max(ax, bx, cx)) + 1)):
                x = column + 0.5
                u = ((bx - x) * (cy - y) - (cx - x) * (by - y)) / area
                v = ((cx - x) * (ay - y) - (ax - x) * (cy - y)) / area
                w = 1.0 - u - v
                z = u * az + v * bz + w * cz
                if u < 0.0 or v < 0.0 or w < 0.0 or z <= depth[row, column]:
                    continue
                depth[row, column] = z
                near = u * ha if sides[k, 0] else far
                near = min(near, v * hb if sides[k, 1] else far)
                near = min(near, w * hc if sides[k, 2] else far)
                shade = DARK if near < EDGE else 1.0
                for channel in range(3):
                    image[row, column, channel] = colours[k, channel] * shade
