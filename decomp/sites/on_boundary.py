"""Whether a point of a carrier is on the boundary of a region."""

from __future__ import annotations

import numpy as np

from decomp.carriers.compiled_carriers import Triple, signed_distance
from decomp.kernels.compiled import inlined, inner
from decomp.sites.nearby import in_general_position, points_nearby
from decomp.sites.occupancy import OccupancyTree
from decomp.sites.occupancy_leaves import region_word
from decomp.sites.octree import locate
from decomp.sites.programs import NOTHING, PATTERN, WHOLE, evaluate, flips

NOWHERE = -1
ANYWHERE = 1 << 40
RADII = np.array([3e6, 3e7, 3e8])
"""Radii of circles around a point, in units of the rounding.

At the first a carrier that bends away from another by 1e-5 / extent leaves it by ten times the
rounding, and nothing else is that close in most models; the others are for carriers that osculate.
"""


@inlined
def on_boundary(
    occupancy: OccupancyTree, label: int, carrier: int, x: float, y: float, z: float
) -> int:
    """Whether a point of a carrier is on the boundary of a region (or of the outside).

    It is where the carrier's sign alone decides whether the point is in the region, with some
    choice of the signs of all other carriers that hold the point to rounding, if points of the
    carrier close by have those signs.

    Returns:
        NOWHERE if it is not; else where `carrier` stands in `Leaves.carriers` for the point's
        leaf, ANYWHERE if the leaf has no table.
    """
    leaf = locate(occupancy.tree, x, y, z)
    if leaf < 0:
        return NOWHERE
    leaves = occupancy.leaves
    if leaves.whole[leaf] >= 0:
        return on_boundary_by_program(occupancy, leaves.whole[leaf], label, carrier, x, y, z)
    begin, end = leaves.first_carrier[leaf], leaves.first_carrier[leaf + 1]
    slot = begin
    while slot < end and leaves.carriers[slot] != carrier:
        slot += 1
    word, stop = leaves.first_word[leaf], leaves.first_word[leaf + 1]
    while word < stop and leaves.labels[word] != label:
        word += 1
    if slot == end or word == stop:
        return NOWHERE
    patterns, ties = flips(leaves.words[word], slot - begin), 0
    for j in range(end - begin):
        if patterns == NOTHING:
            return NOWHERE
        if begin + j != slot:
            away = signed_distance(occupancy.table, leaves.carriers[begin + j], x, y, z)
            if away < -occupancy.rounding:
                patterns &= PATTERN[j]
            elif away > occupancy.rounding:
                patterns &= ~PATTERN[j]
            else:
                ties |= 1 << j
    if patterns == NOTHING:
        return NOWHERE
    if ties == 0 or occurs(occupancy, begin, carrier, ties, patterns, (x, y, z)):
        return int(slot)
    return NOWHERE


@inner
def occurs(
    occupancy: OccupancyTree, begin: int, carrier: int, ties: int, patterns: np.uint64, q: Triple
) -> bool:
    """Whether some of the patterns of a leaf occur around a point q of a carrier.

    Args:
        occupancy: the octree.
        begin: where the leaf's carriers begin in `Leaves.carriers`.
        carrier: the one on which the patterns are looked for.
        ties: bits of the leaf's carriers that hold the point too.
        patterns: of the leaf's signs.
        q: the point.
    """
    table, carriers, tied = occupancy.table, occupancy.leaves.carriers, occupancy.tied
    count = 0
    for j in range(len(PATTERN)):
        if (ties >> j) & 1:
            tied[count] = carriers[begin + j]
            count += 1
    if in_general_position(table, carrier, tied, count, q, RADII[0] * occupancy.rounding):
        return True
    points, any_clear = occupancy.points, False
    for level in range(len(RADII)):
        radius = RADII[level] * occupancy.rounding
        made = points_nearby(table, carrier, tied, count, q, radius, occupancy.turns, points)
        clear, any_clear = True, False
        for i in range(made):
            here, known = patterns, True
            for j in range(len(PATTERN)):
                if (ties >> j) & 1:
                    x, y, z = points[i, 0], points[i, 1], points[i, 2]
                    away = signed_distance(table, carriers[begin + j], x, y, z)
                    known = known and abs(away) > occupancy.rounding
                    here &= PATTERN[j] if away < 0.0 else ~PATTERN[j]
            if known and here != NOTHING:
                return True
            clear, any_clear = clear and known, any_clear or known
        if clear:
            return False
    # carriers that are one as far as can be seen: their signs are anything
    return not any_clear


@inner
def on_boundary_by_program(
    occupancy: OccupancyTree, k: int, label: int, carrier: int, x: float, y: float, z: float
) -> int:
    """The same where too many carriers meet."""
    programs, table, tied = occupancy.leaves.programs, occupancy.table, occupancy.tied
    count, present = 0, False
    for node in range(programs.nodes[k], programs.nodes[k + 1]):
        other = programs.literal[node]
        present = present or other == carrier
        if other < 0 or other == carrier or count == len(tied):
            continue
        if abs(signed_distance(table, other, x, y, z)) <= occupancy.rounding:
            tied[count] = other
            count += 1
    if not present:
        return NOWHERE
    q = (x, y, z)
    if count == 0:
        return ANYWHERE if decides(occupancy, k, label, carrier, q, q) else NOWHERE
    points, any_clear = occupancy.points, False
    for level in range(len(RADII)):
        radius = RADII[level] * occupancy.rounding
        made = points_nearby(table, carrier, tied, count, q, radius, occupancy.turns, points)
        clear, any_clear = True, False
        for i in range(made):
            here, known = (points[i, 0], points[i, 1], points[i, 2]), True
            for j in range(count):
                away = signed_distance(table, tied[j], here[0], here[1], here[2])
                known = known and abs(away) > occupancy.rounding
            clear, any_clear = clear and known, any_clear or known
            if known and decides(occupancy, k, label, carrier, q, here):
                return ANYWHERE
        if clear:
            return NOWHERE
    return NOWHERE if any_clear else ANYWHERE


@inner
def decides(
    occupancy: OccupancyTree, k: int, label: int, carrier: int, q: Triple, nearby: Triple
) -> bool:
    """Whether a carrier's sign alone decides whether a region holds a point q of it.

    The signs of the others that hold q to rounding are those at a point nearby.
    """
    programs, table = occupancy.leaves.programs, occupancy.table
    words, values = occupancy.words, occupancy.values
    first = programs.nodes[k]
    for node in range(first, programs.nodes[k + 1]):
        other = programs.literal[node]
        if other < 0:
            continue
        if other == carrier:
            words[node - first] = PATTERN[0]
            continue
        away = signed_distance(table, other, q[0], q[1], q[2])
        if abs(away) <= occupancy.rounding:
            away = signed_distance(table, other, nearby[0], nearby[1], nearby[2])
        words[node - first] = WHOLE if away < 0.0 else NOTHING
    evaluate(programs, k, words, values)
    return bool(flips(region_word(values, label), 0) != NOTHING)
