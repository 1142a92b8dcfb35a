"""Edge curves as sites: lines and circles by closed form, others by their nearest parameter."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property

import numpy as np

from decomp.curves.base import Curve
from decomp.curves.circle import Circle
from decomp.curves.line import Line
from decomp.vectors import Array, cross, dot, norm
from decomp.voronoi.bending import about_curve, about_point
from decomp.voronoi.exact import Vector, exact, exact_vector
from decomp.voronoi.sites import CylinderSite, TorusSite, VoronoiSite

FOOT_SAMPLES = 256
NEWTON_ON_CURVE = 12
DIFFERENCES = 1e-5
"""Of differences, in units of the domain."""
SLANT = 1e-6
"""Cosine of the angle with the curve above which a point's foot is an end of it."""


@dataclass(frozen=True, eq=False)
class CurveSite(VoronoiSite):
    """Any smooth curve, whose ends (if any) are its nearest points where no normal meets it."""

    curve: Curve

    @property
    def name(self) -> str:
        return self.curve.kind

    @property
    def reference(self) -> Vector:
        return exact_vector(self.curve.bounding_ball()[0], "a curve's centre")

    @property
    def size(self) -> float:
        return float(self.curve.bounding_ball()[1])

    @property
    def two_sided(self) -> bool:
        return False

    def signed_distance(self, p: Array) -> Array:
        return norm(p - self.foot(p))

    def foot(self, p: Array) -> Array:
        """The nearest of `FOOT_SAMPLES` points, then the parameter by Gauss and Newton."""
        flat = np.asarray(p, dtype=np.float64).reshape(-1, 3)
        t, known = self._samples
        gap = ((flat[:, None] - known[None]) ** 2).sum(axis=2)
        at = t[np.argmin(gap, axis=1)]
        best = self.curve.point(at)
        step_limit = 2 * self.curve.period / FOOT_SAMPLES
        for _ in range(NEWTON_ON_CURVE):
            first, second = self.curve.derivative(at), self._second(at)
            away = self.curve.point(at) - flat
            slope = dot(first, first) + dot(away, second)
            slope = np.where(slope > 0, slope, dot(first, first))
            step = np.clip(dot(away, first) / slope, -step_limit, step_limit)
            at = self.curve.wrapped(at - step)
        found = self.curve.point(at)
        nearer = norm(flat - found) <= norm(flat - best)
        return np.where(nearer[:, None], found, best).reshape(np.shape(p))

    def hessian(self, p: Array) -> Array:
        """Where an end of the curve is nearest it is that of the distance from a point."""
        q = self.foot(p)
        t = self.curve.parameter(q)
        first = self.curve.derivative(t)
        speed = norm(first)[..., None]
        tangent, second = first / speed, self._second(t)
        bend = (second - dot(second, tangent)[..., None] * tangent) / speed**2
        away = p - q
        slant = np.abs(dot(away, tangent)) > SLANT * norm(away)
        return np.where(slant[..., None, None], about_point(away), about_curve(away, tangent, bend))

    def _second(self, t: Array) -> Array:
        """Second derivatives (..., 3), as differences of the first."""
        h = self.curve.period * DIFFERENCES
        ahead, behind = (self.curve.wrapped(t + s * h) for s in (1.0, -1.0))
        span = np.full_like(t, 2 * h) if self.curve.closed else ahead - behind
        change = self.curve.derivative(ahead) - self.curve.derivative(behind)
        return np.asarray(change / span[..., None])

    @cached_property
    def _samples(self) -> tuple[Array, Array]:
        t = np.linspace(*self.curve.domain, FOOT_SAMPLES + 1)
        return t, self.curve.point(t)


def of_curve(curve: Curve) -> VoronoiSite:
    """The site of an edge curve: the whole line of a segment, the whole circle."""
    if isinstance(curve, Line):
        return CylinderSite(_given(curve.origin), _given(curve.direction), Fraction(0))
    if isinstance(curve, Circle):
        axis = _given(cross(curve.x, curve.y))
        return TorusSite(_given(curve.centre), axis, exact(curve.radius), Fraction(0))
    return CurveSite(curve)


def _given(values: Array) -> Vector:
    return exact_vector(values, "a curve's parameter")
