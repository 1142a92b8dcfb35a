"""Stereolithography files (.stl), binary; the format holds single precision only."""

from __future__ import annotations

import numpy as np

from decomp.vectors import Array, Ints, cross, norm

ROW = [("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")]


def surface(points: Array, triangles: Ints) -> bytes:
    """Points (n, 3) and triangles (m, 3)."""
    corners = points[triangles]
    normal = cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    length = norm(normal)[:, None]
    rows = np.zeros(len(triangles), dtype=ROW)
    rows["normal"] = normal / np.where(length > 0, length, 1.0)
    rows["corners"] = corners
    header = b"made by decomp".ljust(80) + np.array(len(rows), dtype="<u4").tobytes()
    return header + rows.tobytes()
