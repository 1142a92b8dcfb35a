"""A region's boundary is checked by figures that its making does not use, before it is handed out.

1. Every face turns as its loops and handles say (Gauss and Bonnet, see `turning`).
2. The corners of one carrier's faces fit around their vertex.
3. The volume is the same by two vector fields (`second_volume`).
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Sequence

import numpy as np

from decomp.boundary.edges import RawEdge
from decomp.boundary.faces import RawFace
from decomp.boundary.integrals import FaceIntegrals, Track, torus_border
from decomp.boundary.member import Member
from decomp.boundary.second_volume import second_flux, torus_flux
from decomp.boundary.topology import Vertex
from decomp.boundary.torus_loops import genus, winding
from decomp.boundary.turning import Turning, sampler, turning
from decomp.carriers import Torus
from decomp.errors import GeometryError
from decomp.vectors import Array

ANGLE_ROOM = 1e-3
"""By how much the angles around a vertex may exceed a full turn: tangents at nodes are inexact."""
ERRORS = 10.0
AGREEMENT = 1e-9
"""Volumes agree to so many times their errors, and this part of area times diagonal."""

Poles = dict[tuple[int, int], Array]


def characteristic(face: RawFace, member: Member, edges: Sequence[RawEdge]) -> int:
    """The Euler characteristic of a face, from its loops and handles."""
    carrier = member.form.carriers[face.carrier]
    handles = 0
    if isinstance(carrier, Torus):
        handles = genus([winding(carrier, edges, p, face.outward) for p in face.loops])
    return 2 - 2 * handles - len(face.loops)


def refuse_wrong_turning(
    member: Member,
    faces: Sequence[RawFace],
    edges: Sequence[RawEdge],
    points: Array,
    track_of: Callable[[int], Track],
    poles: Poles,
    integrals: Sequence[FaceIntegrals],
    apexes: Sequence[Vertex],
) -> None:
    """Raise GeometryError where a face is not what its loops bound.

    Args:
        member: the region.
        faces, edges, points: its faces, edges and vertices (n, 3).
        track_of: quadrature of an edge by index.
        poles: for spheres with edges, by carrier and side, directions away from them.
        integrals: of the faces.
        apexes: those inside faces, as vertices.
    """
    form, sampled = member.form, sampler(edges, track_of)
    covered = [k for apex in apexes for k in apex.faces]
    around: defaultdict[tuple[int, int, int], float] = defaultdict(float)
    for index, (face, integral) in enumerate(zip(faces, integrals, strict=True)):
        if not face.loops:
            continue
        carrier = form.carriers[face.carrier]
        pole = poles.get((face.carrier, face.outward))
        found = turning(face, carrier, edges, sampled, pole, 10 * form.tolerance)
        if found is None:
            continue
        inside = covered.count(index)
        if carrier.needs_pole:
            inside = 2 * integral.wholes
        _refuse_turns(member, face, found, inside, characteristic(face, member, edges))
        for vertex, angle in found.corners:
            if np.isfinite(angle):
                around[vertex, face.carrier, face.outward] += angle
    for (vertex, index, _), angle in around.items():
        if angle > 2 * np.pi + ANGLE_ROOM:
            raise GeometryError(
                f"region {member.name!r}: its boundary was not found: the faces on "
                f"{form.carrier_name(index)} have angles of {np.degrees(angle):.6g} degrees "
                "together at {at}, more than a full turn",
                at=points[vertex],
            )


def _refuse_turns(
    member: Member, face: RawFace, found: Turning, inside: int, expected: int
) -> None:
    most = found.turns + inside
    if not most - found.cusps <= expected <= most:
        raise GeometryError(
            f"region {member.name!r}: its boundary was not found: the loops of the face on "
            f"{member.form.carrier_name(face.carrier)} near {{at}} turn as around "
            f"a face of Euler characteristic {most}, not {expected}",
            at=face.point,
        )


def refuse_wrong_volume(
    member: Member,
    faces: Sequence[RawFace],
    edges: Sequence[RawEdge],
    track_of: Callable[[int], Track],
    poles: Poles,
    integrals: Sequence[FaceIntegrals],
    volume: float,
    error: float,
) -> None:
    """Raise GeometryError if another vector field gives another volume.

    Args:
        member, faces, edges, track_of, poles, integrals: see `refuse_wrong_turning`.
        volume: of the region.
        error: of the volume.
    """
    form, second = member.form, 0.0
    for face, integral in zip(faces, integrals, strict=True):
        carrier = form.carriers[face.carrier]
        if isinstance(carrier, Torus):
            halves = [half for loop in face.loops for half in loop]
            signed = [(float(face.outward * h.direction), track_of(h.edge)) for h in halves]
            border = torus_border(face, carrier, edges, signed)
            flux = torus_flux(carrier, border, form.centre, integral.wholes)
        else:
            pole = poles.get((face.carrier, face.outward))
            flux = second_flux(carrier, _border(face, track_of), form.centre, pole, integral.wholes)
        second += face.outward * flux
    area = sum(integral.area for integral in integrals)
    if not abs(second - volume) <= ERRORS * error + AGREEMENT * area * form.scale:
        raise GeometryError(
            f"region {member.name!r}: its boundary was not found: its volume is {volume:.9g} by "
            f"one vector field and {second:.9g} by another"
        )


def _border(face: RawFace, track_of: Callable[[int], Track]) -> Track:
    """Quadrature along all loops of a face."""
    halves = [half for loop in face.loops for half in loop]
    tracks = [track_of(half.edge) for half in halves]
    steps = [
        face.outward * half.direction * track.steps
        for half, track in zip(halves, tracks, strict=True)
    ]
    none = np.empty((0, 3))
    points = [track.points for track in tracks]
    return Track(np.concatenate([none, *points]), np.concatenate([none, *steps]))
