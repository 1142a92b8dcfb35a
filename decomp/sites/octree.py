"""A grid of cubes, each the root of an octree: where a point lies, found with integer arithmetic.

Both spatial structures here use it, on the same grid, so that their cells are nested.
"""

from __future__ import annotations

from math import ceil
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from decomp.kernels.compiled import inlined, kernel
from decomp.tolerance import ENLARGED
from decomp.vectors import Array, Ints

DEPTH = 20
"""Levels below the grid that integer coordinates can tell apart."""

Links = NDArray[np.int32]


class Grid(NamedTuple):
    """A box of cubes.

    Args:
        low: its lower corner (3,).
        size: side of a cube.
        shape: number of cubes along each axis (3,).
    """

    low: Array
    size: float
    shape: Ints


class Octree(NamedTuple):
    """Cells below a grid.

    Args:
        grid: the roots; the cube (i, j, k) is node (i * shape[1] + j) * shape[2] + k.
        links: for each node the first of its eight children, or -1 - leaf.
    """

    grid: Grid
    links: Links


def grid_over(bounds: Array, margin: float = 0.01) -> Grid:
    """A grid of at most 64 cubes a side over the box `bounds` (2, 3), a bit enlarged."""
    extent = bounds[1] - bounds[0]
    longest = float(extent.max()) or float(np.abs(bounds).max()) or 1.0
    low = bounds[0] - margin * longest
    extent = extent + 2 * margin * longest
    size = max(float(extent.min()), float(extent.max()) / 64)
    shape = [max(1, ceil(e / size - ENLARGED)) for e in extent]
    return Grid(low, size * (1 + ENLARGED), np.array(shape, dtype=np.int64))


@inlined
def locate(tree: Octree, x: float, y: float, z: float) -> int:
    """The leaf that holds a point, -1 outside the grid."""
    grid, links = tree.grid, tree.links
    shape = grid.shape
    u = (x - grid.low[0]) / grid.size
    v = (y - grid.low[1]) / grid.size
    w = (z - grid.low[2]) / grid.size
    if not (0.0 <= u < shape[0] and 0.0 <= v < shape[1] and 0.0 <= w < shape[2]):
        return -1
    i, j, k = int(u), int(v), int(w)
    link = links[(i * shape[1] + j) * shape[2] + k]
    if link >= 0:
        scale = 1 << DEPTH
        i, j, k = int((u - i) * scale), int((v - j) * scale), int((w - k) * scale)
        level = DEPTH - 1
        while link >= 0:
            octant = ((i >> level) & 1) * 4 + ((j >> level) & 1) * 2 + ((k >> level) & 1)
            link = links[link + octant]
            level -= 1
    return -1 - int(link)


@kernel
def root_centres(grid: Grid) -> Array:
    """Centres (n, 3) of the grid's cubes, in the order of the nodes."""
    shape = grid.shape
    centres = np.empty((shape[0] * shape[1] * shape[2], 3))
    n = 0
    for i in range(shape[0]):
        for j in range(shape[1]):
            for k in range(shape[2]):
                centres[n, 0] = grid.low[0] + (i + 0.5) * grid.size
                centres[n, 1] = grid.low[1] + (j + 0.5) * grid.size
                centres[n, 2] = grid.low[2] + (k + 0.5) * grid.size
                n += 1
    return centres
