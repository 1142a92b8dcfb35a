"""The boundary of a region, assembled from its edges, loops and faces."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from decomp.boundary.apexes import apexes
from decomp.boundary.bounds import region_bounds
from decomp.boundary.edges import RawEdge
from decomp.boundary.faces import RawFace
from decomp.boundary.integrals import FaceIntegrals, Track, face_integrals, tracks
from decomp.boundary.loops import LoopSet
from decomp.boundary.member import Member
from decomp.boundary.naming import face_names
from decomp.boundary.rays import Walker
from decomp.boundary.topology import Convexity, Edge, Face, RegionBoundary, Vertex
from decomp.boundary.verified import characteristic, refuse_wrong_turning, refuse_wrong_volume
from decomp.csg.halfspaces import HalfSpaceForm
from decomp.errors import GeometryError
from decomp.vectors import Array

SUMMED = 1e-14
"""Rounding of a sum of areas, or of volumes in units of the scale, as a part of the area."""
OFF_EDGE = 1e-4
"""A face's point of its own is looked for this part of the scale beside its edges."""


def assembled(
    form: HalfSpaceForm,
    member: Member,
    edges: Sequence[RawEdge],
    points: Array,
    parts: Sequence[int],
    sets: Sequence[LoopSet],
    raw: Sequence[RawFace],
    reach: float,
) -> RegionBoundary:
    """A region's boundary with its measures.

    Args:
        form: the model's.
        member: the region.
        edges: of it.
        points: (n, 3) its vertices.
        parts: how many parts of it meet at each; more than one where it touches itself.
        sets: the loops of the edges on each carrier's sides.
        raw: faces.
        reach: radius about the form's centre within which the region lies.

    Raises:
        GeometryError: loops could not be joined to faces, or figures contradict each other; says
            where.
    """
    quadrature = [tracks(edge) for edge in edges]
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
    tips = apexes(form, member, raw, points)
    vertices = _vertices(points, finished) + tips
    area = sum(i.area for i in fine)
    volume = sum(i.flux for i in fine) / 3
    error = abs(volume - sum(i.flux for i in coarse) / 3) + SUMMED * area * form.scale
    verify = (lambda k: quadrature[k][0]), poles, fine
    refuse_wrong_turning(member, raw, edges, points, *verify, tips)
    refuse_wrong_volume(member, raw, edges, *verify, volume, error)
    return RegionBoundary(
        member.name,
        form.carriers,
        faces,
        finished,
        vertices,
        volume,
        error,
        area,
        sum(abs(a.area - b.area) for a, b in zip(fine, coarse, strict=True)) + SUMMED * area,
        region_bounds(form, member, raw, finished, vertices),
        _euler(member, edges, sum(parts), raw),
    )


def _refuse_broken(
    form: HalfSpaceForm, member: Member, raw: Sequence[RawFace], integrals: Sequence[FaceIntegrals]
) -> None:
    """Raise GeometryError where loops were not joined to the right faces: a hole has area < 0."""
    for face, integral in zip(raw, integrals, strict=True):
        if integral.area <= 0:
            raise GeometryError(
                f"region {member.name!r}: the loops on {form.carrier_name(face.carrier)} near "
                "{at} could not be joined to faces",
                at=face.point,
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
        if form.carriers[s.carrier].needs_pole
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
        near.append(edge.point + OFF_EDGE * form.scale * flank.direction)
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


def _euler(member: Member, edges: Sequence[RawEdge], vertices: int, raw: Sequence[RawFace]) -> int:
    """Half the Euler characteristic of the boundary, which is that of the solid.

    Where it touches itself it counts as parted: a vertex is as many as parts of it meet there.
    """
    total = vertices - sum(edge.ends is not None for edge in edges)
    total += sum(characteristic(face, member, edges) for face in raw)
    if total % 2:
        raise GeometryError(
            f"region {member.name!r}: its boundary has the odd Euler characteristic {total}, so it "
            "was not assembled correctly"
        )
    return total // 2
