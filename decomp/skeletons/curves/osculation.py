"""Spheres that osculate a curved reentrant edge, by their place in the edge's footprint.

With K the edge's curvature vector at its point e, the ball that touches there with its centre in
the unit direction d across the edge meets the edge in second order if its radius is 1 / (K . d). It
does in third order, as osculating spheres do, if K' . d = 0 too, with K' the derivative along the
edge. There two feet of larger balls close by run together.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np

from decomp.boundary.topology import Edge, RegionBoundary
from decomp.curves.newton import cross_direction, onto_pair
from decomp.skeletons.seams.edge_seeds import EdgeFan
from decomp.tolerance import TINY
from decomp.vectors import Array, dot, norm

STENCIL = np.array([-1.0, 9.0, -45.0, 45.0, -9.0, 1.0]) / 60
STEPS = np.array([-3.0, -2.0, -1.0, 1.0, 2.0, 3.0])
STEP = 1e-2
"""Step of the differences, as a part of the least radius of curvature along the edge."""
LONGEST = 1e-3
"""The longest step, as a part of the region's size."""
ROUNDS = 20
DELTA = 1e-4
AT_REST = 1e-14
STRAIGHT = 1e-12
"""An edge that bends less, on the scale of the size, is straight."""
WAY = 0.1
"""The longest step of a secant."""


class Osculation:
    """The osculating spheres of one edge.

    Spots (k, 2) are parts of the edge's length of parameter and of the angle between its faces.
    """

    def __init__(self, boundary: RegionBoundary, edge: Edge) -> None:
        self.edge, self._size = edge, boundary.diagonal
        self._fan = EdgeFan(boundary, edge)
        self._one, self._other = (boundary.carriers[k] for k in edge.carriers)

    def place(self, spots: Array) -> tuple[Array, Array]:
        """Points of the edge and directions (k, 3) across it."""
        return self._fan.place(spots)

    def tangents(self, spots: Array) -> Array:
        """Unit tangents (k, 3) of the edge, in the sense of its parameter."""
        feet = self.place(spots)[0]
        return np.asarray(self._sense * cross_direction(self._one, self._other, feet)[0])

    def balls(self, spots: Array) -> tuple[Array, Array, Array, Array]:
        """Feet, directions (k, 3), radii (k,) and centres of curvature (k, 3) in them.

        Where the edge bends away from a direction the radius is infinite.
        """
        feet, ways = self.place(spots)
        bend = dot(self._curvature(feet), ways)
        radius = np.where(bend > STRAIGHT / self._size, 1 / np.where(bend > 0, bend, 1.0), np.inf)
        reach = np.where(np.isfinite(radius), radius, 0.0)
        return feet, ways, radius, feet + reach[:, None] * ways

    def miss(self, spots: Array) -> Array:
        """K' . d (k,), made free of units: zero for osculating spheres."""
        feet, ways = self.place(spots)
        return np.asarray(dot(self._change(feet), ways) * self._scale**2)

    def onto(self, spots: Array, across: Array) -> Array:
        """Spots (k, 2) moved along directions (k, 2) to where a sphere osculates, by secants."""
        reach = np.zeros(len(spots))
        slope = self.slope(spots, across)
        value = self.miss(spots)
        for _ in range(ROUNDS):
            step = np.clip(-value / slope, -WAY, WAY)
            reach = reach + step
            if float(np.abs(step).max(initial=0.0)) <= AT_REST:
                break
            before, value = value, self.miss(spots + reach[:, None] * across)
            safe = np.abs(step) > AT_REST
            secant = (value - before) / np.where(safe, step, 1.0)
            slope = np.where(safe & (secant * slope > 0), secant, slope)
        return np.asarray(spots + reach[:, None] * across)

    def slope(self, spots: Array, across: Array) -> Array:
        """How K' . d changes along directions (k, 2), by differences."""
        both = np.concatenate([spots + DELTA * across, spots - DELTA * across])
        ahead, behind = np.split(self.miss(both), 2)
        found = (ahead - behind) / (2 * DELTA)
        return np.where(found == 0, TINY, found)

    @cached_property
    def _scale(self) -> float:
        """The least radius of curvature at the edge's samples, at most the region's size."""
        most = float(norm(self._curvature(self.edge.samples[1:-1])).max())
        return min(1 / most, self._size) if np.isfinite(most) and most > 0 else self._size

    def _change(self, feet: Array) -> Array:
        """The derivative (k, 3) of the curvature vector along the edge, by differences.

        Its part along the edge does not matter here. Points a step ahead are taken in planes
        across the tangent, so that the steps are even on both sides.
        """
        step = min(STEP * self._scale, LONGEST * self._size)
        tangent = cross_direction(self._one, self._other, feet)[0]
        near = feet + step * STEPS[:, None, None] * tangent
        ahead = onto_pair(self._one, self._other, near, tangent)
        return np.asarray(np.tensordot(STENCIL, self._curvature(ahead), axes=1) / step)

    @cached_property
    def _sense(self) -> float:
        """Whether the product of the carriers' normals runs with the edge's parameter: 1 or -1."""
        middle = np.array([[0.5, 0.5]])
        curve, feet = self.edge.curve, self.place(middle)[0]
        along = curve.derivative(curve.parameter(feet))
        return float(np.sign(dot(along, cross_direction(self._one, self._other, feet)[0])[0]))

    def _curvature(self, points: Array) -> Array:
        """The curvature vector (..., 3) at points, from the normal curvatures of the carriers."""
        tangent = cross_direction(self._one, self._other, points)[0]
        na, nb = self._one.normal(points), self._other.normal(points)
        ha = -self._one.normal_curvature(points, tangent)
        hb = -self._other.normal_curvature(points, tangent)
        c = dot(na, nb)
        with np.errstate(divide="ignore", invalid="ignore"):
            a, b = (ha - c * hb) / (1 - c**2), (hb - c * ha) / (1 - c**2)
        return np.asarray(a[..., None] * na + b[..., None] * nb)
