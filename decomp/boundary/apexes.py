"""The apexes of cones that lie inside a face."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from decomp.boundary.faces import RawFace
from decomp.boundary.member import Member
from decomp.boundary.topology import Convexity, Vertex
from decomp.csg.halfspaces import HalfSpaceForm
from decomp.errors import GeometryError
from decomp.vectors import Array, norm

BESIDE_APEX = 1e-5
"""Which faces have an apex is asked on a ring around it, this part of the scale away."""


def apexes(
    form: HalfSpaceForm, member: Member, raw: Sequence[RawFace], points: Array
) -> tuple[Vertex, ...]:
    """The apexes of cones that lie inside a face."""
    result = []
    for index, cone in enumerate(form.carriers):
        if cone.tip is None:
            continue
        if len(points) and norm(points - cone.tip).min() <= 10 * form.tolerance:
            continue
        ring = cone.around_tip(BESIDE_APEX * form.scale)
        for outward in (1, -1):
            if member.is_face(index, outward, ring).all():
                here = [k for k, f in enumerate(raw) if (f.carrier, f.outward) == (index, outward)]
                convexity = Convexity.CONVEX if outward > 0 else Convexity.REENTRANT
                face = _apex_face(here, raw, cone.tip, member)
                result.append(Vertex(cone.tip, (face,), (), convexity))
    return tuple(result)


def _apex_face(here: Sequence[int], raw: Sequence[RawFace], tip: Array, member: Member) -> int:
    """Of the faces on a cone the one that reaches its apex: a way down a ruling stays inside."""
    if len(here) == 1:
        return here[0]
    for k in here:
        way = tip + np.linspace(0.01, 1, 50)[:, None] * (raw[k].point - tip)
        if member.is_face(raw[k].carrier, raw[k].outward, way).all():
            return k
    raise GeometryError(
        f"region {member.name!r}: no face of {member.form.carrier_name(raw[here[0]].carrier)} was "
        "found at its apex {at}",
        at=tip,
    )
