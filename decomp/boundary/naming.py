"""Names of faces, from the primitives that made them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

import numpy as np

from decomp.boundary.faces import RawFace
from decomp.boundary.member import Member
from decomp.csg.halfspaces import Placed
from decomp.csg.options import Options
from decomp.vectors import Array


def face_names(
    faces: Sequence[RawFace], probes: Sequence[Array], member: Member
) -> list[tuple[str, Options]]:
    """A unique name and the options for every face.

    A face bears the name of the first primitive that has it on its own boundary. Where several
    faces would bear one name, `@2`, `@3`... is added in order.

    Args:
        faces: the region's faces.
        probes: for each face some points (k, 3) inside it.
        member: the region.
    """
    form = member.form
    used = range(len(form.placed)) if member.region is None else form.used[member.region]
    by_carrier: dict[int, list[tuple[str, Placed]]] = {}
    for index in used:
        for side in form.placed[index].sides:
            by_carrier.setdefault(side.carrier, []).append((side.name, form.placed[index]))
    named = [
        _owner(by_carrier[face.carrier], face.carrier, points, member)
        for face, points in zip(faces, probes, strict=True)
    ]
    counts: Counter[str] = Counter()
    result = []
    for name, options in named:
        counts[name] += 1
        result.append((name if counts[name] == 1 else f"{name}@{counts[name]}", options))
    return result


def _owner(
    owners: Sequence[tuple[str, Placed]], carrier: int, points: Array, member: Member
) -> tuple[str, Options]:
    distances = member.form.signed_distances(points)
    for name, placed in owners:
        if _on_primitive(placed, carrier, distances, member.form.tolerance):
            return name, placed.options
    return owners[0][0], owners[0][1].options


def _on_primitive(placed: Placed, carrier: int, distances: Array, tolerance: float) -> bool:
    """Whether any of some points on a carrier lies on the primitive's own boundary.

    Args:
        placed: the primitive.
        carrier: index of the carrier.
        distances: signed distances (k, n_carriers) of the points.
        tolerance: how far outside the primitive a point may be.
    """
    on = np.ones(len(distances), dtype=np.bool_)
    for side in placed.sides:
        if side.carrier != carrier:
            distance = distances[:, side.carrier]
            on &= (distance if side.inside else -distance) < tolerance
    return bool(on.any())
