"""The size field as TetWild takes it: lengths at the nodes of a grid of tetrahedra."""

from __future__ import annotations

import itertools

import numpy as np

from decomp.geometry import Geometry
from decomp.tetra.child import SizeField
from decomp.tetra.sizes import SLOPE, Wishes
from decomp.vectors import Array, Ints

MARGIN = 0.2
"""How far the grid reaches beyond the model, in parts of its diagonal."""
FINE = 400
MOST = 28
"""The most grid lines along an axis."""
SPACING = 1.2
"""Grid lines are so many edge lengths apart."""
UNIFORM = 1.15
"""Lengths that differ by no more than this factor need no field."""


def size_field(geometry: Geometry, wish: Wishes, sizes: Array) -> SizeField | None:
    """The field of all wishes, None where one length serves.

    Args:
        geometry: of the model.
        wish: lengths at points.
        sizes: (r,) the largest length in each region.
    """
    if wish.lengths.max() <= UNIFORM * wish.lengths.min():
        return None
    bounds = np.array([region.bounds for region in geometry.regions])
    low, high = bounds[:, 0].min(axis=0), bounds[:, 1].max(axis=0)
    margin = MARGIN * geometry.diagonal
    lines = [grid_lines(low[k] - margin, high[k] + margin, wish, k) for k in range(3)]
    points = np.stack(np.meshgrid(*lines, indexing="ij"), axis=-1).reshape(-1, 3)
    region = geometry.index.region_of(points)
    inside = np.append(sizes, np.inf)[region]
    return SizeField(
        points, kuhn(*(len(line) for line in lines)), np.minimum(wish.at(points), inside)
    )


def grid_lines(low: float, high: float, wish: Wishes, axis: int) -> Array:
    """Coordinates along an axis, dense where lengths are small."""
    fine = np.linspace(low, high, FINE)
    length = np.full(FINE, np.inf)
    bins = np.clip(np.searchsorted(fine, wish.points[:, axis]), 0, FINE - 1)
    np.minimum.at(length, bins, wish.lengths)
    gap = np.abs(fine[:, None] - fine[None, :])
    length = (length[None, :] + SLOPE * gap).min(axis=1)
    count = np.concatenate([[0.0], np.cumsum(np.diff(fine) / (length[1:] + length[:-1]) * 2)])
    number = int(np.clip(np.ceil(count[-1] / SPACING), 4, MOST))
    return np.asarray(np.interp(np.linspace(0, count[-1], number + 1), count, fine))


def kuhn(nx: int, ny: int, nz: int) -> Ints:
    """Tetrahedra (m, 4) over the nodes of a grid, six to a box, conforming."""
    i, j, k = np.meshgrid(np.arange(nx - 1), np.arange(ny - 1), np.arange(nz - 1), indexing="ij")
    base = (i * ny * nz + j * nz + k).reshape(-1)
    step = (ny * nz, nz, 1)
    found = []
    for order in itertools.permutations(range(3)):
        corners = [base]
        for axis in order:
            corners.append(corners[-1] + step[axis])
        found.append(np.stack(corners, axis=1))
    return np.concatenate(found)
