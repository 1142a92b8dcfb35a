"""Which sites can be nearest to points of a cell: an octree per region with lists of candidates.

Distances are 1-Lipschitz: let U be an upper bound of the distance from a cell's centre to the
region's boundary and L_k a lower bound of that to candidate k. In a cell of circumradius R, k can
be nearest only if L_k - R <= U + R, and only if a foot of the cell's points can fall on it. Lists
are handed down from a cell to its children.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, sqrt
from typing import NamedTuple

import numpy as np

from decomp.kernels.compiled import inner, kernel
from decomp.kernels.records import Record
from decomp.sites.growing import counted, grown
from decomp.sites.measure import better, count_of, no_hit
from decomp.sites.occupancy import OccupancyTree
from decomp.sites.occupancy_cells import circumradius
from decomp.sites.octree import DEPTH, Links, Octree, root_centres
from decomp.sites.programs import NOTHING
from decomp.sites.site_bounds import at_least, possible
from decomp.sites.site_table import SiteTable
from decomp.vectors import Array, Bools, Ints

ENOUGH = 4
"""A cell with no more candidates than this is not split,"""
DEEP_LEVELS, CROWDED_LEAF = 7, 8
"""and one so many levels down only if it has more than so many."""
CANDIDATES_DEPTH = 9
CELL_LIMIT = 400_000


@dataclass(frozen=True, eq=False)
class CandidateTree(Record):
    """The octree, and the candidates of leaf k: items[first[k]] to items[first[k + 1]]."""

    tree: Octree
    first: Ints
    items: Ints


class Level(NamedTuple):
    """The cells of one level with their lists.

    Args:
        centres: (n, 3).
        bounds: upper bounds (n,) of the distance from the centres to the boundary.
        first: offsets (n + 1,) into items.
        items: candidates, the one with the least lower bound at the centre first.
        sizes: number (n,) of different things to look at: the faces on a carrier count as one.
    """

    centres: Array
    bounds: Array
    first: Ints
    items: Ints
    sizes: Ints


def candidate_tree(occupancy: OccupancyTree, sites: SiteTable, label: int) -> CandidateTree:
    """Build the octree of a region on the grid of the occupancy octree."""
    grid = occupancy.tree.grid
    every = counted(0, count_of(sites))
    whole = Level(
        np.zeros((1, 3)),
        np.full(1, inf),
        np.array([0, len(every)], dtype=np.int64),
        every,
        np.ones(1, dtype=np.int64),
    )
    centres = root_centres(grid)
    parents = np.zeros(len(centres), dtype=np.int64)
    half, made, leaves = grid.size / 2, 0, 0
    links: list[Links] = []
    firsts: list[Ints] = [np.zeros(1, dtype=np.int64)]
    items: list[Ints] = []
    total = 0
    level = whole
    for depth in range(CANDIDATES_DEPTH + 1):
        radius = circumradius(half, 4 * occupancy.rounding)
        level = hand_down(occupancy, sites, label, depth, radius, level, centres, parents)
        made += len(centres)
        split = level.sizes > (ENOUGH if depth < DEEP_LEVELS else CROWDED_LEAF)
        if depth == CANDIDATES_DEPTH or made + 8 * int(split.sum()) > CELL_LIMIT:
            split[:] = False
        first = made + 8 * (np.cumsum(split) - 1)
        ends = np.flatnonzero(~split)
        link = np.where(split, first, 0)
        link[ends] = -1 - np.arange(leaves, leaves + len(ends))
        links.append(link.astype(np.int32))
        leaves += len(ends)
        offsets, listed = without_repeats(sites, level, split)
        firsts.append(offsets[1:] + total)
        items.append(listed[: offsets[-1]])
        total += int(offsets[-1])
        if not split.any():
            break
        parents = np.repeat(np.flatnonzero(split), 8)
        half /= 2
        octants = 2 * np.array([[o >> 2 & 1, o >> 1 & 1, o & 1] for o in range(8)]) - 1
        centres = level.centres[parents] + half * np.tile(octants, (len(parents) // 8, 1))
    tree = Octree(grid, np.concatenate(links))
    return CandidateTree(tree, np.concatenate(firsts), np.concatenate(items))


@inner
def holds_label(occupancy: OccupancyTree, label: int, depth: int, centre: Array) -> bool:
    """Whether a region may occur in a cell `depth` levels below the grid."""
    tree, leaves = occupancy.tree, occupancy.leaves
    grid, links = tree.grid, tree.links
    u = (centre[0] - grid.low[0]) / grid.size
    v = (centre[1] - grid.low[1]) / grid.size
    w = (centre[2] - grid.low[2]) / grid.size
    i, j, k = int(u), int(v), int(w)
    link = links[(i * grid.shape[1] + j) * grid.shape[2] + k]
    scale = 1 << DEPTH
    i, j, k = int((u - i) * scale), int((v - j) * scale), int((w - k) * scale)
    level = DEPTH - 1
    while link >= 0:
        if DEPTH - 1 - level >= depth:
            return True
        octant = ((i >> level) & 1) * 4 + ((j >> level) & 1) * 2 + ((k >> level) & 1)
        link = links[link + octant]
        level -= 1
    leaf = -1 - link
    if leaves.whole[leaf] >= 0:
        return True
    for word in range(leaves.first_word[leaf], leaves.first_word[leaf + 1]):
        if leaves.labels[word] == label and leaves.words[word] != NOTHING:
            return True
    return False


@kernel
def hand_down(
    occupancy: OccupancyTree,
    sites: SiteTable,
    label: int,
    depth: int,
    radius: float,
    above: Level,
    centres: Array,
    parents: Ints,
) -> Level:
    """Make the lists of cells from those of their parents.

    Args:
        occupancy, sites, label: the region.
        depth: of the cells.
        radius: of the balls around them.
        above: the parents' level.
        centres: of the cells (n, 3).
        parents: of the cells (n,), indices into `above`.
    """
    n, used = len(centres), 0
    bounds = np.empty(n)
    first = np.zeros(n + 1, dtype=np.int64)
    items = np.empty(8 * n, dtype=np.int64)
    sizes = np.zeros(n, dtype=np.int64)
    low = np.empty(len(sites.face_carriers) + len(sites.kinds) + len(sites.vertices))
    stamp = np.full(len(occupancy.table.codes), -1)
    for cell in range(n):
        parent = parents[cell]
        x, y, z = centres[cell, 0], centres[cell, 1], centres[cell, 2]
        dx, dy, dz = (
            x - above.centres[parent, 0],
            y - above.centres[parent, 1],
            z - above.centres[parent, 2],
        )
        bounds[cell] = above.bounds[parent] + sqrt(dx * dx + dy * dy + dz * dz)
        first[cell + 1] = used
        if not holds_label(occupancy, label, depth, centres[cell]):
            continue
        begin, end = above.first[parent], above.first[parent + 1]
        best = begin
        for m in range(begin, end):
            k = above.items[m]
            low[k] = at_least(sites, occupancy.table, k, x, y, z)
            if low[k] < low[above.items[best]]:
                best = m
        hit = no_hit()
        if best < end:
            hit = better(occupancy, sites, label, above.items[best], x, y, z, hit)
        for m in range(begin, end):
            k = above.items[m]
            if low[k] < min(hit.least, bounds[cell]):
                hit = better(occupancy, sites, label, k, x, y, z, hit)
        bounds[cell] = min(bounds[cell], hit.least)
        reach = bounds[cell] + 2 * radius
        items = grown(items, used + end - begin)
        for m in range(begin, end):
            k = above.items[m]
            if low[k] > reach or not possible(sites, occupancy.table, k, x, y, z, radius):
                continue
            place = used
            while place > first[cell + 1] and low[items[place - 1]] > low[k]:
                items[place] = items[place - 1]
                place -= 1
            items[place] = k
            used += 1
            if k < len(sites.face_carriers):
                if stamp[sites.face_carriers[k]] == cell:
                    continue
                stamp[sites.face_carriers[k]] = cell
            sizes[cell] += 1
        first[cell + 1] = used
    return Level(centres, bounds, first, items, sizes)


@kernel
def without_repeats(sites: SiteTable, level: Level, split: Bools) -> tuple[Ints, Ints]:
    """The lists of the cells that are not split, with one face for each carrier: the lowest."""
    faces = len(sites.face_carriers)
    n, count = len(split), 0
    offsets = np.zeros(n + 1, dtype=np.int64)
    items = np.empty(level.first[n], dtype=np.int64)
    most = 0
    for k in range(faces):
        most = max(most, sites.face_carriers[k])
    place = np.zeros(most + 1, dtype=np.int64)
    leaf = 0
    for cell in range(n):
        if split[cell]:
            continue
        begin = count
        for m in range(level.first[cell], level.first[cell + 1]):
            k = level.items[m]
            if k < faces:
                carrier = sites.face_carriers[k]
                known = place[carrier]
                there = begin <= known < count and items[known] < faces
                if there and sites.face_carriers[items[known]] == carrier:
                    items[known] = min(items[known], k)
                    continue
                place[carrier] = count
            items[count] = k
            count += 1
        leaf += 1
        offsets[leaf] = count
    return offsets[: leaf + 1], items
