"""Rims of the sheets that a curved reentrant edge has with itself.

Close to a point t0 at which an edge is symmetric, the balls that touch it on one side touch it on
the other too, so a sheet between the edge and itself lies in the plane of symmetry. It ends where
the two feet meet in t0: on the centres of curvature of the edge there, the line

    p = e(t0) + d / (K . d)

over all directions d between the normals of the edge's faces, with K the edge's curvature vector.
"""

from __future__ import annotations

import numpy as np
from scipy.optimize import brentq  # type: ignore[import-untyped]

from decomp.boundary.topology import Edge, RegionBoundary
from decomp.complex.model import LineKind
from decomp.curves.circle import Circle
from decomp.curves.line import Line
from decomp.errors import GeometryError
from decomp.medial.curve_elements import RayCurve
from decomp.medial.incidence import Incidence, angle_between
from decomp.medial.normal_curves import VertexRay
from decomp.medial.pieces import CurvePiece
from decomp.medial.trims import solve_radius
from decomp.sites import SiteIndex
from decomp.tracing.balls import inscribed_balls
from decomp.tracing.fields import site_fields
from decomp.vectors import Array, cross, dot, norm, place

ALONG = 256
ACROSS = 32
OFFSETS = (0.08, 0.04)
"""How far from a point of symmetry, in parts of the edge, its two sides are compared."""
SAME = 1e-6


def rim_pieces(index: SiteIndex, incidence: Incidence) -> list[CurvePiece]:
    """The rims of all edges of a region.

    Raises:
        GeometryError: an edge has a sheet with itself that lies in no plane of symmetry.
    """
    found = []
    for number, site in incidence.edge_site.items():
        edge = incidence.boundary.edges[number]
        if not isinstance(edge.curve, (Line, Circle)):
            found.extend(_Edge(index, incidence, edge, number, site).rims())
    return found


class _Edge:
    def __init__(
        self, index: SiteIndex, incidence: Incidence, edge: Edge, number: int, site: int
    ) -> None:
        self._index, self._incidence = index, incidence
        self._edge, self._number, self._site = edge, number, site
        self._boundary: RegionBoundary = incidence.boundary
        self._size = incidence.boundary.diagonal
        self._span = edge.end - edge.start

    def rims(self) -> list[CurvePiece]:
        """Rims at all points of symmetry at which there is one."""
        found = []
        for t in self._symmetric():
            found.extend(self._rims_at(t))
        return found

    def _directions(self, t: Array, share: float | Array) -> Array:
        """Directions at parts of the angle between the two faces' inward normals."""
        q = self._edge.curve.point(t)
        a, b = (self._incidence.inward(f, q) for f in self._edge.faces)
        tangent = self._edge.curve.derivative(t)
        tangent = tangent / norm(tangent)[:, None]
        angle = np.asarray(share) * angle_between(a, b, tangent)
        side = cross(tangent, a)
        return np.asarray(np.cos(angle)[:, None] * a + np.sin(angle)[:, None] * side)

    def _partner(self, t: Array, share: float) -> Array:
        """How far along the edge the second foot is that the balls have on it; NaN if none."""
        q, ways = self._edge.curve.point(t), self._directions(t, share)
        balls = inscribed_balls(self._index, self._boundary, self._incidence.region, q, ways)
        other = np.full(len(t), np.nan)
        on = balls.site == self._site
        if on.any():
            step = self._edge.curve.parameter(balls.foot[on]) - t[on]
            if self._edge.curve.closed:
                period = self._edge.curve.period
                step = step - period * np.round(step / period)
            other[on] = step
        return other

    def _symmetric(self) -> list[float]:
        """Parameters at which partners close to them lie on both sides."""
        edge = self._edge
        parts = (np.arange(ALONG) + 0.37) / ALONG
        t = edge.start + self._span * parts
        found = []
        for share in (0.5, 0.2, 0.8):
            step = self._partner(t, share)
            spacing = self._span / ALONG
            pairs = list(zip(range(ALONG - 1), range(1, ALONG), strict=True))
            if edge.closed:
                pairs.append((ALONG - 1, 0))
            for i, j in pairs:
                near = abs(step[i]) < 6 * spacing and abs(step[j]) < 6 * spacing
                if near and step[i] > 0 > step[j]:
                    found.append(self._centre(float(t[i]) + spacing / 2, share))
        unique: list[float] = []
        for value in found:
            gaps = [abs(value - known) for known in unique]
            if edge.curve.closed:
                gaps = [min(gap, abs(gap - edge.curve.period)) for gap in gaps]
            if not any(gap <= 1e-6 * self._span for gap in gaps):
                unique.append(value)
        return unique

    def _centre(self, near: float, share: float) -> float:
        """The point of symmetry: where the mid-planes of partners cut the edge."""
        centres = []
        for offset in OFFSETS:
            t = np.array([near - offset * self._span])
            partner = self._exact_partner(t, share)
            if partner is None:
                continue
            a, b = self._edge.curve.point(t)[0], partner
            middle, across = (a + b) / 2, (b - a) / float(norm(b - a))
            at = near
            for _ in range(30):
                x = self._edge.curve.point(np.array([at]))[0]
                v = self._edge.curve.derivative(np.array([at]))[0]
                move = float((middle - x) @ across) / float(v @ across)
                at += move
                if abs(move) <= 1e-16 * (1 + abs(at)):
                    break
            centres.append(at)
        if len(centres) < 2 or abs(centres[0] - centres[1]) > 1e-8 * self._span:
            where = place(self._edge.curve.point(np.array([near]))[0])
            name = self._incidence.sites[self._site].name
            raise GeometryError(
                f"the edge {name} has a sheet with itself near {where} that has no plane of "
                "symmetry; such sheets are not supported"
            )
        return centres[1]

    def _exact_partner(self, t: Array, share: float) -> Array | None:
        """The second foot (3,) of the ball over a parameter (1,), if it is ahead on the edge."""
        step = self._partner(t, share)
        if not np.isfinite(step[0]) or step[0] <= 0:
            return None
        q, way = self._edge.curve.point(t)[0], self._directions(t, share)[0]
        foot = self._edge.curve.point(self._edge.curve.wrapped(t + step))
        chord = foot[0] - q
        radius = float(chord @ chord) / (2 * float(chord @ way))
        ray = VertexRay(0.0, radius, False, (self._site, self._site), q, way)
        zero = np.zeros(1)
        guess = np.array([radius])
        exact = solve_radius(self._incidence, ray, self._site, zero, foot, guess)
        it = self._incidence
        which = np.array([self._site])
        centre = q + exact[:, None] * way
        return np.asarray(site_fields(it.boundary, it.sites, which, centre, foot).foot[0])

    def _rims_at(self, t0: float) -> list[CurvePiece]:
        """The parts of the line of centres of curvature over t0 that are in the skeleton."""
        share = np.linspace(0, 1, ACROSS + 1)
        q, ways, curved = self._centres(t0, share)
        balls = inscribed_balls(self._index, self._boundary, self._incidence.region, q, ways)
        # a ball that osculates the edge comes to rest a little late, but never early
        on = balls.radius >= curved - SAME * self._size
        found = []
        padded = np.concatenate([[False], on, [False]])
        for first, last in zip(
            np.flatnonzero(padded[1:] & ~padded[:-1]),
            np.flatnonzero(padded[:-1] & ~padded[1:]) - 1,
            strict=True,
        ):
            ends = []
            for k, beyond in ((first, first - 1), (last, last + 1)):
                if 0 <= beyond <= ACROSS:
                    foot = balls.foot[beyond]
                    other = int(balls.site[beyond])
                    ends.append(self._met(t0, float(share[k]), float(share[beyond]), other, foot))
                else:
                    ends.append(float(share[k]))
            if ends[1] - ends[0] > 1e-9:
                found.append(self._piece(t0, np.linspace(ends[0], ends[1], ACROSS + 1)))
        return found

    def _centres(self, t0: float, share: Array) -> tuple[Array, Array, Array]:
        """The edge's point over t0, directions across it, and radii of curvature in them."""
        t = np.full(len(share), t0)
        q, ways = self._edge.curve.point(t), self._directions(t, share)
        bend = ways @ self._curvature(q[0])
        curved = np.where(bend > 1e-12 / self._size, 1 / np.where(bend > 0, bend, 1.0), np.inf)
        return q, ways, curved

    def _met(self, t0: float, inside: float, outside: float, other: int, foot: Array) -> float:
        """The direction in which a third site is as near as the edge."""
        it = self._incidence

        def gap(share: float) -> float:
            q, ways, curved = self._centres(t0, np.array([share]))
            centre = q + curved[:, None] * ways
            which = np.array([other])
            field = site_fields(it.boundary, it.sites, which, centre, foot[None])
            return float(field.distance[0] - curved[0])

        return float(brentq(gap, inside, outside, xtol=1e-15))

    def _piece(self, t0: float, share: Array) -> CurvePiece:
        q, ways, curved = self._centres(t0, share)
        points = q + curved[:, None] * ways
        along = points[-1] - points[0]
        line = RayCurve(points[0], along / float(norm(along)))
        pair = (self._site, self._site)
        return CurvePiece(
            LineKind.RIM, ((self._site,),), line, line.place(points), q[:1], pairs=(pair,)
        )

    def _curvature(self, point: Array) -> Array:
        """The edge's curvature vector at a point, from the normal curvatures of its carriers."""
        a, b = (self._boundary.carriers[k] for k in self._edge.carriers)
        tangent = self._incidence.tangent(self._number, point)
        na, nb = a.normal(point), b.normal(point)
        ha, hb = -a.normal_curvature(point, tangent), -b.normal_curvature(point, tangent)
        c = float(dot(na, nb))
        s2 = 1 - c**2
        return np.asarray(((ha - c * hb) * na + (hb - c * ha) * nb) / s2)
