"""Boxes around faces and edges, to tell sites apart by distance; not always the smallest."""

from __future__ import annotations

from math import cos, sqrt

import numpy as np

from decomp.boundary.topology import Edge, Face, RegionBoundary
from decomp.curves.circle import Circle
from decomp.curves.line import Line
from decomp.kernels.compiled import inlined
from decomp.tolerance import ENLARGED
from decomp.vectors import Array


def bounds_of(boundary: RegionBoundary) -> Array:
    """Corners (2, 3) of a box around a boundary, its vertices included."""
    points = np.array([*boundary.bounds, *(v.point for v in boundary.vertices)])
    return np.array([points.min(axis=0), points.max(axis=0)])


def edge_box(edge: Edge) -> Array:
    """Box (6,) around an edge: its samples, widened by what lies between them."""
    samples = edge.samples
    if isinstance(edge.curve, Line):
        samples = edge.curve.point(np.array([edge.start, edge.end]))
        pad = 0.0
    elif isinstance(edge.curve, Circle):
        samples = edge.curve.point(np.linspace(edge.start, edge.end, 65))
        pad = edge.curve.radius * (1 - cos((edge.end - edge.start) / 128))
    else:
        # an arc that turns by less than 90 degrees stays within a quarter of its chord
        pad = 0.25 * float(np.linalg.norm(np.diff(samples, axis=0), axis=1).max(initial=0.0))
    return np.concatenate([samples.min(axis=0) - pad, samples.max(axis=0) + pad])


def face_box(boundary: RegionBoundary, face: Face, around: list[Array]) -> Array:
    """Box (6,) around a face, not always the smallest."""
    low, high = bounds_of(boundary)
    edges = [around[k] for loop in face.loops for k, _ in loop]
    own = boundary.carriers[face.carrier].box_around(np.array(edges).reshape(-1, 6))
    own_low, own_high = (low, high) if own is None else own
    slack = ENLARGED * boundary.diagonal
    return np.concatenate([np.maximum(low, own_low) - slack, np.minimum(high, own_high) + slack])


@inlined
def box_distance(boxes: Array, k: int, x: float, y: float, z: float) -> float:
    """Distance to a box, 0 inside."""
    dx = max(boxes[k, 0] - x, 0.0, x - boxes[k, 3])
    dy = max(boxes[k, 1] - y, 0.0, y - boxes[k, 4])
    dz = max(boxes[k, 2] - z, 0.0, z - boxes[k, 5])
    return sqrt(dx * dx + dy * dy + dz * dz)
