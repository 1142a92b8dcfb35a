"""Pictures (.png) of scenes: cut open or not, with names, lengths and directions."""

from __future__ import annotations

import io
from dataclasses import dataclass, field

import numpy as np
from PIL import Image

from decomp.complex.model import OPPOSITE_SIDES
from decomp.drawing.camera import ASLANT, fitted
from decomp.drawing.colouring import Shown, shown
from decomp.drawing.colours import rgb
from decomp.drawing.cutting import kept, sections
from decomp.drawing.lettering import layout, lettered
from decomp.drawing.of_mesh import hull
from decomp.drawing.raster import Triangles, joined, painted
from decomp.drawing.scene import Body, Scene
from decomp.errors import InputError
from decomp.meshes.incidence import row_keys
from decomp.tolerance import TINY
from decomp.vectors import Array, Bools, Ints, cross, norm

PICTURE_WIDTH, PICTURE_HEIGHT, PAINTED_FINER = 1200, 900, 2
"""Size of pictures if none is given, and how much finer they are painted, to be smooth."""
DRAWING_MARGIN = 0.05
"""Share of the drawing left free on each side."""
CREASE = 25.0
"""Skeletons have lines where triangles meet at more than this angle in degrees."""
ON_PLANE = 1e-9
"""Points nearer to a plane than this part of the model's extent are on it."""


@dataclass(frozen=True)
class Clip:
    """What is nearer to the eye than a plane is left away.

    Args:
        axis: 0, 1 or 2, that the plane is across.
        at: where, in the model's coordinates; None for its middle.
        whole: leave whole tetrahedra, by their middles, instead of cutting them.
    """

    axis: int
    at: float | None = None
    whole: bool = False


@dataclass(frozen=True, eq=False)
class Look:
    """How a picture is taken.

    Args:
        eye: the way from the model to the eye, of any length.
        clip: where it is cut; None for nowhere.
        width, height: in pixels.
    """

    eye: Array = field(default_factory=lambda: np.array(ASLANT))
    clip: Clip | None = None
    width: int = PICTURE_WIDTH
    height: int = PICTURE_HEIGHT


def encoded(scene: Scene, look: Look) -> bytes:
    """The contents of a file: the sheets of a skeleton, or the cells of a mesh.

    Raises:
        InputError: the plane leaves nothing.
    """
    parts = shown(scene)
    triangles = _clipped(scene, parts, look)
    names = list(dict.fromkeys((each.label, each.colour) for each in parts))
    place = layout(names, look.width, look.height)
    size = np.array([place.column, place.foot], dtype=np.float64)
    low, high = DRAWING_MARGIN * size, (1 - DRAWING_MARGIN) * size
    points = triangles.corners.reshape(-1, 3)
    fine = fitted(points, look.eye, PAINTED_FINER * low, PAINTED_FINER * high)
    image = painted(triangles, fine, PAINTED_FINER * look.width, PAINTED_FINER * look.height)
    picture = Image.fromarray(_smaller(image))
    lettered(picture, place, fitted(points, look.eye, low, high))
    stream = io.BytesIO()
    picture.save(stream, "png", optimize=True)
    return stream.getvalue()


def _smaller(image: Array) -> np.ndarray:
    """An image in its final size, with smooth edges, in bytes."""
    height, width = image.shape[0] // PAINTED_FINER, image.shape[1] // PAINTED_FINER
    small = image.reshape(height, PAINTED_FINER, width, PAINTED_FINER, 3).mean(axis=(1, 3))
    return np.asarray(255 * np.clip(small, 0, 1) + 0.5).astype(np.uint8)


def _clipped(scene: Scene, parts: list[Shown], look: Look) -> Triangles:
    """All triangles that are left."""
    clip, body = look.clip, scene.body
    if clip is None:
        return _surfaces(scene, parts)
    least, most = (float(end(scene.points[:, clip.axis])) for end in (np.min, np.max))
    origin = float(scene.origin[clip.axis])
    at = (least + most) / 2 if clip.at is None else clip.at - origin
    away = 1.0 if look.eye[clip.axis] >= 0 else -1.0
    reach = ON_PLANE * float(np.ptp(scene.points, axis=0).max(initial=0.0))
    distance = away * (at - scene.points[:, clip.axis])
    distance[np.abs(distance) <= reach] = 0.0
    if body is not None and clip.whole:
        rows = np.flatnonzero(distance[body.tets].mean(axis=1) >= 0)
        return _left(_hull_of(scene, parts, body, rows), clip, least + origin, most + origin)
    rows = np.concatenate([each.part.triangles for each in parts])
    left = kept(_surfaces(scene, parts), distance[rows], within=body is None)
    if body is not None:
        colours = _by_part(parts, body)[body.part]
        left = joined([left, sections(scene.points[body.tets], distance[body.tets], colours)])
    return _left(left, clip, least + origin, most + origin)


def _left(triangles: Triangles, clip: Clip, least: float, most: float) -> Triangles:
    """The same, unless there are none.

    Raises:
        InputError: so it is.
    """
    if len(triangles.corners):
        return triangles
    name = "xyz"[clip.axis]
    where = "its middle" if clip.at is None else f"{name} = {clip.at:g}"
    raise InputError(
        f"cut at {where}, nothing is left to be seen: it reaches from {name} = {least:g} to "
        f"{most:g}, and the side nearer to the eye is cut away"
    )


def _surfaces(scene: Scene, parts: list[Shown]) -> Triangles:
    """The whole surfaces: each side of an element is a line, of skeletons the creases."""
    found = []
    for each in parts:
        corners = scene.corners(each.part)
        lines = scene.body is not None
        sides = np.ones((len(corners), 3), dtype=np.bool_)
        if not lines:
            sides = creases(scene.points, each.part.triangles)
        found.append(Triangles(corners, sides, np.tile(rgb(each.colour), (len(corners), 1))))
    return joined(found)


def _hull_of(scene: Scene, parts: list[Shown], body: Body, rows: Ints) -> Triangles:
    """The surface of some tetrahedra."""
    faces, owner = hull(body, rows)
    sides = np.ones((len(faces), 3), dtype=np.bool_)
    return Triangles(scene.points[faces], sides, _by_part(parts, body)[body.part[owner]])


def _by_part(parts: list[Shown], body: Body) -> Array:
    """Colours (p, 3) of the parts that tetrahedra are in."""
    result = np.ones((int(body.part.max(initial=-1)) + 1, 3))
    for each in parts:
        result[each.number] = rgb(each.colour)
    return result


def creases(points: Array, triangles: Ints) -> Bools:
    """Which sides (k, 3) of triangles are borders, or bend by more than CREASE."""
    corners = points[triangles]
    normal = cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normal /= np.maximum(norm(normal), TINY)[:, None]
    keys = row_keys(triangles[:, OPPOSITE_SIDES].reshape(-1, 2))
    order = np.argsort(keys, kind="stable")
    _, first, count = np.unique(keys[order], return_index=True, return_counts=True)
    pair = first[count == 2]
    one, two = order[pair], order[pair + 1]
    bend = (normal[one // 3] * normal[two // 3]).sum(axis=1)
    flat = bend >= np.cos(np.radians(CREASE))
    result = np.ones(len(keys), dtype=np.bool_)
    result[one[flat]] = result[two[flat]] = False
    return result.reshape(-1, 3)
