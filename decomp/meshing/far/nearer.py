"""Models with their far end brought near: a small part in a wide box, or ball, of air.

A mesher's time grows with the square of the ratio between the model and its smallest feature. Where
nothing but one region is between the parts and the end of the model, that end can be brought near
for the mesher, and what lies between put back afterwards (`sweeping`). It must be a convex body of
planes, or a ball: its image under a scaling about a place inside has faces of the same kinds.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from decomp.boundary.topology import RegionBoundary
from decomp.carriers import Carrier, Plane, Sphere
from decomp.csg.model import Model
from decomp.csg.primitive import Primitive
from decomp.csg.solid import (
    Complement,
    Copies,
    Difference,
    Intersection,
    Labelled,
    Solid,
    Transformed,
    Union,
    walk,
)
from decomp.geometry import Geometry
from decomp.meshing.sizing.sizes import PART_OF_REGION, FarEnd, Wanted, region_sizes
from decomp.vectors import Array, norm

END_ROOM = 3.0
"""The end is brought to so many times the radius of all that is inside it."""
WORTH = 3.0
"""It is left where it is unless it comes nearer by this factor."""
SHORTEST_SWEPT = 0.17
"""Edges shorter than this part of the way to the end are not for a sweep: its own are longer."""
NEAR_END_EDGES = 0.7
"""Edges of the near end are at most this part of the length asked for, for they get diagonals."""
SAME_RELATIVE = 1e-9
"""Relative: volumes, and places in parts of the diagonal, that differ by less are the same."""


@dataclass(frozen=True, eq=False)
class Nearer:
    """A model with its far end brought near.

    Args:
        geometry: with the near end.
        wanted: for it.
        region: the number of what is before the end.
        faces: names of the end's faces.
        centre: (3,) of the scaling, in the coordinates of the given geometry.
        factor: that puts the end back in its place.
        size: the length asked for in the region, in the given geometry.
    """

    geometry: Geometry
    wanted: Wanted
    region: int
    faces: tuple[str, ...]
    centre: Array
    factor: float
    size: float


@dataclass(frozen=True, eq=False)
class _End:
    """The end of a model: some faces of one region, of planes or one ball.

    Args:
        region: its number.
        faces: theirs.
        sides: their carriers, with +1 where these point out.
        volume: of what they enclose.
    """

    region: int
    faces: tuple[int, ...]
    sides: tuple[tuple[Carrier, int], ...]
    volume: float

    @property
    def carriers(self) -> tuple[Carrier, ...]:
        """Of its faces."""
        return tuple(carrier for carrier, _ in self.sides)

    def way_from(self, place: Array) -> float:
        """How far it is at least from a place inside; negative outside."""
        return float(min(-s * each.signed_distance(place[None])[0] for each, s in self.sides))


def brought_near(geometry: Geometry, wanted: Wanted) -> Nearer | None:
    """Bring a model's far end near; None if it has none that can be.

    Args:
        geometry: in its own coordinates.
        wanted: of its mesh.
    """
    end = _end(geometry)
    if end is None:
        return None
    inside = _inside(geometry, end)
    if not len(inside):
        return None
    centre = inside.mean(axis=0)
    radius = float(norm(inside - centre).max())
    way = end.way_from(centre)
    factor = way / (END_ROOM * radius)
    size = _size(geometry, end, wanted)
    if not factor > WORTH or size < SHORTEST_SWEPT * way:
        return None
    model = _moved(geometry.model, end.carriers, centre, factor, SAME_RELATIVE * geometry.diagonal)
    if model is None:
        return None
    near = Geometry(model)
    if not _is_same(geometry, near, end, factor):
        return None
    boundary = geometry.regions[end.region]
    names = tuple(boundary.faces[face].name for face in end.faces)
    far = FarEnd(
        boundary.name,
        NEAR_END_EDGES * size / factor,
        frozenset((boundary.name, name) for name in names),
    )
    return Nearer(near, replace(wanted, far=far), end.region, names, centre, factor, size)


def _size(geometry: Geometry, end: _End, wanted: Wanted) -> float:
    """The length asked for before the end: by the user or file, else as by its region alone."""
    boundary, region = geometry.regions[end.region], geometry.model.regions[end.region]
    asked = [boundary.faces[face].options.get("maxh") for face in end.faces]
    if wanted.size is None and region.options.get("maxh") is None and asked == [None] * len(asked):
        return boundary.diagonal / PART_OF_REGION
    own = float(region_sizes(geometry, wanted)[end.region])
    return float(min([own, *(length for length in asked if length is not None)]))


def _end(geometry: Geometry) -> _End | None:
    """The faces that enclose all else, if they are of the right kinds."""
    bounds = np.array([region.bounds for region in geometry.regions])
    low, high = bounds[:, 0].min(axis=0), bounds[:, 1].max(axis=0)
    slack = SAME_RELATIVE * geometry.diagonal
    for number, boundary in enumerate(geometry.regions):
        for faces in _components(boundary):
            carriers = tuple(boundary.carriers[boundary.faces[face].carrier] for face in faces)
            flat = all(each.flat for each in carriers)
            if not flat and not (len(faces) == 1 and isinstance(carriers[0], Sphere)):
                continue
            points = _extremes(boundary, faces)
            reached = np.abs(np.array([points.min(axis=0), points.max(axis=0)]) - (low, high))
            outward = [boundary.faces[face].outward for face in faces]
            sides = tuple(zip(carriers, outward, strict=True))
            convex = all((s * c.signed_distance(points) < slack).all() for c, s in sides)
            if reached.max() < slack and (convex or not flat):
                volume = _volume(boundary, faces, points.mean(axis=0))
                return _End(number, tuple(faces), sides, volume)
    return None


def _components(boundary: RegionBoundary) -> list[list[int]]:
    """Faces that hang together by edges."""
    owner = list(range(len(boundary.faces)))
    for edge in boundary.edges:
        one, two = (owner[face] for face in edge.faces)
        owner = [one if each == two else each for each in owner]
    return [[k for k, own in enumerate(owner) if own == each] for each in sorted(set(owner))]


def _extremes(boundary: RegionBoundary, faces: Sequence[int]) -> Array:
    """Points (k, 3) of faces' edges; of faces without edges corners of their boxes."""
    points = [e.samples for e in boundary.edges if set(e.faces) <= set(faces)]
    for face in faces:
        carrier = boundary.carriers[boundary.faces[face].carrier]
        if carrier.closed and not boundary.faces[face].loops:
            way = carrier.width * np.concatenate([np.eye(3), -np.eye(3)])
            points.append(carrier.place + way)
    return np.concatenate([np.empty((0, 3)), *points])


def _volume(boundary: RegionBoundary, faces: Sequence[int], place: Array) -> float:
    """What faces of planes, or a ball, enclose: areas times their ways from a place."""
    total = 0.0
    for face in faces:
        carrier = boundary.carriers[boundary.faces[face].carrier]
        centre = place if carrier.flat else carrier.place
        way = abs(float(carrier.signed_distance(centre[None])[0]))
        total += boundary.faces[face].area * way / 3
    return total


def _inside(geometry: Geometry, end: _End) -> Array:
    """Points (k, 3) around all that is inside the end."""
    found = [np.empty((0, 3))]
    for number, boundary in enumerate(geometry.regions):
        if number == end.region:
            faces = [k for k in range(len(boundary.faces)) if k not in end.faces]
            found.append(_extremes(boundary, faces))
        else:
            low, high = boundary.bounds
            corners = np.array(np.meshgrid(*zip(low, high, strict=True))).reshape(3, -1).T
            found.append(corners)
    points = np.concatenate(found)
    if not len(points):
        return points
    low, high = points.min(axis=0), points.max(axis=0)
    return np.array(np.meshgrid(*zip(low, high, strict=True))).reshape(3, -1).T


def _moved(
    model: Model, carriers: Sequence[Carrier], centre: Array, factor: float, slack: float
) -> Model | None:
    """The model with the primitives of some carriers scaled down; None if they are not plain."""
    roots = [region.solid for region in model.regions]
    below = [node.part for node in walk(roots) if isinstance(node, (Transformed, Copies))]
    moved = {id(node) for node in walk(below)} if below else set()
    made: dict[int, Solid] = {}
    for node in walk(roots):
        made[id(node)] = _rebuilt(node, made)
        if isinstance(node, Primitive):
            on = [_is_among(carrier, carriers, slack) for _, carrier in node.half_spaces()]
            if any(on):
                if not all(on) or id(node) in moved:
                    return None
                made[id(node)] = node.scale(1 / factor, centre)
    regions = tuple(replace(region, solid=made[id(region.solid)]) for region in model.regions)
    return replace(model, regions=regions)


def _rebuilt(node: Solid, made: dict[int, Solid]) -> Solid:
    """A node over what its children have become."""
    children = [made[id(child)] for child in node.children()]
    if all(new is old for new, old in zip(children, node.children(), strict=True)):
        return node
    if isinstance(node, (Union, Intersection)):
        return replace(node, parts=tuple(children))
    if isinstance(node, Difference):
        return Difference(*children)
    if isinstance(node, (Complement, Labelled)):
        return replace(node, part=children[0])
    return node


def _is_among(carrier: Carrier, others: Sequence[Carrier], slack: float) -> bool:
    """Whether a plane or sphere is one of others."""
    for other in others:
        if isinstance(carrier, Plane) and isinstance(other, Plane):
            turned = norm(np.cross(carrier.normal_vector, other.normal_vector))
            away = abs(float(other.signed_distance(carrier.foot(np.zeros((1, 3))))[0]))
            if turned < SAME_RELATIVE and away < slack:
                return True
        if isinstance(carrier, Sphere) and isinstance(other, Sphere):
            away = float(norm(carrier.centre - other.centre))
            if away < slack and abs(carrier.radius - other.radius) < slack:
                return True
    return False


def _is_same(far: Geometry, near: Geometry, end: _End, factor: float) -> bool:
    """Whether nothing but the end has changed."""
    if len(near.regions) != len(far.regions):
        return False
    gone = end.volume * (1 - factor**-3)
    for number, (one, two) in enumerate(zip(far.regions, near.regions, strict=True)):
        if [face.name for face in one.faces] != [face.name for face in two.faces]:
            return False
        left = one.volume - (gone if number == end.region else 0.0)
        slack = SAME_RELATIVE * max(abs(one.volume), end.volume if number == end.region else 0.0)
        if one.euler != two.euler or abs(left - two.volume) > slack:
            return False
    return True
