"""Lengths of edges as meshers take them."""

from __future__ import annotations

from dataclasses import dataclass

from decomp.vectors import Array, Ints


@dataclass(frozen=True, eq=False)
class SizeField:
    """Edge lengths wanted at the nodes of a background mesh, linear in between.

    Args:
        points: (n, 3) nodes.
        tets: (m, 4).
        sizes: (n,), positive.
    """

    points: Array
    tets: Ints
    sizes: Array
