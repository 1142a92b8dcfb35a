"""Sheets without a border, each over a whole face that has none either.

Such a sheet can come to reflexive loci in points, where it is pointed: these are vertices of it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np

from decomp.skeletons.balls.balls import Balls, inscribed_balls
from decomp.skeletons.curves.incidence import Incidence
from decomp.skeletons.sheets.drawn_sheets import SheetPart
from decomp.skeletons.sheets.sheet_surface import SheetSurface
from decomp.skeletons.sheets.trim_maker import BoundaryVertices
from decomp.tolerance import TINY
from decomp.vectors import Array, Ints, cross, dot, norm

Pair = tuple[int, int]


class ClosedSheetMaker:
    """Lifts triangulations of closed faces to their sheets.

    Args:
        incidence: of the region.
        boundary: the region's boundary in the complex.
        add: makes a point (3,) a vertex and returns its number.
    """

    def __init__(
        self,
        incidence: Incidence,
        boundary: BoundaryVertices,
        add: Callable[[Array], int],
    ) -> None:
        self._incidence = incidence
        self._boundary, self._add = boundary, add

    def sheets(
        self, known: set[Pair], kinks: Mapping[Pair, Sequence[int]], points: Array
    ) -> list[SheetPart]:
        """The sheets between pairs of sites that are not known.

        Args:
            known: pairs whose sheets are.
            kinks: vertices at which sheets of a pair are pointed.
            points: (n, 3) all vertices so far.
        """
        it, found = self._incidence, []
        boundary, known = it.boundary, set(known)
        for number, face in enumerate(boundary.faces):
            if face.loops:
                continue
            vertices, local = np.unique(self._boundary.of_face[number], return_inverse=True)
            feet = self._boundary.points[vertices]
            inward = it.inward(number, feet)
            balls = inscribed_balls(it.context, feet, inward)
            others = np.unique(balls.site)
            own = it.face_site[number]
            if len(others) != 1 or others[0] in (-1, own):
                continue
            other = int(others[0])
            pair = (min(own, other), max(own, other))
            if pair not in known:
                known.add(pair)
                pointed = np.array(kinks.get(pair, []), dtype=np.int64)
                triangles = local.reshape(-1, 3)
                part = self._lifted((own, other), feet, balls, triangles, pointed, points[pointed])
                found.append(part)
        return found

    def _lifted(
        self, sites: Pair, feet: Array, balls: Balls, triangles: Ints, pointed: Ints, at: Array
    ) -> SheetPart:
        """The sheet over a face's triangles (m, 3) of feet (k, 3), pointed at vertices (j,)."""
        own, other = sites
        slack = self._incidence.boundary.tolerances.at_end
        same = norm(balls.centre[:, None] - at[None]) <= slack
        numbers = np.array(
            [
                pointed[int(np.argmax(row))] if row.any() else self._add(point)
                for point, row in zip(balls.centre, same, strict=True)
            ],
            dtype=np.int64,
        )
        left = ~same.any(axis=0)
        pointed, at = pointed[left], at[left]
        more = self._incidence.feet(sites, at)
        near = np.concatenate([feet, more[:, 0]])
        for k in range(len(pointed)):
            triangles = with_vertex(near, triangles, len(numbers) + k)
        numbers = np.concatenate([numbers, pointed])
        both = np.stack([near, np.concatenate([balls.foot, more[:, 1]])], axis=1)
        # the face's normals point out, from the far site to the face
        if own < other:
            triangles = triangles[:, ::-1]
        else:
            both = both[:, ::-1]
        pair = (min(sites), max(sites))
        centres = np.concatenate([balls.centre, at])
        surface = SheetSurface(self._incidence, pair, centres, both)
        return SheetPart(pair, surface, numbers[triangles])


def with_vertex(points: Array, triangles: Ints, vertex: int) -> Ints:
    """Triangles (m + 2, 3) of a surface, the one that a point is closest to cut in three at it.

    Args:
        points: (n, 3), the new vertex among them.
        triangles: (m, 3).
        vertex: number of the point that is to be a vertex, close to the surface.
    """
    a, b, c = (points[triangles[:, k]] for k in range(3))
    p = points[vertex]
    normal = cross(b - a, c - a)
    area = np.maximum(dot(normal, normal), TINY)
    weights = [dot(cross(v - u, p - u), normal) / area for u, v in ((a, b), (b, c), (c, a))]
    # how far the point is outside a triangle's prism, then how far from its plane
    outside = np.maximum(-np.minimum.reduce(weights), 0.0)
    away = np.abs(dot(p - a, normal)) / np.sqrt(area)
    size = np.sqrt(norm(normal))
    best = int(np.argmin(outside * size + away))
    first, second, third = triangles[best].tolist()
    parts = [[first, second, vertex], [second, third, vertex], [third, first, vertex]]
    return np.concatenate([np.delete(triangles, best, axis=0), np.array(parts)])
