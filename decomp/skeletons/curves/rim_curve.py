"""A rim of a sheet that an edge has with itself, as a curve of a complex."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.interpolate import BSpline, make_interp_spline  # type: ignore[import-untyped]

from decomp.skeletons.curves.osculation import Osculation
from decomp.tolerance import TINY
from decomp.vectors import Array, dot, norm

APPROACHES = 4
CORRECTIONS = 12
AT_REST = 1e-12
"""Steps along a rim towards a foot, and with what part of its length they end."""


@dataclass(frozen=True, eq=False)
class RimCurve:
    """The centres of an edge's osculating spheres along a part of its footprint.

    Between the known spots others are interpolated by a spline and then made exact.

    Args:
        spheres: of the edge.
        spots: known spots (k, 2) in order, at least 6.
        points: the centres (k, 3) over them.
    """

    spheres: Osculation
    spots: Array
    points: Array

    @cached_property
    def feet(self) -> Array:
        """The edge's points (k, 3) over the known spots."""
        return self.spheres.place(self.spots)[0]

    def place(self, points: Array) -> Array:
        """Move points (k, 3) to their feet on the rim."""
        along, exact = self._along(points), points
        for _ in range(CORRECTIONS):
            spots, step = self._spline(along)[:, :2], self._spline(along, 1)
            across = step[:, 1::-1] * np.array([-1.0, 1.0])
            across = across / np.maximum(norm(across), TINY)[:, None]
            exact = self.spheres.balls(self.spheres.onto(spots, across))[3]
            move = dot(points - exact, step[:, 2:5]) / dot(step[:, 2:5], step[:, 2:5])
            along = np.clip(along + move, 0.0, self._chords[-1])
            if float(np.abs(move).max(initial=0.0)) <= AT_REST * self._chords[-1]:
                break
        ends = np.array([0.0, self._chords[-1]])
        for stop, known in zip(ends, self.points[[0, -1]], strict=True):
            exact[along == stop] = known
        return exact

    def nearest(self, points: Array) -> tuple[Array, Array]:
        """The feet on the rim of points (k, 3), and the edge's unit tangents (k, 3) over them.

        Both are interpolated.
        """
        found = self._spline(self._along(points))
        return found[:, 2:5], found[:, 5:] / norm(found[:, 5:])[:, None]

    def _along(self, points: Array) -> Array:
        """The parameters (k,) of the feet of points (k, 3): the length of chords before them."""
        start, chord = self.points[:-1], np.diff(self.points, axis=0)
        square = np.maximum(dot(chord, chord), TINY)
        share = np.clip(dot(points[:, None] - start, chord) / square, 0.0, 1.0)
        k = np.argmin(norm(points[:, None] - start - share[..., None] * chord), axis=1)
        part = share[np.arange(len(points)), k]
        along = self._chords[k] + part * (self._chords[k + 1] - self._chords[k])
        for _ in range(APPROACHES):
            way = self._spline(along, 1)[:, 2:5]
            move = dot(points - self._spline(along)[:, 2:5], way) / dot(way, way)
            along = np.clip(along + move, 0.0, self._chords[-1])
        return np.asarray(along)

    @cached_property
    def _chords(self) -> Array:
        lengths = norm(np.diff(self.points, axis=0))
        return np.concatenate([[0.0], np.cumsum(lengths)])

    @cached_property
    def _spline(self) -> BSpline:
        """Spots, centres and tangents (8,) over the length of chords."""
        values = np.concatenate(
            [self.spots, self.points, self.spheres.tangents(self.spots)], axis=1
        )
        return make_interp_spline(self._chords, values, k=5)
