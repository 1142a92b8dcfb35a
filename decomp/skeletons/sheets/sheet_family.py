"""Sheets of one region that are asked for points of all of them at once."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from decomp.skeletons.balls.equidistance import placed_between
from decomp.skeletons.balls.fields import Field, site_fields
from decomp.skeletons.balls.supports import FACE
from decomp.skeletons.curves.incidence import Incidence
from decomp.vectors import Array, Bools, Ints, norm

CLEAR = 1e-9
"""Points nearer to a site than this part of the size have no direction from it."""


class SheetFamily:
    """Sheets whose sites' feet are found without a known one near by.

    Args:
        incidence: of the region.
        sites: of each of them.
    """

    def __init__(self, incidence: Incidence, sites: Sequence[tuple[int, int]]) -> None:
        self._incidence = incidence
        self._sites: Ints = np.array(sites, dtype=np.int64).reshape(-1, 2)

    def place(self, which: Ints, points: Array) -> tuple[Array, Bools]:
        """Points (k, 3), each moved onto a given member (k,), and whether that succeeded (k,)."""
        it = self._incidence
        feet = np.repeat(points[:, None], 2, axis=1)
        found = placed_between(it.context, self._sites[which], points, feet)
        return found.points, found.converged

    def normal(self, which: Ints, points: Array) -> tuple[Array, Bools]:
        """Unit normals (k, 3) at points (k, 3) on given members (k,), and whether they are good.

        Where one is not, its member has to be asked by itself.
        """
        it, pairs = self._incidence, self._sites[which]
        one, two = (site_fields(it.context, pairs[:, k], points, points) for k in (0, 1))
        found = difference(it, pairs, (one, two))
        length = norm(found)
        good = length > CLEAR
        return found / np.where(good, length, 1.0)[:, None], good


def difference(incidence: Incidence, pairs: Ints, fields: tuple[Field, Field]) -> Array:
    """Differences (k, 3) of the gradients of distances from two sites (k, 2) each.

    They vanish where a point is on an edge or vertex, from which it has no direction; from a face
    it has one there too.
    """
    one, two = fields
    found = one.gradient - two.gradient
    kinds = incidence.context.table.kinds
    for column, field in enumerate(fields):
        on = np.abs(field.distance) <= CLEAR * incidence.boundary.diagonal
        found[on & (kinds[pairs[:, column]] != FACE)] = 0.0
    return np.asarray(found)
