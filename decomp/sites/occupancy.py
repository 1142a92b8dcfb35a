"""Which region holds a point."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from decomp.carriers.compiled_carriers import CarrierTable, carrier_table, signed_distance
from decomp.csg.halfspaces import HalfSpaceForm
from decomp.kernels.compiled import inlined, inner, scalar
from decomp.kernels.records import Record
from decomp.sites.nearby import MOST_TURNS, ROOM
from decomp.sites.occupancy_cells import circumradius, root_cells, split
from decomp.sites.occupancy_leaves import (
    OUTSIDE,
    Leaves,
    joined,
    make_leaves,
    shared_leaves,
)
from decomp.sites.octree import Links, Octree, grid_over, locate, root_centres
from decomp.sites.programs import NOTHING, VARIABLES, WHOLE, Words, evaluate, programs_of
from decomp.vectors import Array, Ints

Labels = NDArray[np.int32]

OCCUPANCY_DEPTH = 12
CELL_LIMIT = 400_000
FINE_NODES = 100_000
"""Up to so many nodes cells are split until one carrier is left, to save looking at others."""
MOST_TIED = 24
"""So many carriers that hold one point are told apart by points close to it."""
SIGN_ROUNDING = 1e-12
"""Signed distances below this, relative to the coordinates' size, may have either sign."""


@dataclass(frozen=True, eq=False)
class OccupancyTree(Record):
    """The octree with its leaves.

    Args:
        tree, leaves: the octree.
        table: the carriers.
        rounding: signed distances below this may have either sign.
        words, values: scratch for leaves without a table; see `private`.
        tied, turns, points: scratch for `on_boundary`.
    """

    tree: Octree
    leaves: Leaves
    table: CarrierTable
    rounding: float
    words: Words
    values: Words
    tied: Ints
    turns: Array
    points: Array


def occupancy_tree(form: HalfSpaceForm, bounds: Array) -> OccupancyTree:
    """Build the octree over a box (2, 3) that holds every region."""
    table = carrier_table(form.carriers)
    extent = float(np.linalg.norm(bounds[1] - bounds[0]))
    rounding = SIGN_ROUNDING * max(extent, 0.01 * float(np.abs(bounds).max()))
    grid = grid_over(bounds)
    centres = root_centres(grid)
    half = grid.size / 2
    cells = root_cells(table, programs_of(form.program), centres, circumradius(half, 4 * rounding))
    links: list[Links] = []
    parts = [shared_leaves(len(form.program.roots))]
    made, leaves = 0, len(parts[0].whole)
    for depth in range(OCCUPANCY_DEPTH + 1):
        made += len(cells.nodes)
        half /= 2
        if depth < OCCUPANCY_DEPTH and made + 8 * len(cells.nodes) < 8 * CELL_LIMIT:
            radius = circumradius(half, 4 * rounding)
            kept = 1 if made + 8 * len(cells.nodes) < FINE_NODES else VARIABLES
            children, first = split(table, cells, half, radius, made, kept)
        else:
            children, first = cells, np.zeros(len(cells.nodes), dtype=np.int64)
        parts.append(make_leaves(cells, first, leaves))
        links.append(first.astype(np.int32))
        leaves += len(parts[-1].whole)
        if not (first > 0).any():
            break
        cells = children
    tree = Octree(grid, np.concatenate(links))
    return with_scratch(tree, joined(parts), table, rounding)


def with_scratch(
    tree: Octree, leaves: Leaves, table: CarrierTable, rounding: float
) -> OccupancyTree:
    """Add scratch."""
    longest = int(np.diff(leaves.programs.nodes).max(initial=0))
    return OccupancyTree(
        tree,
        leaves,
        table,
        rounding,
        np.empty(longest, dtype=np.uint64),
        np.empty(leaves.programs.roots.shape[1], dtype=np.uint64),
        np.empty(MOST_TIED, dtype=np.int64),
        np.empty(MOST_TURNS),
        np.empty((ROOM, 3)),
    )


def private(shared: OccupancyTree) -> OccupancyTree:
    """The same octree with scratch of its own: every call from another thread needs it."""
    return with_scratch(shared.tree, shared.leaves, shared.table, shared.rounding)


@inlined
def label_at(occupancy: OccupancyTree, x: float, y: float, z: float) -> int:
    """The region that holds a point, or OUTSIDE."""
    leaf = locate(occupancy.tree, x, y, z)
    if leaf < 0:
        return OUTSIDE
    leaves = occupancy.leaves
    if leaves.whole[leaf] >= 0:
        return label_by_program(occupancy, leaves.whole[leaf], x, y, z)
    word, last = leaves.first_word[leaf], leaves.first_word[leaf + 1] - 1
    if word < last:
        begin, pattern = leaves.first_carrier[leaf], 0
        for j in range(leaves.first_carrier[leaf + 1] - begin):
            if signed_distance(occupancy.table, leaves.carriers[begin + j], x, y, z) < 0.0:
                pattern |= 1 << j
        bit = np.uint64(1) << np.uint64(pattern)
        while word < last and leaves.words[word] & bit == NOTHING:
            word += 1
    return int(leaves.labels[word])


@inner
def label_by_program(occupancy: OccupancyTree, k: int, x: float, y: float, z: float) -> int:
    """The same where too many carriers meet."""
    programs = occupancy.leaves.programs
    first, last = programs.nodes[k], programs.nodes[k + 1]
    words, values = occupancy.words, occupancy.values
    for node in range(first, last):
        carrier = programs.literal[node]
        if carrier >= 0:
            inside = signed_distance(occupancy.table, carrier, x, y, z) < 0.0
            words[node - first] = WHOLE if inside else NOTHING
    evaluate(programs, k, words, values)
    for r in range(len(values)):
        if values[r] != NOTHING:
            return r
    return OUTSIDE


@scalar
def labels_of(occupancy: OccupancyTree, points: Array, labels: Labels) -> None:
    """Fill in the region of each point (n, 3), or OUTSIDE."""
    for i in range(len(points)):
        labels[i] = label_at(occupancy, points[i, 0], points[i, 1], points[i, 2])
