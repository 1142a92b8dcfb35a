"""Random points on the boundary of a region."""

from __future__ import annotations

import numpy as np

import decomp
from decomp.vectors import Array


def boundary_points(geometry: decomp.Geometry, count: int, seed: int = 0) -> tuple[Array, Array]:
    """Points (k, 3) inside the faces of the first region, with inward normals (k, 3)."""
    rng = np.random.default_rng(seed)
    region = geometry.regions[0]
    low, high = region.bounds
    points, normals = [], []
    for index, face in enumerate(region.faces):
        carrier = region.carriers[face.carrier]
        q = carrier.project(low + rng.random((count, 3)) * (high - low))
        q = q[geometry.boundaries.face_at(0, face.carrier, q) == index]
        points.append(q)
        normals.append(-face.outward * carrier.normal(q))
    return np.concatenate(points), np.concatenate(normals)
