"""The surface of the points that are as near to one edge at two of its places.

Where the two places run together the surface ends, in a rim. It is continued by its tangent planes
there, which are at right angles to the edge, so that points beside the rim can be measured.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.spatial import cKDTree  # type: ignore[import-untyped]

from decomp.errors import GeometryError
from decomp.medial.edge_wells import EdgeWells
from decomp.medial.incidence import Incidence
from decomp.tracing.equidistance import equidistant
from decomp.tracing.fields import site_fields
from decomp.vectors import Array, Bools, Ints, dot, norm, place

DEEP = 0.1
"""Places of the edge that are farther than the nearest by this part of the distance are others."""
MERGED = 1e-6
"""Feet nearer to each other than this part of the size have run together."""
MOVED = 0.5
"""A point that moves by more than this part of the distance has left the sheet."""


@dataclass(frozen=True, eq=False)
class RimSegments:
    """Chords of the rims of a sheet.

    Args:
        points: (k, 2, 3) their ends.
        tangents: (k, 2, 3) the edge's unit tangents over them, in the sense of its parameter.
    """

    points: Array
    tangents: Array

    def nearest(self, points: Array) -> tuple[Array, Array]:
        """The nearest points of the chords (k, 3), and the tangents (k, 3) over them."""
        start, chord = self.points[:, 0], self.points[:, 1] - self.points[:, 0]
        square = np.maximum(dot(chord, chord), 1e-300)
        share = np.clip(dot(points[:, None] - start, chord) / square, 0.0, 1.0)
        at = start + share[..., None] * chord
        row = np.argmin(norm(points[:, None] - at), axis=1)
        every = np.arange(len(points))
        part = share[every, row][:, None]
        ways = (1 - part) * self.tangents[row, 0] + part * self.tangents[row, 1]
        return at[every, row], ways / norm(ways)[:, None]


@dataclass(frozen=True, eq=False)
class SelfSheetSurface:
    """Points at equal distance from two places of an edge, near known ones.

    Args:
        incidence: of the region.
        site: the edge.
        wells: of the edge.
        points: known points (k, 3) inside the sheet.
        feet: parameters (k, 2) of their feet; the normal points from the first to the second.
        rims: of the sheet.
    """

    incidence: Incidence
    site: int
    wells: EdgeWells
    points: Array
    feet: Array
    rims: RimSegments

    def place(self, points: Array) -> Array:
        """Move points (k, 3) straight onto the surface.

        Raises:
            GeometryError: a point cannot be moved; says where.
        """
        placed, good = self.try_place(points)
        if not good.all():
            name = self.incidence.sites[self.site].name
            raise GeometryError(
                f"a point near {place(points[~good][0])} cannot be moved onto the sheet that the "
                f"edge {name} has with itself"
            )
        return placed

    def try_place(self, points: Array) -> tuple[Array, Bools]:
        """Points moved onto the surface (k, 3), and whether that succeeded (k,)."""
        it, moved = self.incidence, np.array(points)
        feet, apart, _ = self._feet(points)
        good = np.ones(len(points), dtype=np.bool_)
        rows = np.flatnonzero(apart)
        if len(rows):
            which: Ints = np.full((len(rows), 2), self.site, dtype=np.int64)
            found = equidistant(it.boundary, it.sites, which, points[rows], feet[rows])
            moved[rows] = found.points
            near = norm(found.points - points[rows]) <= MOVED * found.radius
            good[rows] = found.converged & near
        rows = np.flatnonzero(~apart)
        if len(rows) and len(self.rims.points):
            on, ways = self.rims.nearest(points[rows])
            moved[rows] -= dot(points[rows] - on, ways)[:, None] * ways
        elif len(rows):
            good[rows] = False
        return moved, good

    def normal(self, points: Array) -> Array:
        """Unit normals (k, 3), from the first foot to the second."""
        feet, apart, sense = self._feet(points)
        across = feet[:, 1] - feet[:, 0]
        rows = np.flatnonzero(~apart)
        if len(rows):
            if not len(self.rims.points):
                raise GeometryError(f"the sheet at {place(points[rows[0]])} has no normal")
            across[rows] = sense[rows, None] * self.rims.nearest(points[rows])[1]
        return np.asarray(across / norm(across)[:, None])

    def _feet(self, points: Array) -> tuple[Array, Bools, Array]:
        """Both feet (k, 2, 3) of points, whether they are two (k,), and the way between them."""
        known = self._tree.query(points)[1]
        wanted = self.feet[known]
        reach = norm(points[:, None] - self.wells.points[::16]).min(axis=1)
        found = self.wells.around(points, DEEP * reach)
        first = np.searchsorted(found.row, np.arange(len(points)))
        count = np.bincount(found.row, minlength=len(points))
        chosen = np.empty((len(points), 2), dtype=np.int64)
        for side in (0, 1):
            gap = np.abs(self.wells.gap(wanted[found.row, side], self.wells.t[found.sample]))
            order = np.lexsort((gap, found.row))
            chosen[:, side] = found.sample[order[np.minimum(first, len(order) - 1)]]
        apart = (chosen[:, 0] != chosen[:, 1]) & (count > 0)
        starts = self.wells.points[chosen]
        which: Ints = np.full(2 * len(points), self.site, dtype=np.int64)
        it = self.incidence
        field = site_fields(
            it.boundary, it.sites, which, np.repeat(points, 2, axis=0), starts.reshape(-1, 3)
        )
        feet = field.foot.reshape(-1, 2, 3)
        apart &= norm(feet[:, 0] - feet[:, 1]) > MERGED * it.boundary.diagonal
        sense = np.sign(self.wells.gap(wanted[:, 0], wanted[:, 1]))
        return feet, apart, sense

    @cached_property
    def _tree(self) -> cKDTree:
        return cKDTree(self.points)
