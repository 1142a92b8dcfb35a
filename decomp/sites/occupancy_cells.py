"""Building the occupancy octree, level by level.

Every cell has its own program: the model's, restricted by the carriers whose sign is the same all
over the cell.
"""

from __future__ import annotations

from math import sqrt
from typing import NamedTuple

import numpy as np

from decomp.carriers.compiled_carriers import CarrierTable, signed_distance
from decomp.kernels.compiled import inner, inner_kernel, kernel
from decomp.sites.growing import counted
from decomp.sites.programs import (
    EITHER,
    IN,
    OUT,
    Bytes,
    Programs,
    empty_programs,
    restrict,
    with_room,
)
from decomp.tolerance import ENLARGED
from decomp.vectors import Array, Ints


class Cells(NamedTuple):
    """The cells of one level: centres (n, 3), their nodes in the octree, their programs."""

    centres: Array
    nodes: Ints
    programs: Programs


def circumradius(half: float, slack: float) -> float:
    """Radius of a ball around a cube of half side `half`, a bit enlarged."""
    return sqrt(3.0) * half * (1 + ENLARGED) + slack


@inner_kernel
def restrict_to_ball(
    table: CarrierTable,
    programs: Programs,
    k: int,
    centre: Array,
    radius: float,
    known: Bytes,
    out: Programs,
    sizes: Ints,
) -> None:
    """Append to `out` what is left of program k in a ball."""
    first = programs.nodes[k]
    for node in range(programs.nodes[k + 1] - first):
        carrier = programs.literal[first + node]
        if carrier >= 0:
            away = signed_distance(table, carrier, centre[0], centre[1], centre[2])
            known[node] = IN if away < -radius else OUT if away > radius else EITHER
    restrict(programs, k, known, out, sizes)


@kernel
def root_cells(table: CarrierTable, program: Programs, centres: Array, radius: float) -> Cells:
    """The cells of the grid itself."""
    nodes, operands, only = len(program.literal), len(program.operands), len(program.nodes) - 2
    out = empty_programs(len(centres), nodes, operands, program.roots.shape[1])
    known = np.empty(nodes, dtype=np.int8)
    sizes = np.zeros(3, dtype=np.int64)
    for k in range(len(centres)):
        out = with_room(out, sizes, nodes, operands)
        restrict_to_ball(table, program, only, centres[k], radius, known, out, sizes)
    return Cells(centres, counted(only, len(centres)), out)


@inner
def variables_of(programs: Programs, k: int) -> int:
    """Number of literals in program k."""
    count = 0
    for node in range(programs.nodes[k], programs.nodes[k + 1]):
        if programs.literal[node] >= 0:
            count += 1
    return count


@kernel
def split(
    table: CarrierTable, cells: Cells, half: float, radius: float, next_node: int, most_kept: int
) -> tuple[Cells, Ints]:
    """Split the cells that have more than `most_kept` carriers into eight.

    Args:
        table: the carriers.
        cells: one level.
        half: half the side of a child.
        radius: of a ball around a child.
        next_node: number of nodes in the octree so far.
        most_kept: number of carriers.

    Returns:
        The children, and for each cell its first child (0 for a leaf).
    """
    programs, n = cells.programs, len(cells.nodes)
    first = np.zeros(n, dtype=np.int64)
    count, longest, most = 0, 1, 1
    for k in range(n):
        if variables_of(programs, k) > most_kept:
            first[k] = next_node + 8 * count
            count += 1
            nodes = programs.nodes[k + 1] - programs.nodes[k]
            longest = max(longest, nodes)
            at = programs.nodes[k] + k
            most = max(most, programs.start[at + nodes] - programs.start[at])
    centres = np.empty((8 * count, 3))
    out = empty_programs(8 * count, 8 * longest, 8 * most, programs.roots.shape[1])
    known = np.empty(longest, dtype=np.int8)
    sizes = np.zeros(3, dtype=np.int64)
    child = 0
    for k in range(n):
        if first[k] == 0:
            continue
        for octant in range(8):
            for axis in range(3):
                side = 2 * ((octant >> (2 - axis)) & 1) - 1
                centres[child, axis] = cells.centres[k, axis] + side * half
            out = with_room(out, sizes, longest, most)
            restrict_to_ball(table, programs, k, centres[child], radius, known, out, sizes)
            child += 1
    return Cells(centres, counted(next_node, 8 * count), out), first
