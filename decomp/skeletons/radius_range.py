"""The least and the greatest radius over sheets.

Vertices alone do not tell: a flat disc between two spherical caps is thickest where it has none.
On a sheet with unit normal n the radius grows by h = g - (g.n) n, g being the gradient of the
distance to either contact. Where h turns within a triangle an extremum can lie inside; it is
climbed to by Newton's method with the eigenvalues' signs set right, so that each step goes up.
All sheets of a region are climbed at once.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from decomp.complex.model import SurfaceElement
from decomp.skeletons.balls.queries import RegionQueries
from decomp.skeletons.sheets.self_surface import SelfSheetSurface
from decomp.skeletons.sheets.sheet_surface import SheetSurface
from decomp.tolerance import TINY
from decomp.vectors import Array, Bools, Ints, cross, dot, norm

INNER = 0.02
"""Corners are looked at from so far inside a triangle: at a corner itself other sites are near."""
LEVEL = 1e-10
"""A radius that grows more slowly than this does not grow."""
TURNED = 0.5
"""Cosine between the ways of growth at two corners, below which an extremum may lie between."""
STEPS = 12
GAIN = 1e-13
"""Gains below this part of the size are none."""
SPACING = 1e-5
"""Of finite differences, as a part of the size."""
ACROSS = 1e-9
"""How far to either side of a sheet its sites are asked for, as a part of the size."""
SLACK = 1e-12
APART = 1e-3
"""Feet nearer than this part of the radius are one."""
CURVED = 1e-12
HOPELESS = 3.0
"""A climb ends where this multiple of the gain to be expected would not lead beyond what is known.
"""

Range = tuple[float, float]


@dataclass(frozen=True, eq=False)
class DrawnSheet:
    """A sheet whose radius is asked for.

    Args:
        sites: its two.
        surface: that it lies on.
        triangles: (m, 3).
        known: least and greatest radius of its vertices and borders.
    """

    sites: tuple[int, int]
    surface: SurfaceElement
    triangles: Ints
    known: Range


class SheetRadii:
    """Seeks the extreme radii of the sheets of one region."""

    def __init__(self, queries: RegionQueries, sheets: Sequence[DrawnSheet]) -> None:
        self._queries, self._size, self._sheets = queries, queries.size, sheets
        self._sites: Ints = np.sort(np.array([s.sites for s in sheets]).reshape(-1, 2), axis=1)
        families: dict[int, list[SheetSurface]] = {}
        members: dict[int, list[int]] = {}
        self._alone: list[int] = []
        for k, sheet in enumerate(sheets):
            surface = sheet.surface
            if isinstance(surface, SheetSurface) and surface.family is not None:
                families.setdefault(id(surface.family), []).append(surface)
                members.setdefault(id(surface.family), []).append(k)
            else:
                self._alone.append(k)
        self._families = [
            (members[key], SheetSurface.of_family(own)) for key, own in families.items()
        ]

    def ranges(self, points: Array, radius: Array) -> list[Range]:
        """Least and greatest radius of each sheet.

        Args:
            points: (n, 3) vertices.
            radius: (n,) there.
        """
        if not self._sheets:
            return []
        which: Ints = np.repeat(
            np.arange(len(self._sheets)), [len(s.triangles) for s in self._sheets]
        )
        triangles = np.concatenate([s.triangles for s in self._sheets])
        known = np.array([s.known for s in self._sheets])
        corners = points[triangles]
        weights = np.full((3, 3), INNER / 3) + (1 - INNER) * np.eye(3)
        starts = np.einsum("ij,tjk->tik", weights, corners)
        sides = norm(corners - np.roll(corners, 1, axis=1)).max(axis=1)
        for column, sign in ((0, -1.0), (1, 1.0)):
            # nowhere does the radius change faster than the place
            highest = (sign * radius[triangles]).max(axis=1) + sides
            rows = np.flatnonzero(highest > sign * known[which, column])
            rows = rows[self._turns(which[rows], starts[rows])]
            if not len(rows):
                continue
            owner = np.repeat(which[rows], 3)
            reach = np.repeat(sides[rows] / 2, 3)
            best = sign * known[:, column]
            self._climb(owner, starts[rows].reshape(-1, 3), reach, sign, best)
            known[:, column] = sign * best
        return [(float(low), float(high)) for low, high in known]

    def _turns(self, which: Ints, starts: Array) -> Bools:
        """In which triangles (t,) the radius grows to different sides at its corners (t, 3, 3)."""
        placed, good = self._on(np.repeat(which, 3), starts.reshape(-1, 3))
        rise = self._rise(np.repeat(which, 3), placed).reshape(-1, 3, 3)
        speed = norm(rise)
        turned = np.zeros(len(which), dtype=np.bool_)
        for i, j in ((0, 1), (1, 2), (2, 0)):
            turned |= dot(rise[:, i], rise[:, j]) < TURNED * speed[:, i] * speed[:, j]
        steep = speed.max(axis=1) > LEVEL
        return np.asarray(turned & steep & good.reshape(-1, 3).all(axis=1))

    def _on(self, which: Ints, points: Array) -> tuple[Array, Bools]:
        """Points moved onto the surfaces of some sheets, and whether that succeeded."""
        moved, good = np.array(points), np.ones(len(points), dtype=np.bool_)
        for members, family in self._families:
            rows, local = _rows_of(which, members)
            if len(rows):
                moved[rows], good[rows] = family.place(local, points[rows])
        for k in self._alone:
            rows = np.flatnonzero(which == k)
            surface = self._sheets[k].surface
            if not len(rows):
                continue
            if isinstance(surface, (SheetSurface, SelfSheetSurface)):
                moved[rows], good[rows] = surface.try_place(points[rows])
            else:
                moved[rows] = surface.place(points[rows])
        return moved, good

    def _normal(self, which: Ints, points: Array) -> Array:
        normal = np.empty_like(points)
        left = np.ones(len(points), dtype=np.bool_)
        for members, family in self._families:
            rows, local = _rows_of(which, members)
            if len(rows):
                normal[rows], good = family.normal(local, points[rows])
                left[rows[good]] = False
        for k in np.unique(which[left]):
            rows = np.flatnonzero(left & (which == k))
            normal[rows] = self._sheets[k].surface.normal(points[rows])
        return normal

    def _rise(self, which: Ints, points: Array, normal: Array | None = None) -> Array:
        """The gradient h (k, 3) of the radius along the sheets."""
        found = self._queries.nearest(points)
        gradient = (points - found.foot) / np.maximum(found.distance, TINY)[:, None]
        across = self._normal(which, points) if normal is None else normal
        return np.asarray(gradient - dot(gradient, across)[:, None] * across)

    def _in_sheet(self, which: Ints, points: Array, radius: Array) -> Bools:
        """Whether the two sites of the sheet are nearest on its two sides, and none nearer."""
        step = ACROSS * self._size * self._normal(which, points)
        one, other = (self._queries.nearest(points + side * step) for side in (-1, 1))
        found = np.sort([one.site, other.site], axis=0).T
        good = (found == self._sites[which]).all(axis=1)
        own = self._sites[which]
        apart = norm(one.foot - other.foot) > APART * radius
        good &= (own[:, 0] != own[:, 1]) | apart  # an edge's sheet with itself ends at a rim
        reach = radius + SLACK * self._size
        good &= (norm(points - one.foot) <= reach) & (norm(points - other.foot) <= reach)
        return np.asarray(good)

    def _climb(self, which: Ints, points: Array, reach: Array, sign: float, best: Array) -> None:
        """Raise what is known of each sheet to the extrema to which one comes from some points.

        Args:
            which: (m,) the sheets of the points.
            points: (m, 3) starts, close to the sheets.
            reach: (m,) the longest first steps.
            sign: +1 up, -1 down.
            best: greatest value of `sign` times the radius for each sheet; brought up to date.
        """
        points, good = self._on(which, points)
        value = sign * self._queries.depth(points)[1]
        good &= self._in_sheet(which, points, sign * value)
        which, points, reach, value = which[good], points[good], reach[good], value[good]
        for _ in range(STEPS):
            np.maximum.at(best, which, value)
            if not len(which):
                return
            step, gain = self._newton(which, points, sign)
            length = norm(step)
            hope = value + HOPELESS * gain > best[which] + GAIN * self._size
            kept = hope & (gain > GAIN * self._size) & (reach > SPACING * self._size)
            which, points, reach, value = which[kept], points[kept], reach[kept], value[kept]
            step, length = step[kept], length[kept]
            scale = np.minimum(1.0, reach / np.maximum(length, TINY))
            tried, good = self._on(which, points + scale[:, None] * step)
            new = sign * self._queries.depth(tried)[1]
            good &= new >= value
            good &= self._in_sheet(which, tried, sign * new)
            points[good], value[good] = tried[good], new[good]
            reach[~good] = (scale * length)[~good] / 4
        np.maximum.at(best, which, value)

    def _newton(self, which: Ints, points: Array, sign: float) -> tuple[Array, Array]:
        """Steps (k, 3) towards extrema, uphill for `sign` +1, and the gains (k,) to expect."""
        normal = self._normal(which, points)
        one = cross(normal, np.eye(3)[np.argmin(np.abs(normal), axis=1)])
        one /= norm(one)[:, None]
        axes = np.stack([one, cross(normal, one)], axis=1)
        spacing = SPACING * self._size
        rise = sign * np.einsum("kij,kj->ki", axes, self._rise(which, points, normal))
        ahead, _ = self._on(np.repeat(which, 2), (points[:, None] + spacing * axes).reshape(-1, 3))
        beyond = sign * self._rise(np.repeat(which, 2), ahead).reshape(-1, 2, 3)
        hessian = (np.einsum("kij,klj->kil", axes, beyond) - rise[:, :, None]) / spacing
        hessian = (hessian + hessian.transpose(0, 2, 1)) / 2
        bend, ways = np.linalg.eigh(hessian)
        slope = np.einsum("kji,kj->ki", ways, rise)
        part = slope / np.maximum(np.abs(bend), CURVED / self._size)
        step = np.einsum("kji,kj->ki", axes, np.einsum("kij,kj->ki", ways, part))
        return np.asarray(step), np.asarray((slope * part).sum(axis=1))


def _rows_of(which: Ints, members: Sequence[int]) -> tuple[Ints, Ints]:
    """Rows that belong to some sheets (ascending), and to which of them."""
    local = np.searchsorted(members, which)
    local[local == len(members)] = 0
    rows = np.flatnonzero(np.asarray(members)[local] == which)
    return rows, local[rows]
