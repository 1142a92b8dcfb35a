"""Leaves of the occupancy octree: with at most six carriers left, a cell has a truth table."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from decomp.kernels.compiled import inner, kernel
from decomp.sites.growing import grown
from decomp.sites.occupancy_cells import Cells, variables_of
from decomp.sites.programs import (
    EITHER,
    NOTHING,
    PATTERN,
    VARIABLES,
    WHOLE,
    Programs,
    Words,
    empty_programs,
    evaluate,
    flips,
    restrict,
    with_room,
)
from decomp.vectors import Ints

OUTSIDE = -1


class Leaves(NamedTuple):
    """What is known in each leaf.

    Args:
        first_carrier: offsets (n + 1,) into `carriers`.
        carriers: the carriers that matter in a leaf; the j-th is variable j of its words.
        first_word: offsets (n + 1,) into `labels` and `words`.
        labels: a region, or OUTSIDE.
        words: for which sign patterns a point is in that region.
        whole: the leaf's program in `programs` where too many carriers meet, else -1.
        programs: those programs.
    """

    first_carrier: Ints
    carriers: Ints
    first_word: Ints
    labels: Ints
    words: Words
    whole: Ints
    programs: Programs


@inner
def region_word(values: Words, label: int) -> np.uint64:
    """The word of a region, or of the outside."""
    if label != OUTSIDE:
        return values[label]  # type: ignore[no-any-return]
    word = WHOLE
    for r in range(len(values)):
        word &= ~values[r]
    return word


@inner
def constant_label(values: Words) -> int:
    """The region whose word is true, or OUTSIDE."""
    for r in range(len(values)):
        if values[r] != NOTHING:
            return r
    return OUTSIDE


@inner
def truth_words(programs: Programs, k: int, variable: Ints, words: Words, values: Words) -> None:
    """Evaluate program k; variable[i] is that of its i-th literal, -1 to hold it at "outside"."""
    first, seen = programs.nodes[k], 0
    for node in range(programs.nodes[k + 1] - first):
        if programs.literal[first + node] >= 0:
            words[node] = PATTERN[variable[seen]] if variable[seen] >= 0 else NOTHING
            seen += 1
    evaluate(programs, k, words, values)


@inner
def choose_variables(programs: Programs, k: int, variable: Ints, room: Words, values: Words) -> int:
    """Number those literals of program k that it depends on, and evaluate it.

    Args:
        programs, k: a program with six literals at most.
        variable: for each literal its number, or -1; filled in.
        room: scratch.
        values: a word for each region; filled in.

    Returns:
        How many there are.
    """
    literals = variables_of(programs, k)
    for j in range(literals):
        variable[j] = j
    truth_words(programs, k, variable, room, values)
    count = 0
    for j in range(literals):
        matters = False
        for r in range(len(values)):
            matters = matters or flips(values[r], j) != NOTHING
        variable[j] = count if matters else -1
        count += matters
    truth_words(programs, k, variable, room, values)
    return count


@kernel
def make_leaves(cells: Cells, first: Ints, next_leaf: int) -> Leaves:
    """Leaves for the cells that are not split.

    Args:
        cells: one level.
        first: for each cell its first child, or 0; in place of 0, -1 - leaf is filled in. A cell
            that lies in one region gets the leaf 1 + region that all such cells share.
        next_leaf: the number of the first new leaf.
    """
    programs = cells.programs
    n, regions, longest = 0, programs.roots.shape[1], 1
    for k in range(len(first)):
        if first[k] == 0:
            n += 1
            longest = max(longest, programs.nodes[k + 1] - programs.nodes[k])
    first_carrier = np.zeros(n + 1, dtype=np.int64)
    first_word = np.zeros(n + 1, dtype=np.int64)
    carriers = np.empty(VARIABLES * n, dtype=np.int64)
    labels = np.empty(2 * n, dtype=np.int64)
    words = np.empty(2 * n, dtype=np.uint64)
    whole = np.empty(n, dtype=np.int64)
    kept = empty_programs(n, longest, longest, regions)
    sizes = np.zeros(3, dtype=np.int64)
    known = np.empty(longest, dtype=np.int8)
    room = np.empty(longest, dtype=np.uint64)
    values = np.empty(regions, dtype=np.uint64)
    variable = np.empty(VARIABLES, dtype=np.int64)
    leaf, used, count = 0, 0, 0
    for k in range(len(first)):
        if first[k] != 0:
            continue
        base, nodes = programs.nodes[k], programs.nodes[k + 1] - programs.nodes[k]
        if variables_of(programs, k) > VARIABLES:
            at = base + k
            kept = with_room(kept, sizes, nodes, programs.start[at + nodes] - programs.start[at])
            for node in range(nodes):
                known[node] = EITHER
            restrict(programs, k, known, kept, sizes)
            whole[leaf] = sizes[0] - 1
        else:
            whole[leaf] = -1
            if choose_variables(programs, k, variable, room, values) == 0:
                first[k] = -1 - (1 + constant_label(values))
                continue
            seen = 0
            for node in range(base, base + nodes):
                if programs.literal[node] >= 0:
                    if variable[seen] >= 0:
                        carriers[used] = programs.literal[node]
                        used += 1
                    seen += 1
            labels = grown(labels, count + regions + 1)
            words = grown(words, count + regions + 1)
            for r in range(-1, regions):
                word = region_word(values, r)
                if word != NOTHING:
                    labels[count], words[count] = r, word
                    count += 1
        first[k] = -1 - (next_leaf + leaf)
        leaf += 1
        first_carrier[leaf], first_word[leaf] = used, count
    offsets, ends = first_carrier[: leaf + 1], first_word[: leaf + 1]
    return Leaves(offsets, carriers, ends, labels, words, whole[:leaf], kept)


def shared_leaves(regions: int) -> Leaves:
    """The leaves of the cells that lie in one region, the outside first."""
    n = regions + 1
    nothing = np.zeros(n + 1, dtype=np.int64)
    return Leaves(
        nothing,
        nothing[:0],
        np.arange(n + 1),
        np.arange(n) + OUTSIDE,
        np.full(n, WHOLE),
        np.full(n, -1),
        empty_programs(1, 1, 1, regions),
    )


def joined(parts: list[Leaves]) -> Leaves:
    """All levels' leaves as one."""
    used = [_trimmed(part) for part in parts]
    shift = np.cumsum([0] + [len(p.nodes) - 1 for p in used])
    return Leaves(
        _chained([part.first_carrier for part in parts]).astype(np.int32),
        np.concatenate([part.carriers[: part.first_carrier[-1]] for part in parts], dtype=np.int32),
        _chained([part.first_word for part in parts]).astype(np.int32),
        np.concatenate([part.labels[: part.first_word[-1]] for part in parts], dtype=np.int32),
        np.concatenate([part.words[: part.first_word[-1]] for part in parts]),
        np.concatenate(
            [np.where(p.whole >= 0, p.whole + s, -1) for p, s in zip(parts, shift, strict=False)],
            dtype=np.int32,
        ),
        Programs(
            _chained([p.nodes for p in used]),
            np.concatenate([p.literal for p in used]),
            np.concatenate(
                [
                    p.start + s
                    for p, s in zip(used, _starts([len(p.operands) for p in used]), strict=False)
                ]
            ),
            np.concatenate([p.operands for p in used]),
            np.concatenate([p.roots for p in used]),
        ),
    )


def _trimmed(part: Leaves) -> Programs:
    """The programs of a level without the spare room behind them."""
    programs = part.programs
    count = int((part.whole >= 0).sum())
    nodes = int(programs.nodes[count])
    operands = int(programs.start[nodes + count - 1]) if count else 0
    return Programs(
        programs.nodes[: count + 1],
        programs.literal[:nodes],
        programs.start[: nodes + count],
        programs.operands[:operands],
        programs.roots[:count],
    )


def _starts(lengths: list[int]) -> Ints:
    return np.cumsum([0, *lengths])


def _chained(offsets: list[Ints]) -> Ints:
    """Join arrays of offsets, each of which begins with 0."""
    shift = _starts([int(o[-1]) for o in offsets])
    parts = [o[1:] + s for o, s in zip(offsets, shift, strict=False)]
    return np.concatenate([np.zeros(1, dtype=np.int64), *parts])
