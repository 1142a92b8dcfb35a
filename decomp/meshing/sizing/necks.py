"""Where faces are narrow: shoulders and steps, which make neither a thin wall nor a narrow gap."""

from __future__ import annotations

import itertools

import numpy as np

from decomp.boundary.topology import Edge, RegionBoundary
from decomp.complex.polylines import polyline_distance


def narrowest(boundary: RegionBoundary, width: float) -> float:
    """The least distance between edges of one face that do not meet; infinite if above a width.

    Args:
        boundary: of a region.
        width: that is looked for, in model units.
    """
    least = np.inf
    own: dict[int, list[Edge]] = {}
    for edge in boundary.edges:
        for face in set(edge.faces):
            own.setdefault(face, []).append(edge)
    for edges in own.values():
        boxes = np.array([[e.samples.min(axis=0), e.samples.max(axis=0)] for e in edges])
        for one, two in itertools.combinations(range(len(edges)), 2):
            apart = np.maximum(boxes[one, 0] - boxes[two, 1], boxes[two, 0] - boxes[one, 1])
            if apart.max() < min(width, least) and not _meet(edges[one], edges[two]):
                lines = edges[one].samples, edges[two].samples
                for line, other in (lines, lines[::-1]):
                    least = min(least, float(polyline_distance(line, other).min()))
    return least if least < width else np.inf


def _meet(one: Edge, two: Edge) -> bool:
    """Whether edges have a vertex in common."""
    return bool(set(one.vertices or ()) & set(two.vertices or ()))
