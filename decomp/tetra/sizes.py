"""How long edges should be, and where: wishes at points, joined into one field.

A wish is a length at a point. Away from it lengths may grow by a fixed slope, and the least of all
that follows counts, so that neighbouring tetrahedra never differ much.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi, sqrt

import numpy as np
from scipy.spatial import cKDTree  # type: ignore[import-untyped]

from decomp.arguments import whole
from decomp.carriers import Carrier
from decomp.errors import InputError
from decomp.geometry import Geometry
from decomp.tetra.features import thickness
from decomp.tetra.layout import samples
from decomp.tetra.surface import MeshSurface
from decomp.vectors import Array, cross, norm, positive
from decomp.vectors import number as finite

PART_OF_MODEL, PART_OF_REGION = 20.0, 12.0
"""By default edges are at most this part of the model's, or of their region's, diagonal."""
VOLUME, ASKED = 3e-3, 1.4e-3
"""Where edges of the wanted length would change a region's volume by more than the first part of
it, they are made so short that it is the second: TetWild leaves edges up to 4/3 as long."""
SLOPE = 0.35
"""How much longer edges may get for each unit of way."""
LEAST = 1 / 12
"""Curvature alone makes edges no shorter than this part of the largest."""
CANCELLED = 0.3
"""Faces bent inwards do not quite gain what others lose: this part of all may be lost."""
THIN = 4.0
"""Edges are at most so many times as long as the part that they are in is thick."""
EVEN, ROUGH = 0.85, 1.2
"""Edges about as long as the part is thick, up to the second of these parts of it, are made as long
as the first: the skeleton halves walls, and tetrahedra over half of one would all come out flat."""
STEP = 1.25
"""Wishes are joined in classes of lengths that differ by this factor."""


@dataclass(frozen=True)
class FarEnd:
    """The end of a model that was brought near (`nearer`), and what is before it.

    Args:
        region: its name.
        size: length of edges in it.
        faces: of the end, each with its region's name; how they are bent asks for nothing.
    """

    region: str
    size: float
    faces: frozenset[tuple[str, str]]


@dataclass(frozen=True)
class Wanted:
    """What the user asks for.

    Args:
        size: length of edges, in model units, where nothing asks for shorter ones.
        layers: elements across thin parts.
        per_circle: edges around a full circle.
        far: the end, of models that have been changed there.

    Raises:
        InputError: one is no number, or out of its range.
    """

    size: float | None = None
    layers: int | None = None
    per_circle: float | None = None
    far: FarEnd | None = None

    def __post_init__(self) -> None:
        if self.size is not None:
            object.__setattr__(self, "size", positive(self.size, "size"))
        if self.layers is not None:
            layers = whole(self.layers, "layers")
            if layers > 100:
                raise InputError(f"layers must be from 1 to 100, got {layers}")
            object.__setattr__(self, "layers", layers)
        if self.per_circle is not None:
            count = finite(self.per_circle, "elements per circle")
            if not 3 <= count <= 10000:
                raise InputError(f"elements per circle must be from 3 to 10000, got {count:g}")
            object.__setattr__(self, "per_circle", count)


@dataclass(frozen=True, eq=False)
class Wishes:
    """Lengths (n,) wanted at points (n, 3)."""

    points: Array
    lengths: Array

    def at(self, places: Array) -> Array:
        """The field (k,) at places (k, 3): the least of all wishes, grown with the distance."""
        found = np.full(len(places), np.inf)
        least = float(self.lengths.min())
        classes = np.floor(np.log(self.lengths / least) / np.log(STEP)).astype(np.int64)
        for number in np.unique(classes).tolist():
            rows = classes == number
            length = least * STEP**number
            gap, _ = cKDTree(self.points[rows]).query(places)
            found = np.minimum(found, length + SLOPE * gap)
        return found


def region_sizes(geometry: Geometry, wanted: Wanted) -> Array:
    """The length asked for in each region: the user's, the file's `maxh`, or a default.

    Raises:
        InputError: the model fits into the length asked for.
    """
    if wanted.size is not None and wanted.size >= geometry.diagonal:
        raise InputError(
            f"size {wanted.size:g} is an edge's length in the model's units, and must be below the "
            f"model's diagonal, {geometry.diagonal:.4g}"
        )
    found = []
    for boundary, region in zip(geometry.regions, geometry.model.regions, strict=True):
        default = min(geometry.diagonal / PART_OF_MODEL, boundary.diagonal / PART_OF_REGION)
        length = default if wanted.size is None else wanted.size
        given = region.options.get("maxh")
        length = length if given is None else min(length, given)
        if wanted.far is not None and wanted.far.region == region.name:
            length = wanted.far.size
        found.append(length)
    return np.array(found)


def wishes(geometry: Geometry, surface: MeshSurface, wanted: Wanted) -> Wishes:
    """All wishes: regions' sizes, curved faces, faces' `maxh`, and layers across thin parts."""
    largest = region_sizes(geometry, wanted)
    mesh = surface.complex
    points, lengths = [], []
    for number, region in enumerate(surface.regions):
        length = float(largest[number])
        patches = [p for sides in region.face_sides for p, _ in sides] + list(region.sheets)
        triangles = np.concatenate([mesh.patches[p].triangles for p in patches])
        some, _ = samples(mesh.points, triangles, length)
        points.append(some)
        lengths.append(np.full(len(some), length))
        for some, own in _curved(geometry, surface, number, length, wanted):
            points.append(some)
            lengths.append(own)
        some, thick = thickness(geometry, surface, number, length)
        points.append(some)
        lengths.append(_across(thick, length, wanted.layers))
    return Wishes(np.concatenate(points), np.concatenate(lengths))


def _across(thick: Array, largest: float, layers: int | None) -> Array:
    """Lengths (n,) where parts are so thick (n,)."""
    most = THIN if layers is None else min(THIN, 1 / layers)
    own = np.minimum(most * thick, largest)
    about = (own > EVEN * thick) & (own <= ROUGH * thick)
    return np.where(about, EVEN * thick, own)


def _curved(
    geometry: Geometry, surface: MeshSurface, number: int, largest: float, wanted: Wanted
) -> list[tuple[Array, Array]]:
    """Wishes on the curved faces of a region and on faces with a `maxh`."""
    region = surface.regions[number]
    mesh = surface.complex
    found = []
    change = total = 0.0
    for index, sides in enumerate(region.face_sides):
        face = region.boundary.faces[index]
        if wanted.far is not None and (region.name, face.name) in wanted.far.faces:
            continue
        triangles = np.concatenate([mesh.patches[p].triangles for p, _ in sides])
        limit = face.options.get("maxh")
        spacing = largest if limit is None else min(largest, limit)
        some, which = samples(mesh.points, triangles, spacing)
        corners = mesh.points[triangles]
        area = norm(cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])) / 2
        low, high = curvatures(region.boundary.carriers[face.carrier], some)
        bend = np.maximum(np.abs(low), np.abs(high))
        own = np.full(len(some), largest)
        if wanted.per_circle is not None:
            own = np.minimum(own, 2 * pi / wanted.per_circle / np.maximum(bend, 1e-300))
        own = np.maximum(own, LEAST * largest)
        share = (area / np.bincount(which, minlength=len(area)))[which]
        lost = face.outward * float((share * own**2 * (low + high)).sum()) / 16
        change, total = change + lost, total + abs(lost)
        if limit is not None:
            own = np.minimum(own, limit)
        found.append((some, own, bend))
    content = abs(region.boundary.volume)
    change, part = abs(change) / content, CANCELLED * total / content
    shrunk = 1.0
    if wanted.size is None and wanted.per_circle is None:
        if change > VOLUME:
            shrunk = sqrt(ASKED / change)
        if part > VOLUME:
            shrunk = min(shrunk, sqrt(VOLUME / part))
    return [
        (some, np.where(bend > 1e-12 / largest, shrunk * own, own)) for some, own, bend in found
    ]


def curvatures(carrier: Carrier, points: Array) -> tuple[Array, Array]:
    """The two principal curvatures (n,) of a carrier near points (n, 3), the lower first.

    From the curvatures along four directions, which follow Euler's formula
    k(t) = mean + half the difference times cos 2(t - t0).
    """
    q = carrier.foot(points)
    normal = carrier.normal(q)
    axis = np.eye(3)[np.argmin(np.abs(normal), axis=1)]
    first = cross(normal, axis)
    first /= norm(first)[:, None]
    second = cross(normal, first)
    slant = (first + second) / sqrt(2), (first - second) / sqrt(2)
    with np.errstate(divide="ignore", invalid="ignore"):
        along = [carrier.normal_curvature(q, way) for way in (first, second, *slant)]
    # at a cone's apex there is none: it counts as flat there
    along = [np.where(np.isfinite(k), k, 0.0) for k in along]
    mean = (along[0] + along[1]) / 2
    half = np.hypot((along[0] - along[1]) / 2, (along[2] - along[3]) / 2)
    return np.asarray(mean - half), np.asarray(mean + half)
