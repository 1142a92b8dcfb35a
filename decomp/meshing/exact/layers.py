"""Layers: where a region is thin between two others, told by how far their faces are apart.

Where faces touch, a layer between them gets thinner than any tolerance towards the contact, and
beyond it the two others meet directly: there its thickness is negative.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from decomp.complex.many_elements import Elements
from decomp.meshing.exact.targets import SURFACE, placed
from decomp.meshing.surface.cells import OUTSIDE
from decomp.meshing.surface.layout import Layout
from decomp.meshing.surface.surface import MeshSurface
from decomp.vectors import Array, Bools, Ints, dot, norm

ALONGSIDE = -0.97
"""Faces lie along each other where the cosine between the ways out of a layer is below this."""

Walls = tuple[tuple[int, int], ...]
"""Patches, each with +1 where its normal points out of a layer, else -1."""


@dataclass(frozen=True)
class Layer:
    """A region, or the outside, between two others.

    Args:
        region: the layer's, OUTSIDE for that.
        one, two: the others; the second may be OUTSIDE.
        walls: towards the first, and towards the second.
        lines: along which patches of both meet.
    """

    region: int
    one: int
    two: int
    walls: tuple[Walls, Walls]
    lines: tuple[int, ...]


@dataclass(frozen=True, eq=False)
class Across:
    """Places on both walls of a layer.

    Args:
        feet: (2, k, 3) the nearest places on the walls.
        thickness: (k,) from the first to the second, negative where they are beyond each other.
        gaps: (2, k) how far points are from the walls.
        facing: (k,) whether the walls lie along each other.
    """

    feet: Array
    thickness: Array
    gaps: Array
    facing: Bools


def layers(surface: MeshSurface, plan: Layout) -> list[Layer]:
    """All layers that a model could have."""
    walls: dict[tuple[int, int], list[tuple[int, int]]] = {}
    for number, region in enumerate(surface.regions):
        for face in region.face_sides:
            for patch, sign in face:
                sides = plan.sides[patch]
                other = next((r for r, _ in sides if r != number), OUTSIDE)
                walls.setdefault((number, other), []).append((patch, sign))
                if other == OUTSIDE:
                    walls.setdefault((OUTSIDE, number), []).append((patch, -sign))
    found = []
    for own, one in walls:
        for two in range(OUTSIDE, one):
            if two != own and (own, two) in walls:
                both = tuple(walls[own, one]), tuple(walls[own, two])
                found.append(Layer(own, one, two, both, _lines(plan, *both)))
    return found


def _lines(plan: Layout, one: Walls, two: Walls) -> tuple[int, ...]:
    """The lines around which there are patches of both walls."""
    sets = [{patch for patch, _ in wall} for wall in (one, two)]
    return tuple(
        number
        for number, around in enumerate(plan.around_line)
        if all(own & set(around) for own in sets)
    )


def across(layer: Layer, elements: Elements, corners: Array, points: Array) -> Across:
    """How thick a layer is.

    Args:
        layer: which.
        elements: of the complex.
        corners: (p, 3) the complex's points.
        points: (k, 3) asked.
    """
    feet, ways, gaps = (
        np.stack(each)
        for each in zip(
            *(_nearest(wall, elements, corners, points) for wall in layer.walls), strict=True
        )
    )
    facing = dot(ways[0], ways[1]) < ALONGSIDE
    return Across(feet, dot(feet[1] - feet[0], ways[1]), gaps, facing)


def _nearest(
    wall: Sequence[tuple[int, int]], elements: Elements, corners: Array, points: Array
) -> tuple[Array, Array, Array]:
    """The nearest places (k, 3) on some patches' surfaces, the ways (k, 3) out, and how far."""
    count = len(points)
    feet, ways, away = np.zeros((count, 3)), np.zeros((count, 3)), np.full(count, np.inf)
    signs: dict[int, int] = {int(elements.of_patch[patch]): sign for patch, sign in wall}
    for element, sign in signs.items():
        numbers: Ints = np.full(count, element)
        on, good = placed(elements, corners, np.full(count, SURFACE), numbers, points)
        gap = np.where(good, norm(on - points), np.inf)
        rows = np.flatnonzero(gap < away)
        feet[rows], away[rows] = on[rows], gap[rows]
        if len(rows):
            ways[rows] = sign * elements.normal(numbers[rows], on[rows])
    return feet, ways, away
