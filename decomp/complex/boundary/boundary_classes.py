"""What lies on either side of every triangle of a carrier.

Borders of a region's faces are followed: the part left of a border belongs to the face, the part
right of it does not, and what another region's edges cut off belongs together.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.sparse import coo_array  # type: ignore[import-untyped]
from scipy.sparse.csgraph import connected_components  # type: ignore[import-untyped]

from decomp.complex.boundary.boundary_layout import Layout
from decomp.complex.plane.planar import components
from decomp.errors import GeometryError
from decomp.vectors import Bools, Ints


class FoldedError(GeometryError):
    """The segments of a carrier's pieces do not separate what their curves separate."""


@dataclass(frozen=True, eq=False)
class Sides:
    """What lies on the two sides of triangles.

    Args:
        outer: (m, 2) region and face on the carrier's outside, -1 where there is none.
        inner: (m, 2) the same on its inside.
    """

    outer: Ints
    inner: Ints

    @property
    def filled(self) -> Bools:
        """(m,) whether some region has a face there."""
        return np.asarray((self.outer[:, 0] >= 0) | (self.inner[:, 0] >= 0))


def sides_of(layout: Layout, triangles: Ints, segments: Ints, names: Ints, count: int) -> Sides:
    """Find the faces that triangles are part of.

    Args:
        layout: of the carrier.
        triangles: (m, 3) indices of points, counterclockwise seen from the carrier's outside.
        segments: (k, 2) of all pieces on the carrier, edges of triangles.
        names: the (piece, segment) (k, 2) of each, piece by piece.
        count: number of points.

    Raises:
        FoldedError: no face fits what is on its sides.
    """
    part = components(triangles, segments, count)
    ends = np.roll(triangles, -1, axis=1)
    keys, owner = (triangles * count + ends).ravel(), np.repeat(part, 3)
    order = np.argsort(keys)
    keys, owner = keys[order], owner[order]
    left = _looked_up(keys, owner, segments[:, 0] * count + segments[:, 1])
    right = _looked_up(keys, owner, segments[:, 1] * count + segments[:, 0])
    total = int(part.max(initial=-1)) + 1
    found = np.full((2, total, 2), -1, dtype=np.int64)
    for region in sorted({use.region for use in layout.faces}):
        for slot, outward in enumerate((-1, 1)):
            label = _labels(layout, region, outward, names[:, 0], left, right, total)
            taken = label >= 0
            found[slot, taken, 0] = region
            found[slot, taken, 1] = label[taken]
    return Sides(found[0][part], found[1][part])


def _labels(
    layout: Layout, region: int, outward: int, piece: Ints, left: Ints, right: Ints, total: int
) -> Ints:
    """The face (total,) of one region on one side of each part, -1 where there is none."""
    faces = [u for u in layout.faces if (u.region, u.outward) == (region, outward)]
    label = np.full(total, -1, dtype=np.int64)
    if not faces:
        return label
    whole = [u for u in faces if not u.border]
    if whole:
        label[:] = whole[0].face
        return label
    # faces on the left and right of every segment that borders one
    wanted = np.full((2, len(piece)), -1, dtype=np.int64)
    own = np.zeros(len(piece), dtype=np.bool_)
    first = np.flatnonzero(np.diff(piece, prepend=-1))
    rows_of = {int(piece[a]): slice(a, b) for a, b in pairwise([*first.tolist(), len(piece)])}
    for use in faces:
        for number, direction in use.border:
            rows = rows_of[number]
            own[rows] = True
            wanted[0 if direction > 0 else 1, rows] = use.face
    group = _joined(left[~own], right[~own], total)
    sides, wants = np.concatenate([left[own], right[own]]), np.concatenate(wanted[:, own])
    there = sides >= 0
    if (wants[~there] >= 0).any():
        raise FoldedError(f"a face on carrier {layout.index} has no triangle beside its border")
    sides, wants = sides[there], wants[there]
    of_group = np.full(int(group.max(initial=-1)) + 1, -1, dtype=np.int64)
    bordered = wants >= 0
    of_group[group[sides[bordered]]] = wants[bordered]
    label = of_group[group]
    if (label[sides] != wants).any():
        raise FoldedError(f"the faces on carrier {layout.index} contradict each other")
    return label


def _looked_up(keys: Ints, values: Ints, wanted: Ints) -> Ints:
    """Values of sorted keys, -1 where a key is missing."""
    if not len(keys):
        return np.full(len(wanted), -1, dtype=np.int64)
    at = np.minimum(np.searchsorted(keys, wanted), len(keys) - 1)
    return np.where(keys[at] == wanted, values[at], -1)


def _joined(left: Ints, right: Ints, total: int) -> Ints:
    """Groups of parts that border each other along segments which are no border."""
    both = (left >= 0) & (right >= 0)
    links = coo_array((np.ones(int(both.sum())), (left[both], right[both])), shape=(total, total))
    return np.asarray(connected_components(links, directed=False)[1], dtype=np.int64)
