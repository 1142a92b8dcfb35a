"""Stereolithography files (.stl), binary; the format holds single precision only."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from decomp.errors import InputError
from decomp.skeletons.files.elements import Elements
from decomp.vectors import Array, Ints, cross, norm

COARSEST = 1e-4
"""Coordinates may be so much of what is written apart from each other."""
ROW = [("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")]


def encoded(
    parts: Elements,
    at_points: Mapping[str, Array] | None = None,
    at_triangles: Mapping[str, Array] | None = None,
) -> bytes:
    """Triangles alone.

    Args:
        parts: what the file holds.
        at_points, at_triangles: have no place here.

    Raises:
        InputError: as of `surface`.
    """
    return surface(parts.points, parts.triangles)


def surface(points: Array, triangles: Ints) -> bytes:
    """Points (n, 3) and triangles (m, 3).

    Raises:
        InputError: they are so far from the origin that single precision would spoil them.
    """
    _refuse_far(points)
    corners = points[triangles]
    normal = cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    length = norm(normal)[:, None]
    rows = np.zeros(len(triangles), dtype=ROW)
    rows["normal"] = normal / np.where(length > 0, length, 1.0)
    rows["corners"] = corners
    header = b"made by decomp".ljust(80) + np.array(len(rows), dtype="<u4").tobytes()
    return header + rows.tobytes()


def _refuse_far(points: Array) -> None:
    if not len(points):
        return
    away = np.abs(points).max()
    apart = float(np.spacing(np.float32(away)))
    if apart > COARSEST * float(norm(points.max(axis=0) - points.min(axis=0))):
        raise InputError(
            f".stl files hold single precision, in which coordinates of {away:.3g} are {apart:.2g} "
            "apart: that would spoil this surface; write .ply or .obj, or move the model nearer to "
            "the origin"
        )
