"""Walls as maximal balls at points of faces tell of them, where there is no skeleton.

The ball that touches a face at a point from inside touches the boundary elsewhere too, or rolls in
a bend of the face. Where that is across from the point there is a wall, as thick as the ball.
"""

from __future__ import annotations

import numpy as np

from decomp.geometry import Geometry
from decomp.meshing.sizing.wall import FACING, Wall, owners_and_meeting
from decomp.meshing.surface.layout import samples
from decomp.meshing.surface.surface import MeshSurface
from decomp.skeletons.balls.balls import balls_at
from decomp.skeletons.balls.probing import TOWARDS
from decomp.skeletons.balls.queries import region_queries
from decomp.skeletons.balls.shrinking import OSCULATES, TOUCHES
from decomp.tolerance import TINY
from decomp.vectors import Array, Bools, Ints, dot, norm

INSIDE_FACE = 1e-6
"""Points on faces are told from those beyond their edges this part of the diagonal inside."""
TOUCHED_ACROSS = 1e-3
"""What a ball that rolls in a bend touches across from its point is asked so many radii off its
centre, and is touched if it is no farther from this than so many radii more."""
CONE_SAMPLES = 24.0
"""How wide a cone is is looked for at points this part of the region's diagonal apart."""


def ball_walls(geometry: Geometry, surface: MeshSurface, number: int) -> list[Wall]:
    """The faces of a region."""
    made = _Balls(geometry, surface, number)
    found = []
    for face, sides in enumerate(surface.regions[number].face_sides):
        parts = [surface.complex.patches[patch].triangles for patch, _ in sides]
        triangles = np.concatenate([np.empty((0, 3), dtype=np.int64), *parts])
        found.append(Wall(triangles, _OnFace(made, face, triangles).measured))
    return found


class _Balls:
    """The balls in a region."""

    def __init__(self, geometry: Geometry, surface: MeshSurface, number: int) -> None:
        self.surface, self.boundary = surface, surface.regions[number].boundary
        self.queries = region_queries(geometry.index, number)
        self.owner, self._meeting = owners_and_meeting(surface, number)
        self._tangent = geometry.boundaries.tangent

    def facing(self, face: int, some: Array) -> tuple[Array, Array, Array, Array, Bools]:
        """Points (k, 3) of a face among some (n, 3) that have something across from them.

        With the centres (k, 3) of their balls, what these touch there (k, 3), how thick (k,) the
        wall is, and whether it is the face itself (k,) that is touched.
        """
        own = self.boundary.faces[face]
        carrier = self.boundary.carriers[own.carrier]
        q = carrier.project(np.unique(some, axis=0))
        inward = -own.outward * carrier.normal(q)
        # triangles reach beyond edges, and at an edge there is no ball
        least = INSIDE_FACE * self.boundary.diagonal
        inside, depth = self.queries.depth(q + least * inward)
        rows = np.flatnonzero(inside & (depth > least / 2))
        q, inward = q[rows], inward[rows]
        balls, state = balls_at(self.queries, q, inward, self.boundary.diagonal)
        centre, foot = balls.centre, np.array(balls.foot)
        good = state == TOUCHES
        bent = np.flatnonzero(state == OSCULATES)
        away = TOUCHED_ACROSS * balls.radius[bent]
        beyond = self.queries.nearest(centre[bent] + away[:, None] * inward[bent])
        foot[bent] = beyond.foot
        off = norm(beyond.foot - centre[bent])
        good[bent] = (beyond.site >= 0) & (off < (1 + TOUCHED_ACROSS) * balls.radius[bent])
        square = np.maximum(balls.radius, TINY) ** 2
        good &= dot(q - centre, foot - centre) < FACING * square
        rows = np.flatnonzero(good)
        q, centre, foot, radius = q[rows], centre[rows], foot[rows], balls.radius[rows]
        touched = self._faces(centre, foot)
        meet = [self._meet(face, other) for other in touched.tolist()]
        rows = np.flatnonzero((touched >= 0) & ~np.array(meet, dtype=np.bool_))
        return q[rows], centre[rows], foot[rows], 2 * radius[rows], touched[rows] == face

    def _meet(self, face: int, other: int) -> bool:
        """Whether there is no wall between two faces: they meet in an edge, or make a cusp."""
        faces = self.boundary.faces
        carriers = frozenset((faces[face].carrier, faces[other].carrier))
        return frozenset((face, other)) in self._meeting or carriers in self._tangent

    def _faces(self, centre: Array, foot: Array) -> Ints:
        """The faces (k,) that own the feet of balls, -1 where they are not found."""
        site = self.queries.nearest(centre + TOWARDS * (foot - centre)).site
        return np.where(site >= 0, self.owner[np.maximum(site, 0)], -1)


class _OnFace:
    """Balls at points of one face.

    The tip of a cone is a corner: there only what is at least half as wide as the widest counts.
    """

    def __init__(self, balls: _Balls, face: int, triangles: Ints) -> None:
        self._balls, self._face = balls, face
        self._least = 0.0
        boundary = balls.boundary
        if boundary.carriers[boundary.faces[face].carrier].tip is not None:
            points = balls.surface.complex.points
            some, _ = samples(points, triangles, boundary.diagonal / CONE_SAMPLES)
            *_, wide, same = balls.facing(face, some)
            self._least = float(wide[same].max(initial=0.0)) / 2

    def measured(self, some: Array) -> tuple[tuple[Array, ...], Array]:
        """See `Wall`: points of the face, the centres of their balls, and what is across."""
        q, centre, foot, wide, same = self._balls.facing(self._face, some)
        rows = ~same | (wide >= self._least)
        return (q[rows], centre[rows], foot[rows]), wide[rows]
