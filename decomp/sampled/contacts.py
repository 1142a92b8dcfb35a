"""Which walls are skeleton: those across which the nearest point jumps."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from decomp.sampled.placing import Placer
from decomp.vectors import Ints


def links(
    placer: Placer,
    owner: dict[int, int],
    sites: Sequence[tuple[int, ...]],
    node: Ints,
    triangles: Ints,
    between: Ints,
) -> Ints:
    """For each triangle (t, 2) the sites of which one takes over from the other, -1 on sheets.

    Where a thin part is missing between two sites it is one of them and what lies between.

    Args:
        placer: of the region.
        owner: the face that owns each site.
        sites: of each vertex.
        node: (v,) the boundary node that each vertex is, -1 for none.
        triangles: (t, 3) vertices.
        between: (t, 2) sites on both sides.
    """
    result: Ints = np.full((len(triangles), 2), -1, dtype=np.int64)
    known: dict[tuple[int, int], bool] = {}
    groups: dict[tuple[int, ...], list[set[int]]] = {}
    for row, (a, b) in enumerate(between.tolist()):
        if (a, b) not in known:
            known[a, b] = placer.takes_over(a, b)
        if known[a, b]:
            result[row] = a, b
            continue
        corners = triangles[row].tolist()
        inner = [vertex for vertex in corners if node[vertex] < 0]
        if inner:
            asked = [sites[vertex] for vertex in inner]
        else:
            # on the boundary itself: it is the edge that the nodes are on
            asked = [tuple(sorted({site for v in corners for site in sites[v]}))]
        for own in asked:
            if len(own) < 3 or a not in own or b not in own:
                continue
            if own not in groups:
                groups[own] = placer.contacts(own)
            if any(a in group and b in group for group in groups[own]):
                result[row] = _between(placer, owner, own, a, b)
                break
    return result


def _between(
    placer: Placer, owner: dict[int, int], sites: tuple[int, ...], a: int, b: int
) -> tuple[int, int]:
    """Of what lies between two sites the pair at which one takes over from another's cell."""
    pairs = [(i, j) for i in sites for j in sites if i < j and placer.takes_over(i, j)]
    wanted = {owner[a], owner[b]}
    for i, j in pairs:
        if {owner[i], owner[j]} == wanted:
            return i, j
    return next(((i, j) for i, j in pairs if {a, b} & {i, j}), (a, b))
