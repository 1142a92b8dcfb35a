"""Which regions of a model touch each other along a surface."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from decomp.boundary.faces import RawFace
from decomp.boundary.wedges import Star
from decomp.csg.halfspaces import HalfSpaceForm
from decomp.vectors import Bools


def touching_regions(
    form: HalfSpaceForm, stars: Sequence[Star], whole_faces: Iterable[RawFace]
) -> tuple[tuple[int, int], ...]:
    """Pairs of regions, lower index first, that fill the two sides of a common piece of surface.

    Such a piece ends at an arc, where two neighbouring wedges are filled by the two regions, or it
    is a whole sphere or torus.

    Args:
        form: of the model.
        stars: the surroundings of all arcs.
        whole_faces: the faces of all regions that have no edge.
    """
    found: set[tuple[int, int]] = set()
    for star in stars:
        found.update(_pairs(star.filled, np.roll(star.filled, -1, axis=0)))
    for face in whole_faces:
        inside = np.repeat((form.signed_distances(face.point) < 0)[None], 2, axis=0)
        inside[:, face.carrier] = (True, False)
        filled = form.program.evaluate(inside)
        found.update(_pairs(filled[:1], filled[1:]))
    return tuple(sorted(found))


def _pairs(here: Bools, there: Bools) -> Iterable[tuple[int, int]]:
    for a, b in zip(here, there, strict=True):
        for i in np.flatnonzero(a & ~b):
            for j in np.flatnonzero(b & ~a):
                yield min(int(i), int(j)), max(int(i), int(j))
