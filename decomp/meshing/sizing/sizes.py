"""How long edges should be, and where: by the user, the model's file, curvature and thickness."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import partial
from math import pi, sqrt

import numpy as np

from decomp.arguments import whole
from decomp.carriers import Carrier
from decomp.errors import InputError
from decomp.geometry import Geometry
from decomp.meshes.reasons import Reason
from decomp.meshing.sizing.features import thickness
from decomp.meshing.sizing.size_places import Place, SizeFunction
from decomp.meshing.sizing.wishes import Lengths, Wish, Wishes, joined
from decomp.meshing.surface.layout import samples
from decomp.meshing.surface.surface import MeshSurface
from decomp.tolerance import TINY
from decomp.vectors import Array, cross, norm, positive
from decomp.vectors import number as finite

PART_OF_MODEL, PART_OF_REGION = 20.0, 12.0
"""By default edges are at most this part of the model's, or of their region's, diagonal."""
VOLUME_CHANGE, VOLUME_ASKED = 3e-3, 1.4e-3
"""Where edges of the wanted length would change a region's volume by more than the first part of
it, they are made so short that it is the second: meshers leave edges up to 4/3 as long."""
LEAST_BY_CURVATURE = 1 / 12
"""Curvature alone makes edges no shorter than this part of the largest."""
VOLUME_LOST = 0.3
"""Faces bent inwards do not quite gain what others lose: this part of all may be lost."""
EDGE_OF_THICKNESS = 4.0
"""Edges are at most so many times as long as the part that they are in is thick."""
FIELD_LOOKS = 20_000
"""In each region's box a field is looked at in so many places."""
EVEN_WALL, ROUGH = 0.85, 1.2
"""Edges about as long as the part is thick, up to the second of these parts of it, are made as long
as the first: the skeleton halves walls, and tetrahedra over half of one would all come out flat."""
FLAT_FACE = 1e-12
"""Curvature, times the largest edge, up to which a face is flat there."""


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
        of_regions: lengths in regions by their names, which go before `size` and the default.
        places: where edges are to be shorter.
        everywhere: lengths wanted, by the place.
        offset: (3,) what points are counted from, for both.
        far: the end, of models that have been changed there.

    Raises:
        InputError: one is no number, or out of its range.
    """

    size: float | None = None
    layers: int | None = None
    per_circle: float | None = None
    of_regions: Mapping[str, float] = field(default_factory=dict)
    places: tuple[Place, ...] = ()
    everywhere: SizeFunction | None = None
    offset: Array = field(default_factory=lambda: np.zeros(3))
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


def region_sizes(geometry: Geometry, wanted: Wanted) -> Array:
    """The length asked for in each region: the user's, the file's `maxh`, or a default.

    Raises:
        InputError: the model fits into the length asked for.
    """
    for size in filter(None, (wanted.size, *wanted.of_regions.values())):
        if size >= geometry.diagonal:
            raise InputError(
                f"size {size:g} is an edge's length in the model's units, and must be below the "
                f"model's diagonal, {geometry.diagonal:.4g}"
            )
    found = []
    for boundary, region in zip(geometry.regions, geometry.model.regions, strict=True):
        default = min(geometry.diagonal / PART_OF_MODEL, boundary.diagonal / PART_OF_REGION)
        length = default if wanted.size is None else wanted.size
        given = region.options.get("maxh")
        length = length if given is None else min(length, given)
        length = wanted.of_regions.get(region.name, length)
        if wanted.far is not None and wanted.far.region == region.name:
            length = wanted.far.size
        found.append(length)
    return np.array(found)


def wishes(geometry: Geometry, surface: MeshSurface, wanted: Wanted) -> Wishes:
    """All wishes: of regions and faces, for curvature and thin parts, and at places."""
    largest = region_sizes(geometry, wanted)
    mesh = surface.complex
    found: list[Wish] = []
    for number, region in enumerate(surface.regions):
        length = float(largest[number])
        whole = _region_reason(geometry, wanted, number, length)
        patches = [p for sides in region.face_sides for p, _ in sides] + list(region.sheets)
        triangles = np.concatenate([mesh.patches[p].triangles for p in patches])
        some, _ = samples(mesh.points, triangles, length)
        found.append((some, np.full(len(some), length), whole))
        found += _curved(surface, number, length, wanted, whole)
        some, thick = thickness(geometry, surface, number, length)
        own = _across(thick, length, wanted.layers)
        thin = Reason(f"{'thickness' if wanted.layers is None else 'layers'} of {region.name}")
        found.append((some, own, ((own < length).astype(np.int64), (whole, thin))))
    return joined(*_asked_for(geometry, wanted, found, float(largest.max())))


def _region_reason(geometry: Geometry, wanted: Wanted, number: int, size: float) -> Reason:
    """What the length all over a region comes from."""
    region = geometry.model.regions[number]
    if region.name in wanted.of_regions or size == region.options.get("maxh"):
        return Reason(f"size of {region.name}", True)
    return Reason("size" if size == wanted.size else f"default of {region.name}", True)


def _asked_for(
    geometry: Geometry, wanted: Wanted, found: list[Wish], most: float
) -> tuple[list[Wish], list[tuple[Lengths, Reason]]]:
    """Wishes with those at places and of a field, none longer; and what is wanted everywhere."""
    everywhere: list[tuple[Lengths, Reason]] = []
    for place in wanted.places:
        why = Reason(place.what)
        middle = (place.low + place.high)[None] / 2 - wanted.offset
        if place.length < most:
            found = [*found, (middle, np.array([place.length]), why)]
        everywhere.append((partial(place.lengths, offset=wanted.offset), why))
    if wanted.everywhere is not None:
        why, lengths = Reason("size_field"), wanted.everywhere
        spots = np.concatenate([_inside(geometry), *(points for points, *_ in found)])
        own = lengths(spots + wanted.offset)
        found = [*found, (spots[own < most], own[own < most], why)]
        everywhere.append((lambda points: lengths.anywhere(points + wanted.offset), why))
    return found, everywhere


def _inside(geometry: Geometry, seed: int = 0) -> Array:
    """Points (n, 3) all over the regions, at which a field is looked at."""
    random = np.random.default_rng(seed)
    found = []
    for number, region in enumerate(geometry.regions):
        low, high = np.array(region.bounds)
        points = random.uniform(low, high, size=(FIELD_LOOKS, 3))
        found.append(points[geometry.index.region_of(points) == number])
    return np.concatenate(found)


def _across(thick: Array, largest: float, layers: int | None) -> Array:
    """Lengths (n,) where parts are so thick (n,)."""
    most = EDGE_OF_THICKNESS if layers is None else min(EDGE_OF_THICKNESS, 1 / layers)
    own = np.minimum(most * thick, largest)
    about = (own > EVEN_WALL * thick) & (own <= ROUGH * thick)
    return np.where(about, EVEN_WALL * thick, own)


def _curved(
    surface: MeshSurface, number: int, largest: float, wanted: Wanted, whole: Reason
) -> list[Wish]:
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
            own = np.minimum(own, 2 * pi / wanted.per_circle / np.maximum(bend, TINY))
        own = np.maximum(own, LEAST_BY_CURVATURE * largest)
        share = (area / np.bincount(which, minlength=len(area)))[which]
        lost = face.outward * float((share * own**2 * (low + high)).sum()) / 16
        change, total = change + lost, total + abs(lost)
        if limit is not None:
            own = np.minimum(own, limit)
        name = f"{region.name}/{face.name}"
        reasons = (whole, Reason(f"curvature of {name}"), Reason(f"size of {name}"))
        which = np.where(own < largest, 1 if limit is None else np.where(own < limit, 1, 2), 0)
        found.append((some, own, bend, which, reasons))
    content = abs(region.boundary.volume)
    change, part = abs(change) / content, VOLUME_LOST * total / content
    shrunk = 1.0
    chosen = wanted.size is not None or region.name in wanted.of_regions
    if not chosen and wanted.per_circle is None:
        if change > VOLUME_CHANGE:
            shrunk = sqrt(VOLUME_ASKED / change)
        if part > VOLUME_CHANGE:
            shrunk = min(shrunk, sqrt(VOLUME_CHANGE / part))
    wishes: list[Wish] = []
    for some, own, bend, which, reasons in found:
        bent = (bend > FLAT_FACE / largest) & (shrunk < 1.0)
        lengths = np.where(bent, shrunk * own, own)
        wishes.append((some, lengths, (np.where(bent, 1, which), reasons)))
    return wishes


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
