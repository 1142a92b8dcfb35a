"""General intersection curve of two carriers, known by exact samples and Newton's method.

Between two neighbouring samples g(t) is the cubic Hermite curve through them with their exact
tangents. The point x(t) solves a(x) = 0, b(x) = 0, (x - g).g' = 0. Differentiating these three
equations gives x' = m d with d the unit vector along n_a x n_b and

    m = (g'.g' - (x - g).g'') / (d.g').
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import ClassVar

import numpy as np

from decomp.carriers import Carrier
from decomp.curves.base import Curve
from decomp.curves.newton import cross_direction, onto_pair
from decomp.tolerance import LAST_STEP, SAME_PARAMETER, SINGULAR
from decomp.vectors import Array, Bools, Ints, dot, norm

STRAYED = 0.2
"""Newton's method moves no point by more than this part of its distance from a singular end."""
NO_TANGENT = 1e-5
"""Sine of the angle between the normals below which they tell no tangent: chords do."""


@dataclass(frozen=True, eq=False)
class TracedCurve(Curve):
    """Part of the intersection of `a` and `b`; t is the cumulative chord length.

    Attributes:
        samples: points (k, 3) on both carriers in order, the first not repeated if closed;
            neighbours turn by a few degrees at most.
        closed: whether the last sample is joined to the first.
        tangents: unit tangents (k, 3); by default n_a x n_b, at singular ends extrapolated.
        singular: whether the carriers touch, or an apex lies, at the first and last sample.
    """

    a: Carrier
    b: Carrier
    samples: Array
    closed: bool = field(default=False, kw_only=True)
    tangents: Array | None = None
    singular: tuple[bool, bool] = (False, False)
    knots: Array = field(init=False)

    kind: ClassVar[str] = "curve"

    def __post_init__(self) -> None:
        points = np.concatenate([self.samples, self.samples[:1]]) if self.closed else self.samples
        chords = norm(np.diff(points, axis=0))
        knots = np.concatenate([[0.0], np.cumsum(chords)])
        tangents = self.tangents
        if tangents is None:
            tangents = sample_tangents(self.a, self.b, self.samples, self.closed, self.singular)
        if self.closed:
            tangents = np.concatenate([tangents, tangents[:1]])
        object.__setattr__(self, "samples", points)
        object.__setattr__(self, "tangents", tangents)
        object.__setattr__(self, "knots", knots)
        object.__setattr__(self, "domain", (0.0, float(knots[-1])))
        object.__setattr__(self, "kind", _kind(self.a, self.b))

    def point(self, t: Array) -> Array:
        t = self.wrapped(np.asarray(t, dtype=np.float64))
        return self._solve(t)[0]

    def derivative(self, t: Array) -> Array:
        t = self.wrapped(np.asarray(t, dtype=np.float64))
        x, g, g1, g2 = self._solve(t)
        d, size = cross_direction(self.a, self.b, x)
        sharp = (size < SINGULAR) | self._at_singular_end(t)
        d = np.where(sharp[..., None], g1 / norm(g1)[..., None], d)
        m = (dot(g1, g1) - dot(x - g, g2)) / dot(d, g1)
        return np.asarray(m[..., None] * d)

    def parameter(self, p: Array) -> Array:
        p = np.asarray(p, dtype=np.float64)
        flat = p.reshape(-1, 3)
        t = np.concatenate([self._nearest(block) for block in _blocks(flat, len(self.knots))])
        span = float(np.diff(self.knots).max())
        for _ in range(20):
            g, g1, g2 = self._guess(self.wrapped(t))
            away = flat - g
            slope = np.maximum(dot(g1, g1) - dot(away, g2), 0.1)
            step = np.clip(dot(away, g1) / slope, -span, span)
            t = self.wrapped(t + step)
            if float(np.max(np.abs(step), initial=0.0)) < LAST_STEP * self.period:
                break
        return t.reshape(p.shape[:-1])

    def bounding_ball(self) -> tuple[Array, float]:
        low, high = self.samples.min(axis=0), self.samples.max(axis=0)
        centre = (low + high) / 2
        bulge = 0.05 * float(np.diff(self.knots).max())
        return centre, float(norm(self.samples - centre).max()) + bulge

    def _solve(self, t: Array) -> tuple[Array, Array, Array, Array]:
        g, g1, g2 = self._guess(t)
        x = onto_pair(self.a, self.b, g, g1 / norm(g1)[..., None])
        if any(self.singular):
            astray = self._is_astray(t, x, g)
            x = np.where(astray[..., None], self._between(g), x)
        return x, g, g1, g2

    def _is_astray(self, t: Array, x: Array, g: Array) -> Bools:
        """Whether Newton's method led from g to another branch x, as it may beside a node."""
        ends = [
            abs(t - end) for sharp, end in zip(self.singular, self.domain, strict=True) if sharp
        ]
        return np.asarray(~(norm(x - g) <= STRAYED * np.min(ends, axis=0)))

    def _between(self, p: Array) -> Array:
        """Points as near to both carriers as they come to each other there."""
        for _ in range(2):
            p = (self.a.foot(p) + self.b.foot(p)) / 2
        return p

    def _at_singular_end(self, t: Array) -> Bools:
        near = SAME_PARAMETER * self.period
        first, last = self.singular
        return np.asarray(
            (first & (t - self.domain[0] < near)) | (last & (self.domain[1] - t < near))
        )

    def _guess(self, t: Array) -> tuple[Array, Array, Array]:
        """The Hermite cubic g with its first and second derivative."""
        i = np.clip(np.searchsorted(self.knots, t, side="right") - 1, 0, len(self.knots) - 2)
        return self._hermite(i, t)

    def _hermite(self, i: Ints, t: Array) -> tuple[Array, Array, Array]:
        assert self.tangents is not None
        h = (self.knots[i + 1] - self.knots[i])[..., None]
        s = (t - self.knots[i])[..., None] / h
        p, q = self.samples[i], self.samples[i + 1]
        u, v = h * self.tangents[i], h * self.tangents[i + 1]
        # p + s u + s^2 c + s^3 d
        c = 3 * (q - p) - 2 * u - v
        d = u + v - 2 * (q - p)
        return (
            p + s * (u + s * (c + s * d)),
            (u + s * (2 * c + 3 * s * d)) / h,
            (2 * c + 6 * s * d) / h**2,
        )

    def _nearest(self, p: Array) -> Array:
        """Parameters of the nearest points on the polygon of samples."""
        start, chord = self.samples[:-1], np.diff(self.samples, axis=0)
        square = dot(chord, chord)
        s = dot(p[:, None] - start, chord) / square
        s = np.clip(s, 0.0, 1.0)
        gap = norm(p[:, None] - start - s[..., None] * chord)
        i = np.argmin(gap, axis=1)
        rows = np.arange(len(p))
        return np.asarray(self.knots[i] + s[rows, i] * (self.knots[i + 1] - self.knots[i]))


def _kind(a: Carrier, b: Carrier) -> str:
    """What the curve is called: conics too long for closed form are traced, but stay conics."""
    for plane, other in ((a, b), (b, a)):
        if plane.flat:
            return other.section_kind(plane.normal(plane.place))
    return "curve"


def sample_tangents(
    a: Carrier,
    b: Carrier,
    samples: Array,
    closed: bool,
    singular: tuple[bool, bool] = (False, False),
) -> Array:
    """Unit tangents at samples of an intersection curve, pointing onwards.

    n_a x n_b where the carriers cross; at singular samples the derivative of the parabola
    through three neighbours.
    """
    d, size = cross_direction(a, b, samples)
    points = (
        np.concatenate([samples[-1:], samples, samples[:1]])
        if closed
        else np.concatenate([_beyond(samples), samples, _beyond(samples[::-1])])
    )
    before, after = points[1:-1] - points[:-2], points[2:] - points[1:-1]
    hb, ha = norm(before)[:, None], norm(after)[:, None]
    rough = before / hb * ha + after / ha * hb
    rough = rough / norm(rough)[:, None]
    size[[0, -1]] = np.where(singular, 0.0, size[[0, -1]])
    sign = np.where(dot(d, rough) < 0, -1.0, 1.0)[:, None]
    return np.where((size > NO_TANGENT)[:, None], sign * d, rough)


def _beyond(samples: Array) -> Array:
    """A point before the first sample, on the parabola through the first three."""
    if len(samples) < 3:
        return np.asarray(2 * samples[:1] - samples[1:2])
    h = np.concatenate([[0.0], np.cumsum(norm(np.diff(samples[:3], axis=0)))])
    t = -h[1]
    i, j = np.array([1, 2, 0]), np.array([2, 0, 1])
    weights = (t - h[i]) * (t - h[j]) / (h - h[i]) / (h - h[j])
    return np.asarray(weights @ samples[:3])[None]


def _blocks(p: Array, k: int) -> list[Array]:
    """Split p so that a block times k stays small."""
    return np.array_split(p, max(1, len(p) * k // 200_000))
