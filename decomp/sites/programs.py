"""Boolean programs in kernels: restricted to a cell, and evaluated for 64 sign patterns at once.

A word (uint64) holds the truth of something for all patterns of six variables: bit b is its value
where variable j is "inside" exactly if bit j of b is set. See `decomp.csg.program` for the graph.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from decomp.csg.program import Program
from decomp.kernels.compiled import inlined, inner, inner_kernel, kernel
from decomp.vectors import Ints

Words = NDArray[np.uint64]
Bytes = NDArray[np.int8]

VARIABLES = 6
WHOLE = np.uint64(0xFFFFFFFFFFFFFFFF)
NOTHING = np.uint64(0)
PATTERN = np.array(
    [
        0xAAAAAAAAAAAAAAAA,
        0xCCCCCCCCCCCCCCCC,
        0xF0F0F0F0F0F0F0F0,
        0xFF00FF00FF00FF00,
        0xFFFF0000FFFF0000,
        0xFFFFFFFF00000000,
    ],
    dtype=np.uint64,
)
OUT, IN, EITHER = 0, 1, 2


class Programs(NamedTuple):
    """Many programs, one after the other.

    Program k has the nodes nodes[k] to nodes[k + 1] and as many roots as all others. References
    count from the program's own first node; `start` has one entry more than nodes for each
    program, so that node i of program k has its operands at start[nodes[k] + k + i].
    """

    nodes: Ints
    literal: Ints
    start: Ints
    operands: Ints
    roots: Ints


def programs_of(program: Program) -> Programs:
    """A single program in this form."""
    nodes = np.array([0, len(program.literal)], dtype=np.int64)
    roots = program.roots.reshape(1, -1).copy()
    return Programs(
        nodes, program.literal.copy(), program.start.copy(), program.operands.copy(), roots
    )


@inner_kernel
def restrict(programs: Programs, k: int, known: Bytes, out: Programs, sizes: Ints) -> None:
    """Append to `out` what is left of program k when some of its literals are known.

    Args:
        programs, k: the program.
        known: for each of its nodes OUT, IN or EITHER; given for literals, filled in for ANDs.
        out: where to; large enough.
        sizes: programs, nodes and operands in `out` so far; updated.
    """
    first, n = programs.nodes[k], programs.nodes[k + 1] - programs.nodes[k]
    start, operands = programs.start[first + k :], programs.operands
    for node in range(n):
        if programs.literal[first + node] < 0:
            value = IN
            for m in range(start[node], start[node + 1]):
                part = known[operands[m] >> 1]
                if part == EITHER:
                    if value == IN:
                        value = EITHER
                elif part == (operands[m] & 1):
                    value = OUT
                    break
            known[node] = value
    # number[node]: -1 not needed, -2 needed, else its reference in the new program
    number = np.full(n, -1)
    for r in range(programs.roots.shape[1]):
        root = programs.roots[k, r]
        if known[root >> 1] == EITHER:
            number[root >> 1] = -2
    for node in range(n - 1, -1, -1):
        if number[node] == -2:
            for m in range(start[node], start[node + 1]):
                if known[operands[m] >> 1] == EITHER:
                    number[operands[m] >> 1] = -2
    where, base, end = sizes[0], sizes[1], sizes[2]
    out.literal[base], count = -1, 1  # the constant TRUE
    out.start[base + where], out.start[base + where + 1] = end, end
    for node in range(n):
        if number[node] != -2:
            continue
        here = end
        for m in range(start[node], start[node + 1]):
            if known[operands[m] >> 1] == EITHER:
                out.operands[here] = number[operands[m] >> 1] ^ (operands[m] & 1)
                here += 1
        if programs.literal[first + node] < 0 and here == end + 1:
            number[node] = out.operands[end]
            continue
        number[node] = 2 * count
        out.literal[base + count] = programs.literal[first + node]
        out.start[base + where + count + 1] = here
        end, count = here, count + 1
    for r in range(programs.roots.shape[1]):
        root = programs.roots[k, r]
        value = known[root >> 1]
        new = number[root >> 1] if value == EITHER else 1 - value
        out.roots[where, r] = new ^ (root & 1)
    out.nodes[where + 1] = base + count
    sizes[0], sizes[1], sizes[2] = where + 1, base + count, end


@inner
def evaluate(programs: Programs, k: int, words: Words, values: Words) -> None:
    """Evaluate program k for 64 patterns.

    Args:
        programs, k: the program.
        words: one for each of its nodes; given for literals, filled in for ANDs.
        values: one for each root; filled in.
    """
    first, n = programs.nodes[k], programs.nodes[k + 1] - programs.nodes[k]
    start, operands = programs.start[first + k :], programs.operands
    for node in range(n):
        if programs.literal[first + node] < 0:
            word = WHOLE
            for m in range(start[node], start[node + 1]):
                part = words[operands[m] >> 1]
                word &= ~part if operands[m] & 1 else part
            words[node] = word
    for r in range(programs.roots.shape[1]):
        root = programs.roots[k, r]
        word = words[root >> 1]
        values[r] = ~word if root & 1 else word


@inlined
def flips(word: np.uint64, variable: int) -> np.uint64:
    """The patterns without `variable` whose value changes when it is set."""
    shift = np.uint64(1 << variable)
    return np.uint64((word ^ (word >> shift)) & ~PATTERN[variable])


@kernel
def empty_programs(programs: int, nodes: int, operands: int, roots: int) -> Programs:
    """Room for as many programs, nodes and operands."""
    starts = np.zeros(programs + 1, dtype=np.int64)
    return Programs(
        starts,
        np.empty(nodes, dtype=np.int64),
        np.empty(nodes + programs, dtype=np.int64),
        np.empty(operands, dtype=np.int64),
        np.empty((programs, roots), dtype=np.int64),
    )


@inner
def copy(source: Ints, target: Ints, count: int) -> None:
    """Copy the first entries of an array."""
    for i in range(count):
        target[i] = source[i]


@inner_kernel
def with_room(programs: Programs, sizes: Ints, nodes: int, operands: int) -> Programs:
    """The same programs with room for one more of so many nodes and operands."""
    if (
        sizes[0] + 1 < len(programs.nodes)
        and sizes[1] + nodes <= len(programs.literal)
        and sizes[1] + sizes[0] + nodes + 1 <= len(programs.start)
        and sizes[2] + operands <= len(programs.operands)
    ):
        return programs
    roots = programs.roots.shape[1]
    new = empty_programs(
        2 * (sizes[0] + 1), 2 * (sizes[1] + nodes), 2 * (sizes[2] + operands), roots
    )
    copy(programs.nodes, new.nodes, sizes[0] + 1)
    copy(programs.literal, new.literal, sizes[1])
    copy(programs.start, new.start, sizes[1] + sizes[0])
    copy(programs.operands, new.operands, sizes[2])
    for k in range(sizes[0]):
        for r in range(roots):
            new.roots[k, r] = programs.roots[k, r]
    return new
