"""The least and the greatest radius over a sheet or along a line.

Vertices alone do not tell: a flat disc between two spherical caps is thickest where it has none.
On a sheet with unit normal n the radius grows by h = g - (g.n) n, g being the gradient of the
distance to either contact. Where h turns within a triangle an extremum can lie inside; it is
climbed to by Newton's method with the eigenvalues' signs set right, so that each step goes up.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from decomp.complex.model import CurveElement, SurfaceElement
from decomp.medial.sheet_surface import SheetSurface
from decomp.tracing.queries import RegionQueries
from decomp.vectors import Array, Bools, Ints, cross, dot, norm

INNER = 0.02
"""Corners are looked at from so far inside a triangle: at a corner itself other sites are near."""
LEVEL = 1e-10
"""A radius that grows more slowly than this does not grow."""
TURNED = 0.5
"""Cosine between the ways of growth at two corners, below which an extremum may lie between."""
STEPS = 12
AT_REST = 1e-9
"""Steps shorter than this part of the size end the climb: the radius is flat to second order."""
SPACING = 1e-5
"""Of finite differences, as a part of the size."""
ACROSS = 1e-9
"""How far to either side of a sheet its sites are asked for, as a part of the size."""
SLACK = 1e-12
CURVED = 1e-12
SECTIONS = 45
NOISE = 1e-14
"""Radii that differ by less than this part of the size are equal."""
GOLDEN = (5**0.5 - 1) / 2
NEAR_END = 1e-4
"""So far along a chord it is asked whether the radius grows or shrinks from its ends on."""

Range = tuple[float, float]


@dataclass(frozen=True, eq=False)
class SheetRadius:
    """The radius over one sheet.

    Args:
        queries: of the region.
        sites: the sheet's.
        surface: that it lies on.
    """

    queries: RegionQueries
    sites: tuple[int, int]
    surface: SurfaceElement

    def range(self, points: Array, triangles: Ints, radius: Array) -> Range:
        """Least and greatest radius over triangles.

        Args:
            points: (n, 3) vertices.
            triangles: (m, 3).
            radius: (n,) at the vertices.
        """
        least, most = float(radius[triangles].min()), float(radius[triangles].max())
        corners = points[triangles]
        weights = np.full((3, 3), INNER / 3) + (1 - INNER) * np.eye(3)
        starts, placed = self._on(np.einsum("ij,tjk->tik", weights, corners).reshape(-1, 3))
        rise = self._rise(starts).reshape(-1, 3, 3)
        speed = norm(rise)
        turned = np.zeros(len(triangles), dtype=np.bool_)
        for i, j in ((0, 1), (1, 2), (2, 0)):
            turned |= dot(rise[:, i], rise[:, j]) < TURNED * speed[:, i] * speed[:, j]
        turned &= placed.reshape(-1, 3).all(axis=1) & (speed.max(axis=1) > LEVEL)
        sides = norm(corners - np.roll(corners, 1, axis=1)).max(axis=1)
        starts = starts.reshape(-1, 3, 3)
        # nowhere does the radius change faster than the place
        high = turned & (radius[triangles].max(axis=1) + sides > most)
        low = turned & (radius[triangles].min(axis=1) - sides < least)
        for sign, chosen in ((1.0, high), (-1.0, low)):
            if chosen.any():
                reach = np.repeat(sides[chosen] / 2, 3)
                found = self._climb(starts[chosen].reshape(-1, 3), reach, sign)
                if len(found):
                    least, most = min(least, float(found.min())), max(most, float(found.max()))
        return least, most

    def _on(self, points: Array) -> tuple[Array, Bools]:
        """Points moved onto the surface, and whether that succeeded."""
        if isinstance(self.surface, SheetSurface):
            return self.surface.try_place(points)
        return self.surface.place(points), np.ones(len(points), dtype=np.bool_)

    def _rise(self, points: Array) -> Array:
        """The gradient h (k, 3) of the radius along the surface."""
        found = self.queries.nearest(points)
        away = points - found.foot
        gradient = away / np.maximum(found.distance, 1e-300)[:, None]
        normal = self.surface.normal(points)
        return np.asarray(gradient - dot(gradient, normal)[:, None] * normal)

    def _in_sheet(self, points: Array) -> Bools:
        """Whether the two sites of the sheet are nearest on its two sides, and none nearer."""
        step = ACROSS * self.queries.size * self.surface.normal(points)
        one, other = (self.queries.nearest(points + side * step) for side in (-1, 1))
        low, high = sorted(self.sites)
        good = (np.minimum(one.site, other.site) == low) & (
            np.maximum(one.site, other.site) == high
        )
        reach = self.queries.depth(points)[1] + SLACK * self.queries.size
        good &= (norm(points - one.foot) <= reach) & (norm(points - other.foot) <= reach)
        return np.asarray(good)

    def _climb(self, points: Array, reach: Array, sign: float) -> Array:
        """Radii of the extrema (k,) to which one comes from points of the sheet.

        Args:
            points: (m, 3) starts, on the surface.
            reach: (m,) the longest first steps.
            sign: +1 up, -1 down.
        """
        kept = self._in_sheet(points)
        points, reach = points[kept], reach[kept]
        radius = sign * self.queries.depth(points)[1]
        best = radius.copy()
        at = np.arange(len(points))
        for _ in range(STEPS):
            if not len(at):
                break
            step = self._newton(points[at], sign)
            length = norm(step)
            scale = np.minimum(1.0, reach[at] / np.maximum(length, 1e-300))
            tried, good = self._on(points[at] + scale[:, None] * step)
            value = sign * self.queries.depth(tried)[1]
            good &= self._in_sheet(tried) & (value >= best[at])
            points[at[good]], best[at[good]] = tried[good], value[good]
            reach[at[~good]] = (scale * length)[~good] / 4
            at = at[(scale * length > AT_REST * self.queries.size)]
        return np.asarray(sign * best)

    def _newton(self, points: Array, sign: float) -> Array:
        """Steps (k, 3) towards an extremum, uphill for `sign` +1 and downhill for -1."""
        normal = self.surface.normal(points)
        one = cross(normal, np.eye(3)[np.argmin(np.abs(normal), axis=1)])
        one /= norm(one)[:, None]
        axes = np.stack([one, cross(normal, one)], axis=1)
        spacing = SPACING * self.queries.size
        rise = sign * np.einsum("kij,kj->ki", axes, self._rise(points))
        hessian = np.empty((len(points), 2, 2))
        for k in (0, 1):
            ahead = sign * self._rise(self._on(points + spacing * axes[:, k])[0])
            hessian[:, :, k] = (np.einsum("kij,kj->ki", axes, ahead) - rise) / spacing
        hessian = (hessian + hessian.transpose(0, 2, 1)) / 2
        bend, ways = np.linalg.eigh(hessian)
        part = np.einsum("kji,kj->ki", ways, rise) / np.maximum(
            np.abs(bend), CURVED / self.queries.size
        )
        return np.asarray(
            np.einsum("kij,kj->ki", axes.transpose(0, 2, 1), np.einsum("kij,kj->ki", ways, part))
        )


def range_along(queries: RegionQueries, curve: CurveElement, points: Array, radius: Array) -> Range:
    """Least and greatest radius along a polyline of exact vertices.

    Args:
        queries: of the region.
        curve: that the vertices lie on.
        points: (n, 3).
        radius: (n,).
    """
    least, most = float(radius.min()), float(radius.max())
    if most == 0:
        return least, most
    first, way = points[:-1], np.diff(points, axis=0)

    def at(rows: Ints, s: Array) -> Array:
        return queries.depth(curve.place(first[rows] + s[:, None] * way[rows]))[1]

    every = np.arange(len(first))
    starts = at(every, np.full(len(every), NEAR_END)) - radius[:-1]
    ends = at(every, np.full(len(every), 1 - NEAR_END)) - radius[1:]
    for sign in (1.0, -1.0):
        turning = (sign * starts > NOISE * queries.size) & (sign * ends > NOISE * queries.size)
        rows = np.flatnonzero(turning)
        if len(rows):
            found = _golden(at, rows, sign)
            least, most = min(least, float(found.min())), max(most, float(found.max()))
    return least, most


def _golden(at: Callable[[Ints, Array], Array], rows: Ints, sign: float) -> Array:
    """Extrema (k,) of functions of s from 0 to 1, by golden sections."""
    low, high = np.zeros(len(rows)), np.ones(len(rows))
    one, other = high - GOLDEN * (high - low), low + GOLDEN * (high - low)
    f, g = sign * at(rows, one), sign * at(rows, other)
    for _ in range(SECTIONS):
        left = f > g
        low, high = np.where(left, low, one), np.where(left, other, high)
        new = np.where(left, high - GOLDEN * (high - low), low + GOLDEN * (high - low))
        value = sign * at(rows, new)
        one, other = np.where(left, new, other), np.where(left, one, new)
        f, g = np.where(left, value, g), np.where(left, f, value)
    return np.asarray(sign * np.maximum(f, g))
