"""Distance to the wall and thickness as fields, and the mid-surface, of a tapered wedge.

A wedge between two planes that meet at the angle 2 a in the line x = z = 0: at the place (x, z)
the nearer plane is x sin a - |z| cos a away; on the plane z = 0 the wall is 2 x sin a thick (the
diameter of the ball there), and its feet are seen at 180 degrees - 2 a.
"""

from __future__ import annotations

from math import cos, radians, sin

import numpy as np

import decomp

ANGLE = radians(5.0)
NEAR, FAR, WIDE = 4.0, 12.0, 6.0


def wedge() -> decomp.Solid:
    """From x = 4 to x = 12, from y = 0 to y = 6."""
    upper = decomp.HalfSpace((0, 0, 0), (-sin(ANGLE), 0, cos(ANGLE)), name="upper")
    lower = decomp.HalfSpace((0, 0, 0), (-sin(ANGLE), 0, -cos(ANGLE)), name="lower")
    return decomp.Block((NEAR, 0, -3), (FAR - NEAR, WIDE, 6), name="box") & upper & lower


def errors() -> tuple[float, float, float]:
    """Largest errors: distance at nodes, thickness and z of the mid-surface at its points."""
    geometry = decomp.Geometry(wedge())
    mesh = decomp.mesh(geometry, size=0.8, fields=["distance"])
    x, y, z = mesh.points.T
    slopes = x * sin(ANGLE) - np.abs(z) * cos(ANGLE)
    exact = np.min([slopes, x - NEAR, FAR - x, y, WIDE - y], axis=0)
    middle = decomp.mid_surface(decomp.skeleton(geometry), facing=120)
    thick = 2 * middle.points[:, 0] * sin(ANGLE)
    return (
        float(np.abs(mesh.point_data["distance"] - exact).max()),
        float(np.abs(middle.thickness - thick).max()),
        float(np.abs(middle.points[:, 2]).max()),
    )


if __name__ == "__main__":
    distance, thickness, middle = errors()
    print(f"off: distance {distance:.1e}, thickness {thickness:.1e}, mid-surface {middle:.1e}")
