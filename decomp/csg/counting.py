"""How many primitives a model has once its copies are made, found without making them.

A solid that copies a copied solid multiplies: 40 doublings of a cube, each a line of text, are
10^12 cubes. Only what is met in a place of its own is placed again; a solid used twice in one
place, as in `(a and b) or (a and c)`, counts once, as it is expanded once.
"""

from __future__ import annotations

from typing import NamedTuple

from decomp.csg.model import Model
from decomp.csg.primitives import Primitive
from decomp.csg.solid import Copies, Labelled, Solid, Transformed, Union
from decomp.errors import InputError

MOST_PRIMITIVES = 100_000
MOST_NODES = 10 * MOST_PRIMITIVES
"""Of the expanded tree: chains of operations count too."""

Placing = Transformed | Copies | Labelled
"""What puts its part into other places."""


class Count(NamedTuple):
    """Primitives and all nodes of an expanded solid; exact, however many they are."""

    primitives: int
    nodes: int


def refuse_too_many(model: Model) -> None:
    """Refuse a model that would take hours or all memory to expand.

    Raises:
        InputError: it has more than `MOST_PRIMITIVES` primitives, or `MOST_NODES` operations.
    """
    counter = _Counter()
    whole = counter.count(Union(tuple(region.solid for region in model.regions)))
    if whole.primitives > MOST_PRIMITIVES:
        many, most, what = whole.primitives, MOST_PRIMITIVES, "primitives"
    elif whole.nodes > MOST_NODES:
        many, most, what = whole.nodes, MOST_NODES, "operations"
    else:
        return
    largest = max(model.regions, key=lambda region: counter.count(region.solid))
    raise InputError(
        f"the model has {_shown(many)} {what} when all copies are made, most of them in region "
        f"{largest.name!r}, but at most {most:,} are computed with: make fewer copies"
    )


class _Counter:
    """Counts solids, each once."""

    def __init__(self) -> None:
        self._known: dict[int, Count] = {}
        self._seen = 0

    def count(self, solid: Solid) -> Count:
        """Count a solid expanded, in a place of its own."""
        stack = [solid]
        while stack:
            top = stack[-1]
            if id(top) in self._known:
                stack.pop()
                continue
            primitives, nodes, placed = self._reached(top)
            missing = [node.part for node, _ in placed if id(node.part) not in self._known]
            if missing:
                stack.extend(missing)
                continue
            stack.pop()
            inner = [(self._known[id(node.part)], times) for node, times in placed]
            self._known[id(top)] = Count(
                primitives + sum(times * count.primitives for count, times in inner),
                nodes + sum(times * count.nodes for count, times in inner),
            )
        return self._known[id(solid)]

    def _reached(self, solid: Solid) -> tuple[int, int, list[tuple[Placing, int]]]:
        """What stands below a solid in the same place: primitives, nodes, and what places others.

        The last come with the number of places that each makes.
        """
        primitives = 0
        placed: list[tuple[Placing, int]] = []
        seen = {id(solid)}
        stack = [solid]
        while stack:
            node = stack.pop()
            if isinstance(node, Primitive):
                primitives += 1
            elif isinstance(node, (Transformed, Copies, Labelled)):
                placed.append((node, len(node.by) if isinstance(node, Copies) else 1))
            else:
                fresh = {id(child): child for child in node.children() if id(child) not in seen}
                seen.update(fresh)
                stack.extend(fresh.values())
        self._seen += len(seen)
        # each solid is looked at twice at most, and is expanded at least once
        if self._seen > 4 * MOST_NODES:
            raise InputError(
                f"the model has more than {MOST_NODES:,} operations when all copies are made, "
                "which are as many as are computed with: make fewer copies"
            )
        return primitives, len(seen), placed


def _shown(many: int) -> str:
    """A number in full, or its power of ten where it has more digits than are read."""
    digits = (many.bit_length() - 1) * 30103 // 100000
    return f"{many:,}" if digits < 18 else f"some 10^{digits}"
