"""The size field as meshers take it: lengths at the nodes of a background mesh.

The background is the Delaunay mesh of the corners of an octree's cells, which are about as wide as
the lengths wanted in them: fine where these are short, and coarse in what is empty.
"""

from __future__ import annotations

import numpy as np
from scipy.spatial import Delaunay  # type: ignore[import-untyped]

from decomp.geometry import Geometry
from decomp.meshing.sizing.size_field import SizeField
from decomp.meshing.sizing.wishes import SLOPE, Lengths, Wishes
from decomp.vectors import Array, Ints

BACKGROUND_MARGIN = 0.2
"""How far the background reaches beyond the model, in parts of its diagonal."""
OUTSIDE_SLOPE = 1.5
"""Outside, a length away from the model, they grow by this slope."""
CELL_WIDTH = 2.0
"""Cells are at most so many of the shortest lengths in them wide."""
DEEPEST = 12
"""How often cells are halved at most."""
SHAKEN = 1e-3
"""Corners are moved by this part of the least cell, lest eight of them lie on a sphere."""
CUBE_CORNERS = np.array([[i, j, k] for i in (0, 1) for j in (0, 1) for k in (0, 1)])
UNIFORM = 1.15
"""Lengths that differ by no more than this factor need no field,"""
HOLLOW = 5.0
"""unless one length all over the box gives more than so many times as many tetrahedra as a field
that grows outside the model does: a mesher of the whole box, such as TetWild, fills it, and a field
takes it two more passes."""
FIELD_PROBES = 4000
LONGEST_BESIDE = 0.5
"""The longest length beside the model, in parts of its diagonal: a slender one fills little of the
cube that its field is made in."""
BOX_MARGIN = 0.05
"""How far such a box reaches beyond the model, in parts of its diagonal."""


def sizing(geometry: Geometry, wish: Wishes, sizes: Array) -> tuple[float, SizeField | None]:
    """The length a mesher begins with all over, and the field that refines the mesh then.

    There is no field where one length serves.

    Args:
        geometry: of the model.
        wish: lengths at points.
        sizes: (r,) the largest length in each region.
    """
    lengths = _joined(geometry, wish, sizes)
    longest = float(wish.lengths.max())
    hollow = is_hollow(geometry, lengths, longest)
    if is_uniform(wish) and not hollow:
        return longest, None
    low, high = _box(geometry, BACKGROUND_MARGIN)
    least = float(wish.lengths.min())
    points = octree_corners(low, float((high - low).max()), lengths, least)
    bounded = np.minimum(lengths(points), max(longest, LONGEST_BESIDE * geometry.diagonal))
    field = SizeField(points, delaunay(points), bounded)
    return float(field.sizes.max()) if hollow else longest, field


def _joined(geometry: Geometry, wish: Wishes, sizes: Array) -> Lengths:
    """The least of all wishes and regions' sizes, growing fast outside."""
    within = np.append(sizes, np.inf)

    def lengths(points: Array) -> Array:
        region = geometry.index.region_of(points)
        found = np.asarray(np.minimum(wish.at(points), within[region]))
        rows = np.flatnonzero(region < 0)
        if len(rows):
            away = geometry.index.nearest(points[rows]).distance - found[rows]
            found[rows] += (OUTSIDE_SLOPE - SLOPE) * np.maximum(away, 0.0)
        return found

    return lengths


def is_uniform(wish: Wishes) -> bool:
    """Whether all lengths are about the same."""
    return bool(wish.lengths.max() <= UNIFORM * wish.lengths.min())


def is_hollow(geometry: Geometry, lengths: Lengths, longest: float, seed: int = 0) -> bool:
    """Whether a model leaves so much of its box empty that one length all over is too costly."""
    probes = np.random.default_rng(seed).uniform(
        *_box(geometry, BOX_MARGIN), size=(FIELD_PROBES, 3)
    )
    share = float(np.mean((longest / lengths(probes)) ** 3))
    return HOLLOW * share < 1


def octree_corners(
    low: Array, width: float, lengths: Lengths, least: float, seed: int = 0
) -> Array:
    """The corners (n, 3) of cells that are about as wide as lengths in them, a little shaken.

    Args:
        low: (3,) the lowest corner of the whole.
        width: of the whole.
        lengths: wanted; inside they grow by `SLOPE` for each unit of way at most.
        least: of them all. A cell's middle can be far from a slender model that passes it.
        seed: of the shaking.
    """
    cells = np.zeros((1, 3), dtype=np.int64)
    corners = []
    depth = 0
    while len(cells):
        step = width / 2**depth
        middles = low + (cells + 0.5) * step
        shortest = lengths(middles) - SLOPE * step * np.sqrt(3) / 2
        wide = step > CELL_WIDTH * np.maximum(shortest, least)
        wide &= depth < DEEPEST
        scale = 2 ** (DEEPEST - depth)
        corners.append(((cells[~wide][:, None] + CUBE_CORNERS) * scale).reshape(-1, 3))
        cells = (2 * cells[wide][:, None] + CUBE_CORNERS).reshape(-1, 3)
        depth += 1
    grid = np.unique(np.concatenate(corners), axis=0)
    shake = SHAKEN * width / 2 ** (depth - 1)
    shaken = np.random.default_rng(seed).uniform(-shake, shake, size=grid.shape)
    return np.asarray(low + grid * (width / 2**DEEPEST) + shaken)


def delaunay(points: Array) -> Ints:
    """The Delaunay tetrahedra (m, 4) of points (n, 3), positively oriented."""
    tets = Delaunay(points).simplices.astype(np.int64)
    a, b, c, d = np.moveaxis(points[tets], 1, 0)
    turned = np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a) < 0
    tets[turned] = tets[turned][:, [1, 0, 2, 3]]
    return np.asarray(tets)


def _box(geometry: Geometry, beyond: float) -> tuple[Array, Array]:
    """The lowest and the highest corner of a box around the model."""
    bounds = np.array([region.bounds for region in geometry.regions])
    margin = beyond * geometry.diagonal
    return bounds[:, 0].min(axis=0) - margin, bounds[:, 1].max(axis=0) + margin
