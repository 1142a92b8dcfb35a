"""Faces, edges and vertices of one region's boundary, and who touches whom."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from enum import Enum
from typing import Any

import numpy as np

from decomp.carriers import Carrier
from decomp.csg.options import Options
from decomp.curves.base import Curve
from decomp.errors import UnknownNameError
from decomp.near import listed, near
from decomp.shown import Shown
from decomp.tolerance import Tolerances
from decomp.vectors import Array


class Convexity(Enum):
    """How much of the surroundings of an edge or vertex the region fills.

    An edge is CONVEX where the interior angle is below 180 degrees, REENTRANT above, SMOOTH where
    two faces meet tangentially. A vertex is CONVEX or REENTRANT when all its edges (smooth ones
    aside) are, SMOOTH when all its edges are smooth, SADDLE otherwise.
    """

    CONVEX = "convex"
    REENTRANT = "reentrant"
    SMOOTH = "smooth"
    SADDLE = "saddle"

    def flipped(self) -> Convexity:
        """The same place seen from the complement."""
        swap = {Convexity.CONVEX: Convexity.REENTRANT, Convexity.REENTRANT: Convexity.CONVEX}
        return swap.get(self, self)


@dataclass(frozen=True, eq=False)
class Edge(Shown):
    """A piece of curve along which two faces meet.

    Args:
        curve: the untrimmed curve.
        start: first parameter.
        end: last parameter, above `start` (it may pass the end of a closed curve's domain).
        faces: the two faces, indices into the region's faces (the same one twice on a seam).
        carriers: their carriers, in the same order.
        vertices: indices of the end points, or None for a closed edge without vertex.
        convexity: CONVEX, REENTRANT or SMOOTH; constant along the edge.
        length: arc length.
        samples: points (k, 3) on the edge from start to end, dense enough to draw it.
    """

    curve: Curve
    start: float
    end: float
    faces: tuple[int, int]
    carriers: tuple[int, int]
    vertices: tuple[int, int] | None
    convexity: Convexity
    length: float
    samples: Array

    @property
    def closed(self) -> bool:
        """Whether the edge is a loop without a vertex."""
        return self.vertices is None

    def beyond(self, point: Array) -> float:
        """How far a point (3,) of the untrimmed curve is from the edge; 0 between its ends."""
        past = float(self.curve.parameter(point)) - self.start
        if self.curve.closed:
            past %= self.curve.period
        if self.closed or 0.0 <= past <= self.end - self.start:
            return 0.0
        return float(np.linalg.norm(self.samples[[0, -1]] - point, axis=1).min())

    def holds(self, point: Array, slack: float) -> bool:
        """Whether a point (3,) is on the edge, or off it by no more than `slack`."""
        on_curve = self.curve.point(self.curve.wrapped(self.curve.parameter(point)))
        return float(np.linalg.norm(on_curve - point)) <= slack and self.beyond(point) <= slack


@dataclass(frozen=True, eq=False)
class Vertex(Shown):
    """A point where edges end, or the apex of a cone inside a face."""

    point: Array
    faces: tuple[int, ...]
    edges: tuple[int, ...]
    convexity: Convexity


@dataclass(frozen=True, eq=False)
class Face(Shown):
    """A connected part of the boundary on one carrier.

    Args:
        name: `primitive.face`, unique within the region.
        carrier: index into the solid's carriers.
        outward: +1 if the region's outward normal is the carrier's, -1 if it is the opposite.
        area: to `RegionBoundary.area_error`.
        loops: bounding loops, each a sequence of (edge index, +1 or -1: along the edge or against
            it), the face on the left seen from outside the region; none for a whole sphere or
            torus.
        options: what the file said of it (`bc`, `maxh`...).
        point: a point in the interior of the face.
    """

    name: str
    carrier: int
    outward: int
    area: float
    loops: tuple[tuple[tuple[int, int], ...], ...]
    options: Options
    point: Array


@dataclass(frozen=True, eq=False)
class RegionBoundary(Shown):
    """The exact boundary of one region.

    Args:
        name: the region's name.
        carriers: the solid's carriers, shared by all its regions.
        faces: parts of its carriers.
        edges: curves where two faces meet.
        vertices: points where edges end.
        volume: of the region; negative for the unbounded outside of a model.
        volume_error: estimated error of the quadrature behind `volume`.
        area: of all faces.
        area_error: estimated error of `area`.
        bounds: corners (2, 3) of the axis-parallel box around the boundary.
        euler: Euler characteristic of the region as a solid, without the points where it touches
            itself.
        touches: says where it touches itself and what to do about it, once for each place. Such a
            region can be measured, asked and meshed, but has no skeleton.
    """

    name: str
    carriers: tuple[Carrier, ...]
    faces: tuple[Face, ...]
    edges: tuple[Edge, ...]
    vertices: tuple[Vertex, ...]
    volume: float
    volume_error: float
    area: float
    area_error: float
    bounds: Array
    euler: int
    touches: tuple[str, ...] = ()

    def _facts(self) -> Mapping[str, Any]:
        names = ("name", "faces", "edges", "vertices", "volume", "area", "euler")
        return {name: getattr(self, name) for name in names}

    def _table(self) -> tuple[Sequence[str], Iterable[Sequence[Any]]]:
        kinds = (type(self.carriers[face.carrier]).__name__ for face in self.faces)
        rows = ((f.name, kind, f.area) for f, kind in zip(self.faces, kinds, strict=True))
        return ("face", "surface", "area"), rows

    @property
    def tolerances(self) -> Tolerances:
        """What counts as one, made from its size."""
        return Tolerances(self.diagonal)

    @property
    def diagonal(self) -> float:
        """Length of the diagonal of `bounds`."""
        return float(np.linalg.norm(self.bounds[1] - self.bounds[0]))

    def face_named(self, name: str) -> Face:
        """The face with a given name.

        Raises:
            UnknownNameError: (a `KeyError`) there is none.
        """
        for face in self.faces:
            if face.name == name:
                return face
        names = [face.name for face in self.faces]
        hint = near(name, names) or f"; there are {listed(names)}"
        raise UnknownNameError(f"region {self.name} has no face {name!r}{hint}")
