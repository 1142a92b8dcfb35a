"""Walks along isolines of a carrier: which loop does one reach first?

Two loops bound the same face if a path inside the face joins them. Rays are straight lines on
planes, rulings on cylinders and cones, great circles on spheres, tube circles and latitudes on
tori; where they cross an edge is found exactly.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from decomp.boundary.edges import RawEdge
from decomp.boundary.loops import HalfEdge, LoopSet
from decomp.boundary.member import Member
from decomp.carriers import Torus
from decomp.carriers.axial import axial_split
from decomp.csg.extents import overlap
from decomp.curves import crossing_candidates, crossings
from decomp.curves.base import Curve
from decomp.curves.circle import Circle
from decomp.curves.intersect.planes import ellipse
from decomp.curves.line import Line
from decomp.curves.straight import line_crossings
from decomp.tolerance import PARALLEL, SAME_PARAMETER
from decomp.vectors import Array, Bools, Ints, cross, norm, perpendicular

CLEAR_OF_VERTICES = 1e-4
"""How far, in units of the reach, rays keep away from vertices where they can."""
BEYOND_EDGE = (1e-2, 1e-3, 1e-4)
"""A point that no face covers is looked for beyond edges, these parts of the radius off."""


@dataclass(frozen=True, eq=False)
class Walker:
    """Rays on one side of one carrier, stopping at the loops of a `LoopSet`."""

    member: Member
    edges: Sequence[RawEdge]
    loops: LoopSet
    reach: float

    @cached_property
    def loop_of_edge(self) -> dict[int, list[int]]:
        """The loops that each edge belongs to."""
        result: dict[int, list[int]] = {}
        for index, loop in enumerate(self.loops.loops):
            for half in loop:
                result.setdefault(half.edge, []).append(index)
        return result

    @cached_property
    def crossing_carriers(self) -> Ints:
        """The carriers that bound the faces, ascending."""
        flanks = (f for e in self.loop_of_edge for f in self.edges[e].flanks)
        found = {f.carrier for f in flanks} - {self.loops.carrier}
        return np.array(sorted(found), dtype=np.int64)

    @cached_property
    def _edges_on(self) -> dict[int, list[int]]:
        """The set's edges by the carrier of their other face."""
        result: dict[int, list[int]] = {}
        for index in self.loop_of_edge:
            for flank in self.edges[index].flanks:
                result.setdefault(flank.carrier, []).append(index)
        return result

    @cached_property
    def clearest_direction(self) -> Array:
        """On a sphere: the unit direction from its centre that is farthest from all edges."""
        sphere = self.member.form.carriers[self.loops.carrier]
        directions = _spread_directions(1000)
        edge_points = self._edge_points() - sphere.place
        nearest = (directions @ edge_points.T).max(axis=1)
        return np.asarray(directions[int(np.argmin(nearest))])

    @cached_property
    def pole(self) -> Array:
        """On a sphere: the unit direction of the point farthest from all faces of the set."""
        sphere = self.member.form.carriers[self.loops.carrier]
        centre, radius = sphere.place, sphere.width
        directions = _spread_directions(2000)
        points = centre + radius * directions
        off = ~self.on_face(points)
        edge_points = self._edge_points()
        outside = [directions[off]]
        for half in (h for loop in self.loops.loops for h in loop):
            edge = self.edges[half.edge]
            flank = next(f for f in edge.flanks if f.carrier == self.loops.carrier)
            for step in BEYOND_EDGE:
                beyond = edge.point - step * radius * flank.direction
                outside.append(((beyond - centre) / norm(beyond - centre))[None, :])
        candidates = np.concatenate(outside)
        candidates = candidates[~self.on_face(centre + radius * candidates)]
        gaps = [norm(edge_points - (centre + radius * c)).min() for c in candidates]
        return np.asarray(candidates[int(np.argmax(gaps))])

    def on_face(self, points: Array) -> Bools:
        """Whether points on the carrier belong to a face of the set."""
        return self.member.is_face(self.loops.carrier, self.loops.outward, points)

    def upward(self, point: Array) -> Curve | None:
        """The ray that leads away from `point` towards the outermost loop; None on a torus."""
        carrier = self.member.form.carriers[self.loops.carrier]
        span = (0.0, 4 * self.reach)
        ruling = carrier.ruling(point)
        if ruling is not None:
            return Line(point, ruling, domain=span)
        if carrier.needs_pole:
            x = (point - carrier.place) / carrier.width
            y = self.pole - (self.pole @ x) * x
            length = float(norm(y))
            side = y / length if length > PARALLEL else perpendicular(x)
            return Circle(carrier.place, x, side, carrier.width)
        return None

    def clear_of_vertices(self, point: Array) -> Array:
        """A point of the same face whose ray upward passes no vertex closely.

        Through a vertex in which two faces of the carrier touch, a ray leads from one to the other.
        """
        fractions = (0.0, 0.5, 0.3, 0.7, 0.4, 0.6)
        best, clearest = point, -1.0
        for fraction in fractions:
            moved = point if fraction == 0.0 else self._sideways(point, fraction)
            ray = self.upward(moved)
            if ray is None:
                return point
            gap = self._vertex_gap(ray)
            if gap > clearest:
                best, clearest = moved, gap
            if gap > CLEAR_OF_VERTICES * self.reach:
                break
        return best

    def _sideways(self, point: Array, fraction: float) -> Array:
        """A point part of the way to the first carrier met along the isoline through a point."""
        carrier = self.member.form.carriers[self.loops.carrier]
        ray = self.upward(point)
        assert ray is not None
        along = ray.derivative(np.array(ray.domain[0]))
        across = cross(carrier.normal(point), along / norm(along))
        side: Curve
        level = carrier.level(point)
        if level is not None:
            side = ellipse(*level)
        elif carrier.needs_pole:
            out = (point - carrier.place) / carrier.width
            side = Circle(carrier.place, out, across, carrier.width)
        else:
            side = Line(point, across, domain=(0.0, 4 * self.reach))
        start = float(side.parameter(point))
        gaps = (
            (t - start) % side.period if side.closed else t - start for t, _ in self._cuts(side)
        )
        gap = min((gap for gap in gaps if gap > SAME_PARAMETER * side.period), default=side.period)
        return side.point(side.wrapped(np.array(start + fraction * gap)))

    def _vertex_gap(self, ray: Curve) -> float:
        """Least distance of the ends of edges from a ray; infinite where there are none."""
        ends = self._ends
        if not len(ends):
            return np.inf
        if isinstance(ray, Line):
            away = ends - ray.origin
            along = np.maximum(away @ ray.direction, 0.0)
            return float(norm(away - along[:, None] * ray.direction).min())
        assert isinstance(ray, Circle)
        return float(np.abs((ends - ray.centre) @ cross(ray.x, ray.y)).min())

    @cached_property
    def _ends(self) -> Array:
        ends = [self.edges[e].sampled(2) for e in self.loop_of_edge if self.edges[e].ends]
        return np.concatenate([np.empty((0, 3)), *ends])

    def around_torus(self, point: Array) -> list[Curve]:
        """On a torus: the two circles through `point`, each in both directions."""
        torus = self.member.form.carriers[self.loops.carrier]
        assert isinstance(torus, Torus)
        z, rho, radial = axial_split(point, torus.centre, torus.axis)
        middle = torus.centre + torus.major * radial
        out = (point - middle) / torus.minor
        up = cross(radial, torus.axis)
        tube = cross(up, out)
        level = torus.centre + z * torus.axis
        return [
            Circle(middle, out, tube, torus.minor),
            Circle(middle, out, -tube, torus.minor),
            Circle(level, radial, up, float(rho)),
            Circle(level, radial, -up, float(rho)),
        ]

    def height(self, points: Array) -> Array:
        """How far up points lie in the sense of `upward`."""
        carrier = self.member.form.carriers[self.loops.carrier]
        return points @ self.pole if carrier.needs_pole else carrier.rise(points)

    def first_loop(self, ray: Curve, from_edge: bool) -> int | None:
        """The loop that ends the face into which the ray leads.

        Args:
            ray: its start lies in a face of the set, or on an edge if `from_edge`.
            from_edge: the start is on an edge; the ray counts only if it enters a face there.

        Returns:
            The loop's index; None if the ray does not enter a face, or meets no loop.
        """
        low, high = ray.domain
        tolerance = self.member.form.tolerance
        cuts = self._cuts(ray)
        start = ray.point(np.array(low))
        cuts = [
            (t, k) for t, k in cuts if float(norm(ray.point(np.array(t)) - start)) > 20 * tolerance
        ]
        cuts.sort()
        limits = np.array([low, *(t for t, _ in cuts), high])
        middles = ray.point((limits[1:] + limits[:-1]) / 2)
        if from_edge and not self.on_face(middles[:1])[0]:
            return None
        for (t, k), middle in zip(cuts, middles[1:], strict=True):
            if not self.on_face(middle):
                return self._loop_at(ray, t, k)
        return None

    def _cuts(self, ray: Curve) -> list[tuple[float, int]]:
        """Where a ray meets the carriers that bound the faces: parameter and carrier."""
        form = self.member.form
        if isinstance(ray, Line):
            ends = ray.point(np.array(ray.domain))
            path = np.array([ends.min(axis=0), ends.max(axis=0)])
            near = self.crossing_carriers[overlap(form.carrier_boxes[self.crossing_carriers], path)]
            met = line_crossings(ray, form.table, near, form.tolerance)
            return list(zip(met.parameters.tolist(), met.carriers.tolist(), strict=True))
        near = np.intersect1d(self.crossing_carriers, crossing_candidates(ray, form.table))
        return [
            (float(t), int(k))
            for k in near
            for t in crossings(ray, form.carriers[k], form.tolerance).parameters
        ]

    def _loop_at(self, ray: Curve, t: float, carrier: int) -> int | None:
        """The loop that a ray meets where it leaves a face and meets another carrier."""
        point = ray.point(np.array(t))
        slack = 100 * self.member.form.tolerance
        held = [k for k in self._edges_on.get(carrier, ()) if self.edges[k].holds(point, slack)]
        if len(held) > 1:
            # the region touches itself along them: the face that the ray leaves is behind it
            held.sort(key=lambda k: self._face_side(k, point) @ ray.derivative(np.array(t)))
        return self.loop_of_edge[held[0]][0] if held else None

    def may_enter(self, half: HalfEdge, ray: Curve) -> bool:
        """Whether a ray from a point of an edge may lead into the face left of a half-edge.

        Where the region touches itself along the edge, there is another face on the other side.
        """
        edge = self.edges[half.edge]
        arc = edge.curve_index, edge.start
        others = (k for k in self.loop_of_edge if k != half.edge)
        if all((self.edges[k].curve_index, self.edges[k].start) != arc for k in others):
            return True
        low = np.array(ray.domain[0])
        side = self._face_side(half.edge, ray.point(low))
        return float(side @ ray.derivative(low)) > 0

    def _face_side(self, index: int, point: Array) -> Array:
        """The direction from a point of an edge into the face on this carrier."""
        edge = self.edges[index]
        flank = next(f for f in edge.flanks if f.carrier == self.loops.carrier)
        along = edge.curve.derivative(edge.curve.parameter(point))
        left = cross(self.member.form.carriers[flank.carrier].normal(point), along / norm(along))
        return np.asarray(left if flank.leftward else -left)

    def _edge_points(self) -> Array:
        return np.concatenate([self.edges[e].sampled(33) for e in self.loop_of_edge])


def _spread_directions(count: int) -> Array:
    """Unit vectors (count, 3) spread evenly (a spherical Fibonacci lattice)."""
    k = np.arange(count) + 0.5
    z = 1 - 2 * k / count
    angle = np.pi * (1 + np.sqrt(5)) * k
    rho = np.sqrt(1 - z**2)
    return np.stack([rho * np.cos(angle), rho * np.sin(angle), z], axis=-1)
