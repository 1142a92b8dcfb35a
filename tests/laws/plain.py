"""Samples of boundaries, from the primitives' own numbers alone.

Nothing here uses carriers, programs or trees of boxes, whose results it judges.
"""

from __future__ import annotations

import numpy as np

from benchmarks.membership import held
from decomp.csg.primitives import Block, Cone, Cylinder, Sphere, Torus
from decomp.csg.solid import Difference, Intersection, Solid, Transformed, Union
from decomp.vectors import Array


def leaves(solid: Solid) -> list[Solid]:
    """The primitives of a solid, each moved to its place."""
    match solid:
        case Union(parts=parts) | Intersection(parts=parts):
            return [leaf for part in parts for leaf in leaves(part)]
        case Difference(base=base, tool=tool):
            return leaves(base) + leaves(tool)
        case Transformed(part=part, by=by):
            return [Transformed(leaf, by) for leaf in leaves(part)]
    return [solid]


def boundary_samples(solid: Solid, count: int, rng: np.random.Generator, step: float) -> Array:
    """Points of a solid's boundary: of its primitives' surfaces, where a step across matters."""
    found = []
    for leaf in leaves(solid):
        points, normals = _surface(leaf, count, rng)
        inner, outer = held(solid, points - step * normals), held(solid, points + step * normals)
        found.append(points[inner != outer])
    return np.concatenate(found)


def _surface(solid: Solid, count: int, rng: np.random.Generator) -> tuple[Array, Array]:
    """Random points (about `count`) of a primitive's surface, with normals."""
    u, turn = rng.uniform(size=count), 2 * np.pi * rng.uniform(size=count)
    match solid:
        case Transformed(part=part, by=by):
            points, normals = _surface(part, count, rng)
            return by.scale * points @ by.rotation.T + by.offset, normals @ by.rotation.T
        case Block(corner=corner, size=size):
            points = corner + rng.uniform(size=(count, 3)) * size
            normals = np.zeros((count, 3))
            area = np.array([size[1] * size[2], size[0] * size[2], size[0] * size[1]])
            axis = rng.choice(3, size=count, p=area / area.sum())
            side, row = rng.integers(0, 2, count), np.arange(count)
            points[row, axis] = (corner + side[:, None] * size)[row, axis]
            normals[row, axis] = 2 * side - 1
            return points, normals
        case Sphere(centre=centre, radius=radius):
            normals = rng.normal(size=(count, 3))
            normals /= np.linalg.norm(normals, axis=1)[:, None]
            return centre + radius * normals, normals
        case Torus(centre=centre, axis=axis, major=major, minor=minor):
            out, _ = _ring(axis, turn)
            tube = 2 * np.pi * u
            kept = rng.uniform(size=count) * (major + minor) < major + minor * np.cos(tube)
            normals = np.cos(tube)[:, None] * out + np.sin(tube)[:, None] * axis
            return (centre + major * out + minor * normals)[kept], normals[kept]
        case Cylinder(base=base, top=top, radius=radius):
            return _frustum(base, top, radius, radius, u, turn)
        case Cone():
            radii = solid.base_radius, solid.top_radius
            return _frustum(solid.base, solid.top, *radii, u, turn)
    raise AssertionError(solid)


def _ring(axis: Array, turn: Array) -> tuple[Array, Array]:
    x = np.cross(axis, np.eye(3)[int(np.argmin(np.abs(axis)))])
    x /= np.linalg.norm(x)
    y = np.cross(axis, x)
    return np.cos(turn)[:, None] * x + np.sin(turn)[:, None] * y, y


def _frustum(
    base: Array, top: Array, low: float, high: float, u: Array, turn: Array
) -> tuple[Array, Array]:
    """Points of the side and of both ends, of each its share."""
    length = float(np.linalg.norm(top - base))
    axis = (top - base) / length
    out, _ = _ring(axis, turn)
    slant = np.hypot(length, high - low)
    shares = np.array([(low + high) * slant, low**2, high**2])
    ends = np.cumsum(shares) / shares.sum()
    side, first = u < ends[0], (u >= ends[0]) & (u < ends[1])
    within = np.where(side, u / ends[0], 0.0)
    # the radius grows linearly, so that its square is even over the side's area
    span = high**2 - low**2
    rising = np.sqrt(low**2 + within * span) - low
    part = rising / (high - low) if abs(span) > 1e-12 else within
    part = np.where(side, part, np.where(first, 0.0, 1.0))
    room = np.where(first, (u - ends[0]) / max(ends[1] - ends[0], 1e-300), 0.0)
    room = np.where(side | first, room, (u - ends[1]) / max(1 - ends[1], 1e-300))
    rho = np.where(side, low + part * (high - low), np.sqrt(room) * np.where(first, low, high))
    points = base + part[:, None] * (top - base) + rho[:, None] * out
    outward = (length * out + (low - high) * axis) / slant
    caps = np.where(first, -1.0, 1.0)[:, None] * axis
    return points, np.where(side[:, None], outward, caps)
