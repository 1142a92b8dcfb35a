"""One conforming triangulation of the boundaries of all regions of a model.

1. Edges are cut into pieces that regions share (`boundary_pieces`).
2. Pieces are sampled; where segments cross on a carrier, the longer one gets another sample.
3. Every carrier is laid out flat and triangulated between the segments on it; the faces' borders
   tell what lies on either side of a triangle.
4. Where an edge between two points would be found on two carriers, one of them gets a point there.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from decomp.complex.boundary.boundary_carriers import INNER_TURN, CarrierMesh, carrier_mesh
from decomp.complex.boundary.boundary_classes import FoldedError
from decomp.complex.boundary.boundary_layout import Layout, layouts
from decomp.complex.boundary.boundary_pieces import Pieces, boundary_pieces
from decomp.complex.boundary.boundary_samples import (
    Samples,
    numbered,
    refined,
    sample_pieces,
    straight,
)
from decomp.complex.elements import CarrierSurface, EdgeCurve
from decomp.complex.model import Complex, Line, LineKind, Patch, PatchKind
from decomp.complex.plane.planar import components, crossings
from decomp.errors import GeometryError
from decomp.geometry import Geometry
from decomp.vectors import Array, Bools, Ints, norm

DENSER_ROUNDS = 60
UNFOLDING_ROUNDS = 6
"""How often all pieces on a carrier are sampled twice as densely when it comes out folded."""

Side = tuple[int, int]
"""A region and one of its faces."""


@dataclass(frozen=True, eq=False)
class BoundaryPatch:
    """A connected part of faces with the same regions on its two sides.

    Args:
        carrier: index.
        outer: the region on the carrier's outside and its face, None outside all regions.
        inner: the same on the carrier's inside.
        patch: its triangles; normals point out of the region with the lower number.
    """

    carrier: int
    outer: Side | None
    inner: Side | None
    patch: Patch

    def outward_of(self, region: int) -> int:
        """+1 if the patch's normals point out of a region at it, -1 if into it, 0 elsewhere."""
        assert isinstance(self.patch.surface, CarrierSurface)
        if self.inner is not None and self.inner[0] == region:
            return self.patch.surface.sign
        if self.outer is not None and self.outer[0] == region:
            return -self.patch.surface.sign
        return 0


@dataclass(frozen=True, eq=False)
class BoundaryMesh:
    """The boundaries of all regions as triangles.

    Args:
        points: (n, 3): nodes, then samples of pieces, then points inside faces.
        interior: (n,) whether a point is none of the pieces'.
        pieces: of the edges.
        samples: of the pieces, maybe more than were given.
        patches: all faces and interfaces.
        lines: one for each piece, in their order.
    """

    points: Array
    interior: Bools
    pieces: Pieces
    samples: Samples
    patches: tuple[BoundaryPatch, ...]
    lines: tuple[Line, ...]

    @property
    def complex(self) -> Complex:
        """All patches and lines."""
        return Complex(self.points, tuple(p.patch for p in self.patches), self.lines)

    def face_sides(self, region: int, faces: int) -> tuple[tuple[tuple[int, int], ...], ...]:
        """For each of a region's faces its patches, +1 where their normals point out of it."""
        found: list[list[tuple[int, int]]] = [[] for _ in range(faces)]
        for number, patch in enumerate(self.patches):
            for side in (patch.outer, patch.inner):
                if side is not None and side[0] == region:
                    found[side[1]].append((number, patch.outward_of(region)))
        return tuple(tuple(sides) for sides in found)

    def triangles_of(self, region: int) -> Ints:
        """The closed surface (m, 3) of a region, counterclockwise seen from outside it."""
        parts = [np.empty((0, 3), dtype=np.int64)]
        for patch in self.patches:
            sign = patch.outward_of(region)
            if sign:
                parts.append(patch.patch.triangles[:, ::sign])
        return np.concatenate(parts)


def boundary_mesh(
    geometry: Geometry, tolerance: float, turn: float = INNER_TURN, nodes: Iterable[Array] = ()
) -> BoundaryMesh:
    """Triangulate the boundaries of all regions from scratch.

    Args:
        geometry: of the model.
        tolerance: the most that a curve leaves its segments, in model units.
        turn: the most (radians) that normals differ along an edge inside a face.
        nodes: points (3,) on edges that are to be vertices.
    """
    pieces = boundary_pieces(geometry, nodes)
    return boundary_patches(geometry, pieces, sample_pieces(pieces, tolerance), turn)


def boundary_patches(
    geometry: Geometry, pieces: Pieces, samples: Samples, turn: float = INNER_TURN
) -> BoundaryMesh:
    """Triangulate the boundaries of all regions between sampled pieces.

    Args:
        geometry: of the model.
        pieces: of all its edges.
        samples: of the pieces; where segments cross more are added.
        turn: the most (radians) that normals differ along an edge inside a face.

    Raises:
        GeometryError: the pieces on a carrier cannot be kept apart.
    """
    drawn = layouts(geometry, pieces, samples)
    for _ in range(UNFOLDING_ROUNDS):
        samples = _uncrossed(drawn, pieces, samples)
        meshes, split = _meshes(drawn, pieces, samples, turn)
        if not split:
            return _assembled(pieces, samples, meshes)
        samples = numbered(pieces, refined(pieces, samples, split))
    piece, segment = min(split)
    at = samples.points[samples.vertices[piece][segment]]
    raise GeometryError("the faces near {at} could not be triangulated", at=at)


def _meshes(
    drawn: Sequence[Layout], pieces: Pieces, samples: Samples, turn: float
) -> tuple[list[CarrierMesh], set[tuple[int, int]]]:
    """The meshes of all carriers, or the segments that must be split before they can be had."""
    meshes, split = [], set()
    for layout in drawn:
        try:
            meshes.append(carrier_mesh(layout, samples, turn=turn))
        except FoldedError:
            names = layout.segments(samples)[1].tolist()
            curved = {(p, s) for p, s in names if not straight(pieces.pieces[p])}
            if not curved:
                raise
            split |= curved
    for _ in range(DENSER_ROUNDS):
        if split:
            break
        more, split = _shared(meshes, pieces, samples)
        if not more and not split:
            return meshes, split
        for number, sides in more.items():
            mesh = meshes[number]
            at = mesh.midpoints.reshape(-1, 3)[sides]
            interior = np.concatenate([mesh.interior, at])
            meshes[number] = carrier_mesh(mesh.layout, samples, interior, turn)
    return meshes, split


def _uncrossed(drawn: Sequence[Layout], pieces: Pieces, samples: Samples) -> Samples:
    """Samples with more of them where segments cross on some carrier."""
    for _ in range(DENSER_ROUNDS):
        split: set[tuple[int, int]] = _doubled(pieces, samples)
        for layout in drawn:
            split |= _crossed(layout, pieces, samples)
        if not split:
            return samples
        samples = numbered(pieces, refined(pieces, samples, split))
    piece, segment = min(split)
    at = samples.points[samples.vertices[piece][segment]]
    raise GeometryError("edges near {at} are too close to each other to be told apart", at=at)


def _doubled(pieces: Pieces, samples: Samples) -> set[tuple[int, int]]:
    """Segments of curved pieces that join the same two points as another piece's segment."""
    at: dict[tuple[int, int], list[tuple[int, int]]] = defaultdict(list)
    for k, segments in enumerate(samples.segments):
        for s, (a, b) in enumerate(segments.tolist()):
            at[min(a, b), max(a, b)].append((k, s))
    return {
        name
        for names in at.values()
        if len(names) > 1
        for name in names
        if not straight(pieces.pieces[name[0]])
    }


def _crossed(layout: Layout, pieces: Pieces, samples: Samples) -> set[tuple[int, int]]:
    """Of each pair of segments that cross on a carrier the longer one that can be refined."""
    segments, names = layout.segments(samples)
    vertices = layout.vertices(samples)
    local = np.full(len(samples.points), -1, dtype=np.int64)
    local[vertices] = np.arange(len(vertices))
    uv = layout.chart.to_plane(samples.points[vertices])
    pairs = crossings(uv, local[segments], layout.chart.period)
    ends = samples.points[segments]
    length = norm(ends[:, 1] - ends[:, 0])
    found = set()
    for pair in pairs:
        curved = [k for k in pair if not straight(pieces.pieces[names[k, 0]])]
        if not curved:
            at = ends[pair[0]].mean(axis=0)
            raise GeometryError("straight edges cross near {at} without a common vertex", at=at)
        longest = max(curved, key=lambda k: float(length[k]))
        found.add((int(names[longest, 0]), int(names[longest, 1])))
    return found


def _shared(
    meshes: Sequence[CarrierMesh], pieces: Pieces, samples: Samples
) -> tuple[dict[int, Ints], set[tuple[int, int]]]:
    """Where an edge inside a face joins the same points as an edge elsewhere.

    Returns:
        for a mesh the sides (3 * triangle + corner) that need a point, and segments to be split.
    """
    segments = np.concatenate([np.empty((0, 2), dtype=np.int64), *samples.segments])
    walls = _keys(segments)
    keys, owner, side = [], [], []
    for number, mesh in enumerate(meshes):
        ends = np.stack([mesh.triangles, np.roll(mesh.triangles, -1, axis=1)], axis=-1)
        rows = np.flatnonzero((ends.reshape(-1, 2) < len(mesh.vertices)).all(axis=1))
        key, first = np.unique(_keys(mesh.vertices[ends.reshape(-1, 2)[rows]]), return_index=True)
        inner = ~np.isin(key, _keys(mesh.layout.segments(samples)[0]))
        keys.append(key[inner])
        side.append(rows[first[inner]])
        owner.append(np.full(int(inner.sum()), number))
    key, which, at = np.concatenate(keys), np.concatenate(owner), np.concatenate(side)
    _, inverse, count = np.unique(key, return_inverse=True, return_counts=True)
    clash = (count[inverse] > 1) | np.isin(key, walls)
    flat = np.array([mesh.layout.carrier.flat for mesh in meshes], dtype=np.bool_)
    curved = clash & ~flat[which]
    more = {int(k): at[curved & (which == k)] for k in np.unique(which[curved])}
    crossed = np.isin(walls, key[clash & flat[which]])
    names = [(k, s) for k, part in enumerate(samples.segments) for s in range(len(part))]
    split = {names[k] for k in np.flatnonzero(crossed) if not straight(pieces.pieces[names[k][0]])}
    return more, split


def _assembled(pieces: Pieces, samples: Samples, meshes: Sequence[CarrierMesh]) -> BoundaryMesh:
    """All meshes over one array of points."""
    points, count = [samples.points], len(samples.points)
    patches: list[BoundaryPatch] = []
    for mesh in meshes:
        fresh = np.arange(count, count + len(mesh.interior))
        triangles = np.concatenate([mesh.vertices, fresh])[mesh.triangles]
        points.append(mesh.interior)
        count += len(mesh.interior)
        both = np.concatenate([mesh.sides.outer, mesh.sides.inner], axis=1)
        kinds, kind = np.unique(both, axis=0, return_inverse=True)
        for k, row in enumerate(kinds.tolist()):
            here = triangles[kind.ravel() == k]
            part = components(here, np.empty((0, 2), dtype=np.int64), count)
            patches += [_patch(mesh, row, here[part == c]) for c in range(int(part.max()) + 1)]
    curves: dict[int, EdgeCurve] = {}
    lines = tuple(
        Line(LineKind.EDGE, curves.setdefault(id(p.curve), EdgeCurve(p.curve)), vertices)
        for p, vertices in zip(pieces.pieces, samples.vertices, strict=True)
    )
    interior = np.arange(count) >= len(samples.points)
    return BoundaryMesh(np.concatenate(points), interior, pieces, samples, tuple(patches), lines)


def _patch(mesh: CarrierMesh, sides: Sequence[int], triangles: Ints) -> BoundaryPatch:
    """A patch of given (outer region, outer face, inner region, inner face)."""
    outer = (sides[0], sides[1]) if sides[0] >= 0 else None
    inner = (sides[2], sides[3]) if sides[2] >= 0 else None
    sign = 1 if outer is None or (inner is not None and inner[0] < outer[0]) else -1
    kind = PatchKind.FACE if outer is None or inner is None else PatchKind.INTERFACE
    surface = CarrierSurface(mesh.layout.carrier, sign)
    patch = Patch(kind, surface, np.ascontiguousarray(triangles[:, ::sign]))
    return BoundaryPatch(mesh.layout.index, outer, inner, patch)


def _keys(pairs: Ints) -> Ints:
    """One number for each unordered pair (k, 2)."""
    return np.asarray(pairs.min(axis=1) * (1 << 31) + pairs.max(axis=1))
