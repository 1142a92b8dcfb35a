"""Which regions of a model touch each other along a surface, and which carriers are tangent."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import pairwise

import numpy as np

from decomp.boundary.arcs import Contact
from decomp.boundary.faces import RawFace
from decomp.boundary.wedges import SAME_DIRECTION, Star
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


def tangent_carriers(
    stars: Sequence[Star], contacts: Iterable[Contact]
) -> frozenset[frozenset[int]]:
    """Pairs of carriers that are tangent to each other along an arc or at a point.

    Args:
        stars: the surroundings of all arcs.
        contacts: points at which carriers are tangent.
    """
    found = {frozenset(contact.carriers) for contact in contacts}
    for star in stars:
        for one, two in pairwise((*star.sheets, star.sheets[0])):
            turn = abs((two.angle - one.angle + np.pi) % (2 * np.pi) - np.pi)
            if one.carrier != two.carrier and turn <= SAME_DIRECTION:
                found.add(frozenset((one.carrier, two.carrier)))
    return frozenset(found)


def _pairs(here: Bools, there: Bools) -> Iterable[tuple[int, int]]:
    for a, b in zip(here, there, strict=True):
        for i in np.flatnonzero(a & ~b):
            for j in np.flatnonzero(b & ~a):
                yield min(int(i), int(j)), max(int(i), int(j))
