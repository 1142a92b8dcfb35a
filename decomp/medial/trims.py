"""Trim curves: the centres of the maximal balls over a curve of boundary normals.

Along a normal curve the ball's far contact changes at certain parameters: with a jump of the far
foot where the trim crosses a seam, without one where the far foot passes to a neighbouring site.
Between two changes lies one piece of trim.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from decomp.errors import GeometryError
from decomp.medial.incidence import Incidence
from decomp.medial.normal_curves import NormalCurve
from decomp.medial.reflexive import reflexive_gap
from decomp.sites import SiteIndex
from decomp.sites.site import SiteKind
from decomp.tracing.balls import inscribed_balls
from decomp.tracing.fields import site_fields
from decomp.vectors import Array, Bools, Ints, dot, norm, place

SAMPLES = 96
NEAREST_END = 1e-5
"""First sample beside the end of a normal curve, as a part of its length."""
NO_LENGTH = 1e-8
"""Pieces shorter than this part of their normal curve are points."""
HALVINGS = 60
STEPS = 40
LOCUS = 1e-8
"""Centres nearer to a reflexive locus than this part of the size lie on it."""

Contact = tuple[int, ...]


@dataclass(frozen=True, eq=False)
class TrimPiece:
    """A part of a trim curve with one far contact.

    Args:
        over: the normal curve.
        start, end: its parameters.
        far: the far contact's sites; the piece lies on a reflexive locus if they are those of
            the near one (the ball's centre is a centre of curvature).
        far_feet: the far feet (2, 3) beside start and end, to search them from.
    """

    over: NormalCurve
    start: float
    end: float
    far: Contact
    far_feet: Array


@dataclass(frozen=True, eq=False)
class _Sample:
    s: float
    far: Contact
    foot: Array
    radius: float


class TrimScanner:
    """Finds the pieces of all trims of one region."""

    def __init__(self, index: SiteIndex, incidence: Incidence) -> None:
        self._index, self._incidence = index, incidence
        self._size = incidence.boundary.diagonal

    def pieces(self, curves: Sequence[NormalCurve]) -> list[TrimPiece]:
        """The pieces over some normal curves, in their order."""
        found = []
        for curve in curves:
            found.extend(self._pieces_over(curve))
        return found

    def _pieces_over(self, curve: NormalCurve) -> list[TrimPiece]:
        length = curve.end - curve.start
        inner = np.linspace(0, 1, SAMPLES + 1)[1:-1]
        near = np.geomspace(NEAREST_END, inner[0], 12)[:-1]
        parts = (
            np.concatenate([[0.0], inner])
            if curve.closed
            else np.concatenate([near, inner, 1 - near[::-1]])
        )
        samples = self._at(curve, curve.start + length * parts)
        if curve.closed:
            first = samples[0]
            samples.append(_Sample(curve.end, first.far, first.foot, first.radius))
        cuts: list[tuple[_Sample, _Sample]] = []
        for low, high in itertools.pairwise(samples):
            self._changes(curve, low, high, cuts)
        bounds = [self._change(curve, low, high) for low, high in cuts]
        return self._between(curve, samples, cuts, bounds)

    def _between(
        self,
        curve: NormalCurve,
        samples: list[_Sample],
        cuts: list[tuple[_Sample, _Sample]],
        bounds: list[float],
    ) -> list[TrimPiece]:
        first, last = samples[0], samples[-1]
        if not cuts:
            feet = np.array([first.foot, last.foot])
            return [TrimPiece(curve, curve.start, curve.end, first.far, feet)]
        pieces = []
        starts = [first, *(high for _, high in cuts)]
        ends = [*(low for low, _ in cuts), last]
        edges = [curve.start, *bounds, curve.end]
        for k, (a, b) in enumerate(zip(starts, ends, strict=True)):
            # several changes in one point leave pieces without length
            if edges[k + 1] - edges[k] <= NO_LENGTH * (curve.end - curve.start):
                continue
            feet = np.array([a.foot, b.foot])
            pieces.append(TrimPiece(curve, edges[k], edges[k + 1], a.far, feet))
        if curve.closed and len(pieces) > 1:
            # the parameter's own start is no end of a piece
            head, tail = pieces[0], pieces.pop()
            feet = np.array([tail.far_feet[0], head.far_feet[1]])
            pieces[0] = TrimPiece(
                curve, tail.start - (curve.end - curve.start), head.end, head.far, feet
            )
        return pieces

    def _at(self, curve: NormalCurve, s: Array) -> list[_Sample]:
        feet, inward = curve.feet(s), curve.directions(s)
        incidence = self._incidence
        boundary, sites = incidence.boundary, incidence.sites
        balls = inscribed_balls(self._index, boundary, incidence.region, feet, inward)
        # the foot that stopped the ball is that of its last centre but one
        known = np.flatnonzero(balls.site >= 0)
        field = site_fields(
            boundary, sites, balls.site[known], balls.centre[known], balls.foot[known]
        )
        hits = np.array(balls.foot)
        hits[known] = field.foot
        own = on_locus(incidence, curve.sites, balls.centre)
        result = []
        for k in range(len(s)):
            far: Contact
            if own[k] or balls.site[k] < 0 or float(norm(hits[k] - feet[k])) <= 1e-7 * self._size:
                far = tuple(sorted(curve.sites))
            else:
                away = (balls.centre[k] - hits[k]) / float(norm(balls.centre[k] - hits[k]))
                far = incidence.touched(int(balls.site[k]), hits[k], away)
            result.append(_Sample(float(s[k]), far, hits[k], float(balls.radius[k])))
        return result

    def _changes(
        self,
        curve: NormalCurve,
        low: _Sample,
        high: _Sample,
        found: list[tuple[_Sample, _Sample]],
    ) -> None:
        """Append the narrowest intervals in which the far contact changes."""
        stack = [(low, high, 0)]
        while stack:
            a, b, depth = stack.pop()
            if a.far == b.far:
                continue
            if depth >= HALVINGS or b.s - a.s <= 1e-15 * (abs(a.s) + abs(b.s)):
                found.append((a, b))
                continue
            middle = self._at(curve, np.array([(a.s + b.s) / 2]))[0]
            # a contact that holds both is the change itself
            if middle.far not in (a.far, b.far) and set(a.far) | set(b.far) <= set(middle.far):
                found.append((a, b))
                continue
            stack.append((middle, b, depth + 1))
            stack.append((a, middle, depth + 1))
        found.sort(key=lambda pair: pair[0].s)

    def _change(self, curve: NormalCurve, low: _Sample, high: _Sample) -> float:
        """The exact parameter at which the far contact changes from `low` to `high`."""
        own = tuple(sorted(curve.sites))
        jumps = float(norm(low.foot - high.foot)) > 1e-5 * self._size
        if jumps and own not in (low.far, high.far):
            return self._crossing(curve, low, high)
        return (low.s + high.s) / 2

    def _crossing(self, curve: NormalCurve, low: _Sample, high: _Sample) -> float:
        """Where both far contacts are equally near: secant steps on the difference."""
        one, two = low.far[0], high.far[0]
        feet = np.array([low.foot]), np.array([high.foot])

        def gap(s: float) -> float:
            at = np.array([s])
            r = solve_radius(self._incidence, curve, one, at, feet[0], np.array([low.radius]))
            p = curve.feet(at) + r[:, None] * curve.directions(at)
            return float(self._distance(two, p, feet[1])[0] - r[0])

        return _secant(gap, low.s, high.s)

    def _distance(self, site: int, points: Array, feet: Array) -> Array:
        which = np.full(len(points), site, dtype=np.int64)
        it = self._incidence
        return site_fields(it.boundary, it.sites, which, points, feet).distance


def on_locus(incidence: Incidence, sites: Sequence[int], points: Array) -> Bools:
    """Whether points (k, 3) are centres of curvature of one of some faces' carriers."""
    result = np.zeros(len(points), dtype=np.bool_)
    boundary = incidence.boundary
    for site in sites:
        it = incidence.sites[site]
        if it.kind is SiteKind.FACE:
            face = boundary.faces[it.index]
            gap = reflexive_gap(boundary.carriers[face.carrier], face.outward, points)
            result |= gap <= LOCUS * boundary.diagonal
    return result


def solve_radius(
    incidence: Incidence, curve: NormalCurve, far: int, s: Array, feet: Array, guess: Array
) -> Array:
    """Radii (k,) of the balls over parameters (k,) that touch site `far` near feet (k, 3).

    Newton's method on d_far(q + r n) = r, whose derivative by r is g . n - 1.

    Raises:
        GeometryError: it does not converge; says where.
    """
    q, n = curve.feet(s), curve.directions(s)
    which: Ints = np.full(len(s), far, dtype=np.int64)
    r = np.array(guess, dtype=np.float64)
    size = incidence.boundary.diagonal
    near = np.array(feet)
    step = np.zeros(len(r))
    for _ in range(STEPS):
        field = site_fields(incidence.boundary, incidence.sites, which, q + r[:, None] * n, near)
        near = field.foot
        step = (field.distance - r) / (1 - dot(field.gradient, n))
        step = np.clip(step, -0.5 * np.abs(r) - 1e-12 * size, 0.5 * np.abs(r) + 1e-12 * size)
        r = r + step
        if np.abs(step).max(initial=0.0) <= 4e-16 * size:
            break
    if np.abs(step).max(initial=0.0) > 1e-12 * size:
        bad = int(np.argmax(np.abs(step)))
        raise GeometryError(f"the maximal ball at the boundary point {place(q[bad])} is not found")
    return r


def _secant(f: Callable[[float], float], a: float, b: float) -> float:
    """A root close to [a, b], which is narrow already."""
    fa, fb = f(a), f(b)
    for _ in range(20):
        if fa == fb:
            break
        c = b - fb * (b - a) / (fb - fa)
        if abs(c - b) <= 1e-16 * (1 + abs(c)):
            return c
        a, fa, b, fb = b, fb, c, f(c)
    return b
