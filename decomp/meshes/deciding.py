"""What decided how long edges are in a region, where it was not the length that was asked for."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from decomp.meshes.model import TetMesh
from decomp.vectors import Ints

TOLD = 0.1
"""What decides at less than this part of a region's nodes is not told,"""
MOST_TOLD = 3
"""nor more than so many."""


@dataclass(frozen=True)
class Decider:
    """Something that asks for shorter edges than are asked for all over a region.

    Args:
        what: such as `curvature of part/hole.side`.
        share: of the region's nodes, at which it decides.
        length: wanted there, the median.
    """

    what: str
    share: float
    length: float


def deciders(mesh: TetMesh, tets: Ints) -> tuple[Decider, ...]:
    """What decides at the nodes of some tetrahedra (m, 4) or (m, 10), the most frequent first."""
    if mesh.reason is None or mesh.lengths is None:
        return ()
    nodes = np.unique(tets)
    numbers, counts = np.unique(mesh.reason[nodes], return_counts=True)
    found = [
        Decider(
            mesh.reasons[number].what,
            count / len(nodes),
            float(np.median(mesh.lengths[nodes[mesh.reason[nodes] == number]])),
        )
        for number, count in zip(numbers.tolist(), counts.tolist(), strict=True)
        if not mesh.reasons[number].asked and count >= TOLD * len(nodes)
    ]
    return tuple(sorted(found, key=lambda each: -each.share)[:MOST_TOLD])
