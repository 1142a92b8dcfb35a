"""The places of a curved edge that are nearest to a point, one for each stretch of the edge."""

from __future__ import annotations

import numpy as np

from decomp.boundary.topology import Edge
from decomp.vectors import Array, Bools, Ints, dot, norm

SAMPLES = 1024
"""Places along an edge that are closer together than two feet of one ball have to be."""
HALVINGS = 40
CLOSE = 3
"""Samples beside a place that is nearest up to rounding or sampling."""
DEEP = 0.1
"""Places that are farther than the nearest by this part of the distance do not count."""
BLOCK = 512


class EdgeWells:
    """Looks for the nearest places of an edge.

    Attributes:
        t: parameters (s,) of the samples.
        points: the samples (s, 3).
        apart: a little more than the distance of neighbouring samples.
    """

    def __init__(self, edge: Edge) -> None:
        self._edge = edge
        count = SAMPLES if edge.closed else SAMPLES + 1
        self.t: Array = edge.start + (edge.end - edge.start) * np.arange(count) / SAMPLES
        self.points: Array = edge.curve.point(edge.curve.wrapped(self.t))
        self.apart = 1.5 * float(norm(np.diff(self.points, axis=0)).max())

    def _wells(self, points: Array) -> tuple[Ints, Ints]:
        """Samples that are nearer to points (k, 3) than their neighbours, and nearly the nearest.

        Returns:
            the point (m,) of each, ascending, and its number (m,) among the samples.
        """
        none = np.empty(0, dtype=np.int64)
        rows, samples = [none], [none]
        for start in range(0, len(points), BLOCK):
            away = norm(points[start : start + BLOCK, None] - self.points)
            near = away <= away.min(axis=1)[:, None] + self.apart
            row, sample = np.nonzero(self._bottoms(away) & near)
            rows.append(row + start)
            samples.append(sample)
        return np.concatenate(rows), np.concatenate(samples)

    def _bottoms(self, away: Array) -> Bools:
        """Where distances (k, s) from the samples are less than at their neighbours."""
        before, after = np.roll(away, 1, axis=1), np.roll(away, -1, axis=1)
        if not self._edge.closed:
            before[:, 0], after[:, -1] = np.inf, np.inf
        return np.asarray((away <= before) & (away < after))

    @property
    def _spacing(self) -> float:
        """Of the samples' parameters."""
        return float(self.t[1] - self.t[0])

    def bottom(self, points: Array, sample: Ints) -> Array:
        """Parameters (k,) of the places nearest to points (k, 3) beside samples (k,)."""
        low, high = self.t[sample] - self._spacing, self.t[sample] + self._spacing
        if not self._edge.closed:
            low, high = np.maximum(low, self.t[0]), np.minimum(high, self.t[-1])
        curve = self._edge.curve
        for _ in range(HALVINGS):
            middle = (low + high) / 2
            t = curve.wrapped(middle)
            ahead = dot(points - curve.point(t), curve.derivative(t)) > 0
            low, high = np.where(ahead, middle, low), np.where(ahead, high, middle)
        return np.asarray((low + high) / 2)

    def feet(self, points: Array, slack: float) -> list[Array]:
        """For each of points (k, 3) the parameters of all its nearest places on the edge.

        Distances that differ by less than `slack` count as equal.
        """
        row, sample = self._wells(points)
        at, curve = points[row], self._edge.curve
        t = self.bottom(at, sample)
        distance = norm(curve.point(curve.wrapped(t)) - at)
        result = []
        for k in range(len(points)):
            own = np.flatnonzero(row == k)
            near = own[distance[own] <= distance[own].min() + slack]
            result.append(self._different(np.sort(t[near]), 2 * self._spacing))
        return result

    def near(self, points: Array) -> tuple[Ints, Array]:
        """The places inside the edge that may be nearest to points (k, 3).

        Returns:
            the point (m,) of each, and the place (m, 3).
        """
        row, sample = self._wells(points)
        if not self._edge.closed:
            inner = (sample > 0) & (sample < len(self.t) - 1)
            row, sample = row[inner], sample[inner]
        t = self.bottom(points[row], sample)
        return row, self._edge.curve.point(self._edge.curve.wrapped(t))

    def basins(self, points: Array, t: Array) -> Ints:
        """The samples (k, 2) between which the distance from points (k, 3) falls to places t (k,).

        They are the nearest of the farthest places on either side; ranges may pass the last sample.
        """
        away = norm(points[:, None] - self.points)
        count = len(self.t)
        start = np.clip(np.round((t - self.t[0]) / (self.t[1] - self.t[0])), 0, None)
        middle = np.mod(start.astype(np.int64), count)
        result = np.empty((len(points), 2), dtype=np.int64)
        for column, side in enumerate((-1, 1)):
            steps = side * np.arange(count if self._edge.closed else count + 1)
            order = middle[:, None] + steps
            if not self._edge.closed:
                order = np.clip(order, 0, count - 1)
            along = np.take_along_axis(away, np.mod(order, count), axis=1)
            falls = np.diff(along, axis=1) < 0
            # close to the place itself the distance can still fall
            falls[:, :CLOSE] = False
            falls[:, -1] = True
            result[:, column] = order[np.arange(len(points)), np.argmax(falls, axis=1)]
        return result

    def deepest(self, points: Array, basins: Ints) -> Ints:
        """The samples (k,) nearest to points (k, 3) in their basins (k, 2), and down from them."""
        count, result = len(self.t), np.empty(len(points), dtype=np.int64)
        for start in range(0, len(points), BLOCK):
            rows = slice(start, start + BLOCK)
            away = norm(points[rows, None] - self.points)
            low, high = basins[rows, 0], basins[rows, 1]
            ahead = np.mod(np.arange(count) - low[:, None], count)
            inside = ahead <= (high - low)[:, None]
            deep = away <= (1 + DEEP) * away.min(axis=1)[:, None]
            lowest = inside & deep & self._bottoms(away)
            # a place at the basin's end counts only where the distance has no minimum inside
            inside = np.where(lowest.any(axis=1)[:, None], lowest, inside)
            at = np.argmin(np.where(inside, away, np.inf), axis=1)
            every = np.arange(len(at))
            for _ in range(count):
                around = np.stack([at - 1, at, at + 1], axis=1)
                around = (
                    np.mod(around, count) if self._edge.closed else np.clip(around, 0, count - 1)
                )
                best = np.argmin(away[every[:, None], around], axis=1)
                if (around[every, best] == at).all():
                    break
                at = around[every, best]
            result[rows] = at
        return result

    def _different(self, t: Array, apart: float) -> Array:
        """Sorted parameters without those that are one with their neighbours."""
        if self._edge.closed:
            period = self._edge.end - self._edge.start
            t = np.sort(self._edge.start + np.mod(t - self._edge.start, period))
        if len(t) < 2:
            return t
        kept = np.concatenate([[True], np.diff(t) > apart])
        if self._edge.closed and t[0] + period - t[-1] <= apart:
            kept[0] = int(kept.sum()) == 1
        return np.asarray(t[kept])

    def gap(self, one: Array, other: Array) -> Array:
        """The signed way (...) along the edge from parameters to others, the shorter one."""
        step = other - one
        if self._edge.closed:
            period = self._edge.end - self._edge.start
            step = step - period * np.round(step / period)
        return np.asarray(step)
