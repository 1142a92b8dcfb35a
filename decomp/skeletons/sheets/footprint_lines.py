"""Curves of the skeleton as they are drawn in the footprint of an edge that has several feet.

A point of a curve is drawn once for each of its feet on the edge, so a curve is drawn several
times; at a node, where feet run together, these drawings meet.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from decomp.complex.footprints.domain_base import Domain
from decomp.curves.base import Curve
from decomp.skeletons.curves.edge_wells import EdgeWells
from decomp.vectors import Array, Ints, norm

SLACK = 1e-8
"""Feet whose distances differ by less than this part of the size are as near."""


@dataclass(frozen=True, eq=False)
class FootprintLines:
    """Drawn curves.

    Args:
        vertex: (n,) the vertex of the complex that each drawn point is.
        uv: (n, 2) its coordinates.
        t: (n,) the parameter of its foot.
        segments: (m, 2) drawn points.
        of_line: for each curve the numbers of its drawn points.
    """

    vertex: Ints
    uv: Array
    t: Array
    segments: Ints
    of_line: tuple[Ints, ...]


def drawn_lines(
    points: Array,
    lines: Sequence[Ints],
    domain: Domain,
    wells: EdgeWells,
    curve: Curve,
    size: float,
) -> FootprintLines:
    """Draw polylines in the footprint of an edge.

    Args:
        points: (n, 3) all vertices of the complex.
        lines: polylines of vertices, each with a vertex inside; closed ones repeat the first.
        domain: the footprint.
        wells: of the edge.
        curve: of the edge.
        size: of the region.
    """
    used = np.unique(np.concatenate(list(lines)))
    feet = wells.feet(points[used], SLACK * size)
    count = np.array([len(t) for t in feet])
    first = np.concatenate([[0], np.cumsum(count)])
    vertex, t = np.repeat(used, count), np.concatenate(feet)
    uv = domain.to_plane(curve.point(curve.wrapped(t)), points[vertex])
    base = np.array([p or 0.0 for p in domain.period])

    def apart(one: Ints, other: Ints) -> Array:
        step = uv[one][:, None] - uv[other]
        return norm(step - base * np.round(step / np.where(base > 0, base, np.inf)))

    nodes = {int(k) for line in lines if line[0] != line[-1] for k in (line[0], line[-1])}
    segments: list[tuple[int, int]] = []
    of_line = []
    for line in lines:
        begin = len(segments)
        for a, b in zip(line[:-1].tolist(), line[1:].tolist(), strict=True):
            one, other = (
                np.arange(first[k], first[k + 1]) for k in np.searchsorted(used, [a, b]).tolist()
            )
            gaps = apart(one, other)
            found: set[tuple[int, int]] = set()
            # at a node there may be feet that the line does not have
            if a not in nodes or b in nodes:
                found |= set(zip(one.tolist(), other[gaps.argmin(axis=1)].tolist(), strict=True))
            if b not in nodes or a in nodes:
                found |= set(zip(one[gaps.argmin(axis=0)].tolist(), other.tolist(), strict=True))
            segments += sorted(found)
        of_line.append(np.unique(np.array(segments[begin:], dtype=np.int64)))
    both = np.sort(np.array(segments, dtype=np.int64).reshape(-1, 2), axis=1)
    return FootprintLines(vertex, uv, t, np.unique(both, axis=0), tuple(of_line))
