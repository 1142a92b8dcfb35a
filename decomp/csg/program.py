"""A Boolean expression over carriers, as a graph of n-ary ANDs with inverted references.

A reference is `2 * node + inverted`; node 0 is the constant TRUE, so reference 0 is TRUE and 1 is
FALSE. Unions are ANDs by De Morgan's law. Equal nodes are one node, so idempotence, double
complements, commutativity and contradictions cost nothing later.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from math import prod

import numpy as np

from decomp.vectors import Array, Bools, Ints

TRUE = 0
FALSE = 1
UNBOUNDED: Array = np.array([[-np.inf] * 3, [np.inf] * 3])


def inverted(reference: int) -> int:
    """The reference to the complement."""
    return reference ^ 1


@dataclass(frozen=True, eq=False)
class Program:
    """The graph in topological order, as arrays.

    Args:
        literal: carrier index (n,) that a node tests for "inside", -1 for an AND node.
        start: offsets (n + 1,) into `operands`.
        operands: references to earlier nodes, an AND node's parts.
        roots: references (r,), one per region.
        boxes: (n, 2, 3), corners of a box outside which a node is known to be false.
    """

    literal: Ints
    start: Ints
    operands: Ints
    roots: Ints
    boxes: Array

    def evaluate(self, inside: Bools) -> Bools:
        """Evaluate every root.

        Args:
            inside: (..., n_carriers), whether a point counts as inside each carrier.

        Returns:
            (..., n_roots), whether it is in each region.
        """
        shape = inside.shape[:-1]
        columns = inside.reshape(prod(shape), inside.shape[-1]).T
        values = np.empty((len(self.literal), columns.shape[1]), dtype=np.bool_)
        values[0] = True
        literals = self.literal >= 0
        values[literals] = columns[self.literal[literals]]
        for nodes, operands, starts in self._levels:
            parts = values[operands >> 1] ^ (operands & 1).astype(np.bool_)[:, None]
            values[nodes] = np.logical_and.reduceat(parts, starts, axis=0)
        chosen = values[self.roots >> 1] ^ (self.roots & 1).astype(np.bool_)[:, None]
        return np.ascontiguousarray(chosen.T).reshape(*shape, len(self.roots))

    @cached_property
    def _levels(self) -> list[tuple[Ints, Ints, Ints]]:
        """AND nodes in groups that depend on earlier groups only.

        Each group: its nodes, their operands one after the other, where each node's begin.
        """
        level = np.zeros(len(self.literal), dtype=np.int64)
        groups: dict[int, list[int]] = {}
        for node in range(1, len(self.literal)):
            parts = self.operands[self.start[node] : self.start[node + 1]]
            if len(parts):
                level[node] = level[parts >> 1].max() + 1
                groups.setdefault(int(level[node]), []).append(node)
        result = []
        for key in sorted(groups):
            nodes = np.array(groups[key], dtype=np.int64)
            pieces = [self.operands[self.start[n] : self.start[n + 1]] for n in nodes]
            ends = np.cumsum([len(piece) for piece in pieces])
            starts = np.concatenate([[0], ends[:-1]]).astype(np.int64)
            result.append((nodes, np.concatenate(pieces), starts))
        return result


class ProgramBuilder:
    """Makes nodes, each only once."""

    def __init__(self) -> None:
        self._nodes: list[int | tuple[int, ...]] = [()]
        self._known: dict[int | tuple[int, ...], int] = {(): 0}
        self._boxes: dict[int, Array] = {}

    def literal(self, carrier: int, inside: bool) -> int:
        """Reference to "the point is inside (or outside) the carrier"."""
        return self._reference(carrier) ^ (not inside)

    def conjunction(self, references: Iterable[int]) -> int:
        """Reference to the AND of `references`."""
        parts = sorted(set(references) - {TRUE})
        if FALSE in parts or any(a ^ 1 == b for a, b in pairwise(parts)):
            return FALSE
        return parts[0] if len(parts) == 1 else self._reference(tuple(parts))

    def bound(self, reference: int, box: Array) -> None:
        """Note that what `reference` stands for is false outside a box (2, 3)."""
        if not reference & 1:
            self._boxes[reference >> 1] = box

    def finish(self, roots: Sequence[int]) -> Program:
        """Drop what no root needs, merge nested ANDs that nothing shares, and lay out arrays."""
        uses = self._count_uses(roots)
        number: dict[int, int] = {0: 0}
        literal, start = [-1], [0, 0]
        operands: list[int] = []
        absorbed: dict[int, list[int]] = {}
        boxes = [UNBOUNDED]
        for node in range(1, len(self._nodes)):
            if not uses.get(node):
                continue
            content = self._nodes[node]
            parts: list[int] = []
            box = self._boxes.get(node, UNBOUNDED)
            if isinstance(content, tuple):
                for ref in content:
                    if not ref & 1 and ref >> 1 in absorbed:
                        parts.extend(absorbed.pop(ref >> 1))
                        inner = self._boxes.get(ref >> 1, UNBOUNDED)
                        box = np.array([np.maximum(box[0], inner[0]), np.minimum(box[1], inner[1])])
                    else:
                        parts.append(ref)
                self._boxes[node] = box
                if uses[node] == [False]:
                    absorbed[node] = parts
                    continue
            number[node] = len(literal)
            boxes.append(box)
            literal.append(-1 if isinstance(content, tuple) else content)
            operands.extend(2 * number[ref >> 1] + (ref & 1) for ref in parts)
            start.append(len(operands))
        renumbered = [2 * number[ref >> 1] + (ref & 1) for ref in roots]
        return Program(
            np.array(literal, dtype=np.int64),
            np.array(start, dtype=np.int64),
            np.array(operands, dtype=np.int64),
            np.array(renumbered, dtype=np.int64),
            np.array(boxes),
        )

    def _count_uses(self, roots: Sequence[int]) -> dict[int, list[bool]]:
        """For each needed node, its uses: `False` for a plain use in an AND, `True` otherwise."""
        uses: dict[int, list[bool]] = {}
        for ref in roots:
            uses.setdefault(ref >> 1, []).append(True)
        for node in range(len(self._nodes) - 1, 0, -1):
            content = self._nodes[node]
            if node in uses and isinstance(content, tuple):
                for ref in content:
                    uses.setdefault(ref >> 1, []).append(bool(ref & 1))
        return uses

    def _reference(self, content: int | tuple[int, ...]) -> int:
        node = self._known.get(content)
        if node is None:
            node = self._known[content] = len(self._nodes)
            self._nodes.append(content)
        return 2 * node
