"""From a half-space form to the exact boundary of each region."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from decomp.boundary import checks
from decomp.boundary.arcs import Arrangement, arrange
from decomp.boundary.bounds import region_bounds
from decomp.boundary.edges import RawEdge, raw_edges
from decomp.boundary.faces import RawFace, face_at, raw_faces
from decomp.boundary.integrals import FaceIntegrals, Track, face_integrals, tracks
from decomp.boundary.loops import LoopSet, loop_sets
from decomp.boundary.member import Member
from decomp.boundary.naming import face_names
from decomp.boundary.rays import Walker
from decomp.boundary.topology import Convexity, Edge, Face, RegionBoundary, Vertex
from decomp.boundary.torus_loops import genus, winding
from decomp.boundary.touching import touching_regions
from decomp.boundary.wedges import Star, stars
from decomp.carriers import Cone, Sphere, Torus
from decomp.csg.halfspaces import HalfSpaceForm, half_space_form
from decomp.csg.model import Model
from decomp.errors import EmptyRegionError, GeometryError, UnboundedRegionError
from decomp.vectors import Array, Ints, frame, norm, place

WINDOWS = (2.0, 2e4)
"""Radii, in units of the estimated scale, within which a model is looked for."""


@dataclass(frozen=True, eq=False)
class Boundaries:
    """The exact boundaries of all regions of a model.

    Args:
        form: its carriers and program.
        regions: one boundary per region, in the model's order.
    """

    form: HalfSpaceForm
    regions: tuple[RegionBoundary, ...]
    _sources: tuple[_Source, ...]

    @property
    def diagonal(self) -> float:
        """Length of the diagonal of the box around all regions."""
        low = np.min([region.bounds[0] for region in self.regions], axis=0)
        high = np.max([region.bounds[1] for region in self.regions], axis=0)
        return float(np.linalg.norm(high - low))

    @cached_property
    def outside(self) -> RegionBoundary:
        """The boundary of everything outside all regions."""
        if len(self.regions) == 1:
            return _flipped(self.regions[0])
        return _flipped(self._union.boundary)

    @cached_property
    def _union(self) -> _Source:
        source = self._sources[0]
        return _build(source.arrangement, source.stars, Member(self.form, None))

    @cached_property
    def touching(self) -> tuple[tuple[int, int], ...]:
        """Pairs of regions that share a piece of surface, lower index first."""
        whole = [face for s in self._sources for face in s.faces if not face.loops]
        return touching_regions(self.form, self._sources[0].stars, whole)

    def face_at(self, region: int, carrier: int, points: Array) -> Ints:
        """Indices (n,) of a region's faces that hold points (n, 3) of a carrier, else -1.

        Region -1 is the outside. The points lie on the carrier. Exact but slow where the carrier
        has several faces.
        """
        if region >= 0:
            return self._sources[region].face_at(carrier, points)
        source = self._sources[0] if len(self.regions) == 1 else self._union
        return source.face_at(carrier, points)


@dataclass(frozen=True, eq=False)
class _Source:
    """What a region's boundary was made from."""

    arrangement: Arrangement
    stars: list[Star]
    member: Member
    edges: list[RawEdge]
    sets: list[LoopSet]
    faces: list[RawFace]
    boundary: RegionBoundary

    def face_at(self, carrier: int, points: Array) -> Ints:
        return face_at(
            self.edges,
            self.sets,
            self.faces,
            self.member,
            self.arrangement.radius,
            carrier,
            points,
        )


def boundaries(model: Model) -> Boundaries:
    """Compute the exact boundary of every region of a model.

    Raises:
        EmptyRegionError: a region has no interior.
        UnboundedRegionError: a region reaches infinity; names the direction.
        OverlapError: two regions share interior points.
        ContactError: a region touches itself along a curve or at a point.
    """
    form = half_space_form(model)
    result = _boundaries_of(form)
    if not 0.1 < result.diagonal / form.scale < 10:
        # the estimate from the primitives was far off: do it again with the true size
        result = _boundaries_of(half_space_form(model, result.diagonal))
    return result


def _boundaries_of(form: HalfSpaceForm) -> Boundaries:
    for window in WINDOWS:
        arrangement = arrange(form, max(window * form.scale, _reach(form)))
        surroundings = stars(arrangement)
        try:
            sources = [
                _build(arrangement, surroundings, Member(form, k)) for k in range(len(form.names))
            ]
        except UnboundedRegionError:
            if window == WINDOWS[-1]:
                raise
        else:
            break
    checks.refuse_overlaps(form, arrangement, surroundings)
    return Boundaries(form, tuple(s.boundary for s in sources), tuple(sources))


def _reach(form: HalfSpaceForm) -> float:
    """The distance from the form's centre to the far end of its regions, 0 if not known."""
    corners = np.abs(form.region_boxes - form.centre)
    farthest = float(norm(corners.max(axis=1)).max())
    return 1.01 * farthest if np.isfinite(farthest) else 0.0


def _build(arrangement: Arrangement, surroundings: list[Star], member: Member) -> _Source:
    form = member.form
    edges, points = raw_edges(arrangement, surroundings, member)
    checks.refuse_unbounded(arrangement, member)
    sets = loop_sets(edges, points, member)
    faces = raw_faces(edges, sets, member, arrangement.radius)
    if not faces:
        raise EmptyRegionError(
            f"region {member.name!r} is empty: its Boolean expression leaves no interior"
        )
    for contact in arrangement.contacts:
        checks.refuse_point_contact(arrangement, contact, member)
    quadrature = [tracks(edge) for edge in edges]
    boundary = _boundary(form, member, edges, points, sets, faces, quadrature, arrangement.radius)
    return _Source(arrangement, surroundings, member, edges, sets, faces, boundary)


def _boundary(
    form: HalfSpaceForm,
    member: Member,
    edges: Sequence[RawEdge],
    points: Array,
    sets: Sequence[LoopSet],
    raw: Sequence[RawFace],
    quadrature: Sequence[tuple[Track, Track]],
    reach: float,
) -> RegionBoundary:
    poles = _poles(form, member, edges, sets, reach)
    fine, coarse = (
        [
            face_integrals(
                face,
                form.carriers[face.carrier],
                edges,
                lambda k, level=level: quadrature[k][level],  # type: ignore[misc]
                form.centre,
                poles.get((face.carrier, face.outward)),
            )
            for face in raw
        ]
        for level in (0, 1)
    )
    _refuse_broken(form, member, raw, fine)
    names = face_names(raw, [_probes(face, edges, form, member) for face in raw], member)
    faces = tuple(
        Face(
            name,
            face.carrier,
            face.outward,
            integral.area,
            tuple(tuple((h.edge, h.direction) for h in loop) for loop in face.loops),
            options,
            face.point,
        )
        for face, integral, (name, options) in zip(raw, fine, names, strict=True)
    )
    finished = _edges(edges, raw, quadrature)
    vertices = _vertices(points, finished) + _apexes(form, member, raw, points)
    area = sum(i.area for i in fine)
    volume = sum(i.flux for i in fine) / 3
    rounding = 1e-14 * area * form.scale
    return RegionBoundary(
        member.name,
        form.carriers,
        faces,
        finished,
        vertices,
        volume,
        abs(volume - sum(i.flux for i in coarse) / 3) + rounding,
        area,
        sum(abs(a.area - b.area) for a, b in zip(fine, coarse, strict=True)) + 1e-14 * area,
        region_bounds(form, member, raw, finished, vertices),
        _euler(form, member, edges, points, raw),
    )


def _refuse_broken(
    form: HalfSpaceForm, member: Member, raw: Sequence[RawFace], integrals: Sequence[FaceIntegrals]
) -> None:
    """Raise GeometryError where loops were not joined to the right faces: a hole has area < 0."""
    for face, integral in zip(raw, integrals, strict=True):
        if integral.area <= 0:
            raise GeometryError(
                f"region {member.name!r}: the loops on {form.carrier_name(face.carrier)} near "
                f"{place(face.point)} could not be joined to faces"
            )


def _poles(
    form: HalfSpaceForm,
    member: Member,
    edges: Sequence[RawEdge],
    sets: Sequence[LoopSet],
    reach: float,
) -> dict[tuple[int, int], Array]:
    """For each sphere with edges the direction from its centre that keeps farthest from them."""
    return {
        (s.carrier, s.outward): Walker(member, edges, s, reach).clearest_direction
        for s in sets
        if isinstance(form.carriers[s.carrier], Sphere)
    }


def _probes(face: RawFace, edges: Sequence[RawEdge], form: HalfSpaceForm, member: Member) -> Array:
    """Points inside a face: its interior point, and some close to its edges."""
    carrier = form.carriers[face.carrier]
    near = []
    for half in [h for loop in face.loops for h in loop][:16]:
        edge = edges[half.edge]
        flank = next(
            f
            for f in edge.flanks
            if f.carrier == face.carrier and f.direction_of_loop == half.direction
        )
        near.append(edge.point + 1e-4 * form.scale * flank.direction)
    if not near:
        return face.point[None, :]
    candidates = carrier.project(np.array(near))
    inside = member.is_face(face.carrier, face.outward, candidates)
    return np.concatenate([face.point[None, :], candidates[inside]])


def _edges(
    edges: Sequence[RawEdge], raw: Sequence[RawFace], quadrature: Sequence[tuple[Track, Track]]
) -> tuple[Edge, ...]:
    face_of = {
        (half.edge, half.direction): index
        for index, face in enumerate(raw)
        for loop in face.loops
        for half in loop
    }
    result = []
    for index, edge in enumerate(edges):
        first, second = edge.flanks
        result.append(
            Edge(
                edge.curve,
                edge.start,
                edge.end,
                (
                    face_of[index, first.direction_of_loop],
                    face_of[index, second.direction_of_loop],
                ),
                (first.carrier, second.carrier),
                edge.ends,
                edge.convexity,
                quadrature[index][0].length,
                edge.samples(),
            )
        )
    return tuple(result)


def _vertices(points: Array, edges: Sequence[Edge]) -> tuple[Vertex, ...]:
    at: list[list[int]] = [[] for _ in points]
    for index, edge in enumerate(edges):
        for end in set(edge.vertices or ()):
            at[end].append(index)
    result = []
    for point, incident in zip(points, at, strict=True):
        kinds = {edges[k].convexity for k in incident} - {Convexity.SMOOTH}
        if not kinds:
            convexity = Convexity.SMOOTH
        else:
            convexity = kinds.pop() if len(kinds) == 1 else Convexity.SADDLE
        faces = sorted({f for k in incident for f in edges[k].faces})
        result.append(Vertex(point, tuple(faces), tuple(incident), convexity))
    return tuple(result)


def _apexes(
    form: HalfSpaceForm, member: Member, raw: Sequence[RawFace], points: Array
) -> tuple[Vertex, ...]:
    """The apexes of cones that lie inside a face."""
    result = []
    for index, cone in enumerate(form.carriers):
        if not isinstance(cone, Cone):
            continue
        if len(points) and norm(points - cone.apex).min() <= 10 * form.tolerance:
            continue
        ring = _around_apex(cone, 1e-5 * form.scale)
        for outward in (1, -1):
            if member.is_face(index, outward, ring).all():
                here = [k for k, f in enumerate(raw) if (f.carrier, f.outward) == (index, outward)]
                convexity = Convexity.CONVEX if outward > 0 else Convexity.REENTRANT
                face = _apex_face(here, raw, cone, member)
                result.append(Vertex(cone.apex, (face,), (), convexity))
    return tuple(result)


def _around_apex(cone: Cone, step: float) -> Array:
    """Points of a cone a step down its rulings: at the apex itself other carriers may meet."""
    x, y = frame(cone.axis)
    angles = np.linspace(0.3, 0.3 + 2 * np.pi, 12, endpoint=False)[:, None]
    side = np.cos(angles) * x + np.sin(angles) * y
    return np.asarray(
        cone.apex + step * (np.cos(cone.angle) * cone.axis + np.sin(cone.angle) * side)
    )


def _apex_face(here: Sequence[int], raw: Sequence[RawFace], cone: Cone, member: Member) -> int:
    """Of the faces on a cone the one that reaches its apex: a way down a ruling stays inside."""
    if len(here) == 1:
        return here[0]
    for k in here:
        way = cone.apex + np.linspace(0.01, 1, 50)[:, None] * (raw[k].point - cone.apex)
        if member.is_face(raw[k].carrier, raw[k].outward, way).all():
            return k
    raise GeometryError(
        f"region {member.name!r}: no face of {member.form.carrier_name(raw[here[0]].carrier)} was "
        f"found at its apex {place(cone.apex)}"
    )


def _euler(
    form: HalfSpaceForm,
    member: Member,
    edges: Sequence[RawEdge],
    points: Array,
    raw: Sequence[RawFace],
) -> int:
    """Half the Euler characteristic of the boundary, which is that of the solid."""
    total = len(points) - sum(edge.ends is not None for edge in edges)
    for face in raw:
        handles = 0
        carrier = form.carriers[face.carrier]
        if isinstance(carrier, Torus):
            handles = genus([winding(carrier, edges, p, face.outward) for p in face.loops])
        total += 2 - 2 * handles - len(face.loops)
    if total % 2:
        raise GeometryError(
            f"region {member.name!r}: its boundary has the odd Euler characteristic {total}, so it "
            "was not assembled correctly"
        )
    return total // 2


def _flipped(boundary: RegionBoundary) -> RegionBoundary:
    """The same boundary seen from the other side."""
    return replace(
        boundary,
        name="outside",
        faces=tuple(
            replace(
                f,
                outward=-f.outward,
                loops=tuple(tuple((e, -d) for e, d in reversed(p)) for p in f.loops),
            )
            for f in boundary.faces
        ),
        edges=tuple(replace(e, convexity=e.convexity.flipped()) for e in boundary.edges),
        vertices=tuple(replace(v, convexity=v.convexity.flipped()) for v in boundary.vertices),
        volume=-boundary.volume,
        euler=0,
    )
