"""Where a carrier is nearest to itself: the parts of reflexive loci that belong to the skeleton.

A point of a cylinder's or cone's axis, of a torus's spine or axis, or a sphere's centre, is as far
from all points of a circle (or sphere) of its carrier. It is in the skeleton where no boundary
point is nearer and the carrier's own face is touched in more than one point.

The depth F(u) = d(carrier) - d(boundary) at the locus point u is zero there. It changes at most
twice as fast as u, which tells how far from a point with |F| > 0 there can be no zero; F < 0 means
that the carrier's nearest points are not on the boundary.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq  # type: ignore[import-untyped]

from decomp.carriers import Carrier
from decomp.curves.circle import Circle
from decomp.skeletons.balls.fields import site_fields
from decomp.skeletons.curves.incidence import Incidence
from decomp.skeletons.curves.reflexive_loci import Locus, circle_axis, locus_of
from decomp.tolerance import TOLERANCE
from decomp.vectors import Array, Bools, norm

ZERO = 1e-10
"""Depths below this part of the region's size are zero."""
FINEST = 1e-5
"""Parts of a locus shorter than this part of the region's size can be missed."""
AROUND = 72
"""Directions in which contacts around a point of a locus are looked for."""
TOWARDS = 0.5
LOOKS = 9
"""At so many points of a part it is looked which faces are touched."""
TOWARD = 0.9
"""How far from a centre to a contact, as a part of the radius, the nearest site is asked for."""
BESIDE = 1e-4
"""How far from the end of a part its equation is first looked at, in units of the size."""
NOISE = 1e-6
"""Values of less than this part of others next to them have no sign."""
NEARER = (1e-5, 1e-5, 1e-6)
"""How far beyond an end derivatives are taken, in units of the size, step by step."""
PARTS = 32
"""Parts into which an interval is cut to narrow down where zeros are."""
NARROWER = 10
"""How often: each time it becomes a sixteenth."""
AT_REST = 1e-15
"""Ends are found to this part of the size."""
BEYOND = 1e-6
"""So far beyond an end it is asked what is nearer there, in units of the size."""
DIFFERENCE = 1e-6
"""Step of differences along a locus, in units of the size."""


@dataclass(frozen=True, eq=False)
class ReflexivePart:
    """A maximal connected part of a locus in the skeleton.

    Args:
        sites: the faces on the carrier that are touched.
        locus: of the carrier, None for a sphere's centre.
        start, end: parameters; equal for a point.
        ends: the points (2, 3).
        others: at both ends a site that is as near, -1 where there is none.
    """

    sites: tuple[int, ...]
    locus: Locus | None
    start: float
    end: float
    ends: Array
    others: tuple[int, int]

    @property
    def dimension(self) -> int:
        """0 for a point, 1 for a curve."""
        return int(self.end > self.start)

    def gap(self, point: Array) -> float:
        """The distance of a point (3,) close to it from it."""
        nearest = self.ends
        if self.dimension and self.locus is not None:
            at = np.clip(self.locus.parameter(point[None]), self.start, self.end)
            nearest = np.concatenate([nearest, self.locus.point(at)])
        return float(norm(nearest - point).min())

    @property
    def closed(self) -> bool:
        """Whether it is the whole of a closed locus."""
        return self.locus is not None and self.locus.closed and self.others == (-1, -1)


def reflexive_parts(incidence: Incidence) -> list[ReflexivePart]:
    """All reflexive curves and points of a region."""
    boundary = incidence.boundary
    groups: dict[tuple[int, int], list[int]] = {}
    for number, face in enumerate(boundary.faces):
        groups.setdefault((face.carrier, face.outward), []).append(number)
    found = []
    for (carrier_number, outward), faces in groups.items():
        carrier = boundary.carriers[carrier_number]
        sites = tuple(incidence.face_site[f] for f in faces)
        if carrier.locus == 0 and outward > 0:
            found.extend(_centre(incidence, carrier, sites))
        locus = locus_of(carrier, outward, boundary.bounds)
        if locus is not None:
            found.extend(_Search(incidence, sites, locus).parts())
    for number, site in incidence.edge_site.items():
        curve = boundary.edges[number].curve
        if isinstance(curve, Circle):
            locus = circle_axis(curve, boundary.bounds)
            found.extend(_Search(incidence, (site,), locus).parts())
    return _distinct(found, boundary.tolerances.same)


def _distinct(parts: Sequence[ReflexivePart], within: float) -> list[ReflexivePart]:
    """All curves, and of points in one place the first, unless a curve holds it.

    A ball's centre is on its edges' axes, and a rod's axis is that of its end's edge: both find it.
    """
    kept = [part for part in parts if part.dimension]
    for part in parts:
        if not part.dimension and all(each.gap(part.ends[0]) > within for each in kept):
            kept.append(part)
    return kept


def _centre(incidence: Incidence, ball: Carrier, sites: tuple[int, ...]) -> list[ReflexivePart]:
    centre = ball.place[None]
    found = incidence.context.index.nearest(centre)
    size = incidence.boundary.diagonal
    depth = ball.width - float(found.distance[0])
    if found.region[0] != incidence.region or depth > ZERO * size:
        return []
    rng = np.random.default_rng(0)
    ways = rng.normal(size=(AROUND, 3))
    ways /= norm(ways)[:, None]
    if not _touched(incidence, centre, ways, ball.width).sum() > 1:
        return []
    return [ReflexivePart(sites, None, 0.0, 0.0, np.repeat(centre, 2, axis=0), (-1, -1))]


def _touched(incidence: Incidence, centre: Array, ways: Array, radius: float) -> Bools:
    """Whether the boundary is touched at a distance in some directions (k, 3) from a point."""
    half = centre + TOWARDS * radius * ways
    inside, depth = incidence.context.queries.depth(half)
    gap = np.abs(depth - (1 - TOWARDS) * radius)
    return np.asarray(inside & (gap <= incidence.boundary.tolerances.same))


class _Search:
    """Looks for the zeros of the depth along one locus."""

    def __init__(self, incidence: Incidence, sites: tuple[int, ...], locus: Locus) -> None:
        self._incidence = incidence
        self._sites, self._locus = sites, locus
        self._size = incidence.boundary.diagonal
        self._zero = ZERO * self._size

    def parts(self) -> list[ReflexivePart]:
        low, high = self._locus.span
        if not high > low:
            return []
        runs = self._runs(low, high)
        if self._locus.closed and len(runs) > 1 and runs[0][0] == low and runs[-1][1] == high:
            (_, end), (start, _) = runs[0], runs.pop()
            runs[0] = (start - (high - low), end)
        found = []
        for a, b in runs:
            part = self._part(a, b)
            if part is not None:
                found.append(part)
        return found

    def _depth(self, u: Array) -> Array:
        points = self._locus.point(u)
        inside, depth = self._incidence.context.queries.depth(points)
        radius = self._locus.radius(u)
        inside &= radius > self._zero
        return np.where(inside, np.abs(radius - depth), radius + depth + 2 * self._zero)

    def _runs(self, low: float, high: float) -> list[tuple[float, float]]:
        """Intervals of zeros, to `FINEST`: neighbouring samples that are all zero."""
        count = 256
        u = np.linspace(low, high, count + 1)
        width = (high - low) / count
        zeros: list[Array] = []
        alone = np.empty(0)
        while True:
            depth = self._depth(u)
            zero = depth <= self._zero
            zeros.append(u[zero])
            # a zero can lie closer to a sample than its depth allows
            open_ = ~zero & (depth < 2 * width)
            if width <= FINEST * self._size or not open_.any():
                alone = self._points(u[open_], width)
                break
            width /= 2
            u = np.unique(np.concatenate([u[open_] - width, u[open_] + width]))
            u = u[(u > low) & (u < high)]
        at = np.unique(np.concatenate(zeros))
        gaps = np.flatnonzero(np.diff(at) > 1.5 * (high - low) / count)
        starts, ends = (
            (np.append(0, gaps + 1), np.append(gaps, len(at) - 1)) if len(at) else (gaps, gaps)
        )
        runs = [(float(at[i]), float(at[j])) for i, j in zip(starts, ends, strict=True)]
        # what is found beside a run's end is that end
        apart = [u for u in alone.tolist() if all(max(a - u, u - b) > 2 * width for a, b in runs)]
        return sorted([*runs, *((u, u) for u in apart)])

    def _points(self, u: Array, width: float) -> Array:
        """Zeros that are points, near some of the last samples: the depth is least there."""
        groups = np.split(u, np.flatnonzero(np.diff(u) > 1.5 * width) + 1) if len(u) else []
        found = []
        for group in groups:
            low, high = (
                float(np.clip(end, *self._locus.span))
                for end in (group[0] - width, group[-1] + width)
            )
            for _ in range(NARROWER):
                cuts = np.linspace(low, high, PARTS + 1)
                least = int(np.argmin(self._depth(cuts)))
                low, high = float(cuts[max(least - 1, 0)]), float(cuts[min(least + 1, PARTS)])
            middle = np.array([(low + high) / 2])
            if self._depth(middle)[0] <= self._zero:
                found.append(middle)
        return np.concatenate([np.empty(0), *found])

    def _part(self, a: float, b: float) -> ReflexivePart | None:
        locus = self._locus
        low, high = locus.span
        if locus.closed and b - a >= (high - low) * (1 - TOLERANCE):
            start, end, others = low, high, (-1, -1)
        else:
            start, one = self._end(a, -1.0)
            end, two = self._end(b, 1.0)
            others = (one, two)
            if end - start <= TOLERANCE * self._size:
                start = end = (start + end) / 2
        middle = np.array([(start + end) / 2])
        centre = locus.point(middle)
        radius = float(locus.radius(middle)[0])
        ways = locus.touched(float(middle[0]), AROUND)
        if _touched(self._incidence, centre, ways, radius).sum() < 2:
            return None
        ends = locus.point(np.array([start, end]))
        return ReflexivePart(self._held(start, end), locus, start, end, ends, others)

    def _held(self, start: float, end: float) -> tuple[int, ...]:
        """The faces that are touched from a part of the locus."""
        if len(self._sites) == 1:
            return self._sites
        toward = []
        for u in np.linspace(start, end, LOOKS):
            at = np.array([u])
            ways = self._locus.touched(float(u), AROUND)
            toward.append(self._locus.point(at) + TOWARD * self._locus.radius(at) * ways)
        found = self._incidence.context.index.nearest(np.concatenate(toward))
        short = (1 - TOWARD) * np.repeat(self._locus.radius(np.linspace(start, end, LOOKS)), AROUND)
        touched = found.distance >= short - self._zero
        return tuple(s for s in self._sites if s in set(found.site[touched].tolist()))

    def _end(self, u: float, sense: float) -> tuple[float, int]:
        """Where the zeros end on one side of u, and the site that is nearer beyond."""
        low, high = self._locus.span
        inside, outside = u, u + sense * 1.5 * (high - low) / 256
        for _ in range(80):
            cuts = np.linspace(inside, outside, PARTS + 1)
            beyond_zero = np.append(self._depth(cuts[1:-1]) > self._zero, True)
            first = int(np.argmax(beyond_zero))
            inside, outside = float(cuts[first]), float(cuts[first + 1])
            if abs(outside - inside) <= AT_REST * self._size:
                break
        beyond = inside + sense * BEYOND * self._size
        near = self._incidence.context.index.nearest(self._locus.point(np.array([beyond])))
        if near.region[0] != self._incidence.region:
            return inside, -1
        other, foot = int(near.site[0]), near.foot
        # farther on the foot is told better: the distances grow with the square of the way
        clear = inside + sense * BESIDE * self._size
        far = self._incidence.context.index.nearest(self._locus.point(np.array([clear])))
        if int(far.site[0]) == other:
            foot = far.foot
        return self._polished(inside, sense, other, foot), other

    def _polished(self, u: float, sense: float, other: int, foot: Array) -> float:
        """Solve d_other(u) = d_carrier(u) from close by, zeros being on one side of u.

        An edge of the carrier's own face is as near all along the zeros. There the difference of
        the distances begins to grow with its derivative, which is linear beyond.
        """
        which = np.array([other])
        it = self._incidence

        def gap(v: float) -> float:
            at = np.array([v])
            p = self._locus.point(at)
            field = site_fields(it.context, which, p, foot)
            return float(field.distance[0] - self._locus.radius(at)[0])

        def change(v: float) -> float:
            """Derivative of the gap."""
            h = DIFFERENCE * self._size
            at = np.array([v - h, v, v + h])
            behind, here, ahead = self._locus.point(at)
            field = site_fields(it.context, which, here[None], foot)
            low, _, high = self._locus.radius(at)
            return float((field.gradient[0] @ (ahead - behind) - (high - low)) / (2 * h))

        a, b = u - BESIDE * self._size, u + BESIDE * self._size
        for function in (gap, change):
            # where the distances only touch their difference is least, its derivative is zero
            one, two = function(a), function(b)
            if one * two < 0 and min(abs(one), abs(two)) > NOISE * max(abs(one), abs(two)):
                return float(brentq(function, a, b, xtol=AT_REST * self._size, rtol=AT_REST))
        for part in NEARER:
            step = sense * part * self._size
            # among the zeros the foot is not the nearest one of its edge, so they are not asked
            one, two = (change(u + k * step) for k in (1, 2))
            if not (abs(one) < abs(two) and one * two > 0):
                break
            move = step * (1 - one / (two - one))
            if abs(move) > 10 * abs(step):
                break
            u += move
        return u
