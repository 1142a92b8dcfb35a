"""Triangles of all faces on one carrier, with as few points inside as its bending needs."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from decomp.carriers import Carrier
from decomp.complex.boundary.boundary_classes import FoldedError, Sides, sides_of
from decomp.complex.boundary.boundary_layout import Layout
from decomp.complex.boundary.boundary_samples import Samples
from decomp.complex.plane.planar import SparseError, triangulate
from decomp.errors import GeometryError
from decomp.vectors import Array, Bools, Ints, dot, frame, norm

INNER_TURN = np.radians(75)
"""The most that normals differ along an edge inside a face, more than on samples of its border."""
INNER_ROUNDS = 40
CLEARANCE = 0.35
"""Points inside keep this part of their spacing away from samples of pieces."""
OPPOSITE_POLE = 1e-6
"""Middles nearer to the centre than this part of the radius are opposite the pole."""
AT_TIP = 1e-9
"""An edge's end nearer to a cone's tip than this part of the edge is the tip."""


@dataclass(frozen=True, eq=False)
class CarrierMesh:
    """Triangles of the faces on a carrier.

    Args:
        layout: of the carrier.
        vertices: (v,) indices of samples on the carrier.
        interior: (q, 3) further points, exactly on it.
        triangles: (m, 3) indices into vertices followed by interior, counterclockwise seen from
            the carrier's outside.
        midpoints: (m, 3, 3) points on the carrier halfway along the sides, corner k to k + 1.
        sides: what lies on either side of each triangle.
    """

    layout: Layout
    vertices: Ints
    interior: Array
    triangles: Ints
    midpoints: Array
    sides: Sides


def carrier_mesh(
    layout: Layout, samples: Samples, interior: Array | None = None, turn: float = INNER_TURN
) -> CarrierMesh:
    """Triangulate the faces on a carrier.

    Args:
        layout: of the carrier.
        samples: of all pieces, not crossing each other on it.
        interior: (q, 3) points to begin with, by default chosen.
        turn: the most (radians) that normals differ along an edge that is not of a piece.

    Raises:
        FoldedError: the segments lie otherwise than their curves; more samples help.
    """
    vertices = layout.vertices(samples)
    known = samples.points[vertices]
    local = np.full(len(samples.points), -1, dtype=np.int64)
    local[vertices] = np.arange(len(vertices))
    segments, names = layout.segments(samples)
    segments = local[segments]
    extra = _first_points(layout, known) if interior is None else interior
    if layout.pole is not None and not (extra == layout.pole).all(axis=1).any():
        extra = np.concatenate([layout.pole[None], extra])
    for attempt in range(INNER_ROUNDS):
        points = np.concatenate([known, extra])
        try:
            triangles, corners = _triangulated(layout, points, segments)
        except SparseError as error:
            if len(error.spots):
                more = layout.carrier.project(layout.chart.to_space(error.spots))
                extra = np.concatenate([extra, spread(more, np.full(len(more), _gap(layout)))])
            elif layout.carrier.closed and layout.pole is None and attempt < 4:
                extra = _grid(layout.carrier, known, 2**attempt)
            else:
                raise
            continue
        sides = sides_of(layout, triangles, segments, names, len(points))
        kept = sides.filled
        triangles, corners = triangles[kept], corners[kept]
        sides = Sides(sides.outer[kept], sides.inner[kept])
        midpoints = _midpoints(layout, points, triangles, corners)
        more = _bent(layout, points, triangles, midpoints, segments, turn)
        if not len(more):
            used: Bools = np.isin(np.arange(len(extra)), triangles - len(known))
            number = np.concatenate([np.arange(len(known)), len(known) + np.cumsum(used) - 1])
            return CarrierMesh(layout, vertices, extra[used], number[triangles], midpoints, sides)
        extra = np.concatenate([extra, more])
    raise GeometryError(
        f"the faces on the {layout.carrier.kind} near {{at}} could not be triangulated",
        at=points[0],
    )


def _triangulated(layout: Layout, points: Array, segments: Ints) -> tuple[Ints, Array]:
    """All triangles (m, 3) and the coordinates (m, 3, 2) of their corners.

    On a sphere one of the points is the pole; its coordinates are not finite.
    """
    if layout.pole is None:
        made = triangulate(layout.chart.to_plane(points), segments, layout.chart.period)
        return made.triangles, made.corners
    at = int(np.flatnonzero((points == layout.pole).all(axis=1))[0])
    flat = np.delete(np.arange(len(points)), at)
    uv = np.full((len(points), 2), np.inf)
    uv[flat] = layout.chart.to_plane(points[flat])
    number = np.full(len(points), -1, dtype=np.int64)
    number[flat] = np.arange(len(flat))
    made = triangulate(uv[flat], number[segments])
    triangles = flat[made.triangles]
    # what lies beyond the border is seen from the pole
    n = len(points)
    ends = np.roll(triangles, -1, axis=1)
    forth, back = (triangles * n + ends).ravel(), (ends * n + triangles).ravel()
    border = forth[~np.isin(forth, back)]
    fan = np.stack([border % n, border // n, np.full(len(border), at)], axis=1)
    triangles = np.concatenate([triangles, fan])
    return triangles, uv[triangles]


def _first_points(layout: Layout, known: Array) -> Array:
    """Points without which a closed carrier has no triangles."""
    carrier = layout.carrier
    if layout.pole is not None:
        grid = _grid(carrier, known, 1, carrier.normal(layout.pole))
        return np.concatenate([layout.pole[None], grid])
    return np.empty((0, 3)) if layout.pieces else _grid(carrier, known, 1)


def _grid(carrier: Carrier, known: Array, finer: int, pole: Array | None = None) -> Array:
    """A grid on a closed carrier without the points close to given ones."""
    points, gap = carrier.grid(finer, pole)
    return _clear(points, known, CLEARANCE * gap)


def _clear(points: Array, known: Array, gap: float) -> Array:
    """Those points that keep a distance from all known ones."""
    if not len(known):
        return points
    nearest = np.array([norm(known - p).min() for p in points])
    return np.asarray(points[nearest >= gap])


def _midpoints(layout: Layout, points: Array, triangles: Ints, corners: Array) -> Array:
    """Points (m, 3, 3) on the carrier halfway along the sides of triangles, as drawn."""
    middle = (corners + np.roll(corners, -1, axis=1)) / 2
    if layout.pole is None:
        return layout.carrier.project(layout.chart.to_space(middle.reshape(-1, 2))).reshape(
            -1, 3, 3
        )
    # beside the triangles that have the pole as a corner: a little beyond the border of the drawing
    n, ends = len(points), np.roll(triangles, -1, axis=1)
    fan = np.isinf(corners[:, 2, 0])
    border = ends[fan, 0] * n + triangles[fan, 0]
    along = np.roll(corners, -1, axis=1) - corners
    beyond = 0.25 * np.stack([along[..., 1], -along[..., 0]], axis=-1)
    outer = np.isin(triangles * n + ends, border) & ~fan[:, None]
    middle += np.where(outer[..., None], beyond, 0.0)
    middle[fan, 0] -= beyond[fan, 0]
    middle[fan, 1:] = 0.0
    result = layout.carrier.project(layout.chart.to_space(middle.reshape(-1, 2))).reshape(-1, 3, 3)
    centre, radius = layout.carrier.place, layout.carrier.width
    both = points[triangles[fan]] + points[ends[fan]]
    away = (both / 2 - centre)[:, 1:]
    # the point opposite the pole: any way round
    x, _ = frame(layout.carrier.normal(layout.pole))
    away = np.where(norm(away)[..., None] > OPPOSITE_POLE * radius, away, x)
    result[fan, 1:] = layout.carrier.project(centre + radius * away / norm(away)[..., None])
    return np.asarray(result)


def _gap(layout: Layout) -> float:
    """A distance that points all around a periodic carrier keep from each other."""
    return min(p for p in layout.chart.period if p is not None) / 12


def _bent(
    layout: Layout, points: Array, triangles: Ints, midpoints: Array, segments: Ints, turn: float
) -> Array:
    """Midpoints of the edges along which normals turn too far, the worst first, not too close."""
    if layout.carrier.flat or not len(triangles):
        return np.empty((0, 3))
    n = len(points)
    ends = np.roll(triangles, -1, axis=1)
    low, high = np.minimum(triangles, ends).ravel(), np.maximum(triangles, ends).ravel()
    keys, first = np.unique(low * n + high, return_index=True)
    walls = segments.min(axis=1) * n + segments.max(axis=1)
    first = first[~np.isin(keys, walls)]
    a, b = points[low[first]], points[high[first]]
    angle = np.arccos(np.clip(dot(layout.carrier.normal(a), layout.carrier.normal(b)), -1, 1))
    tip = layout.carrier.tip
    if tip is not None:
        reach = AT_TIP * norm(a - b)
        angle = np.where((norm(a - tip) <= reach) | (norm(b - tip) <= reach), 0.0, angle)
    bad = first[angle > turn]
    order = np.argsort(-angle[angle > turn], kind="stable")
    half = norm(points[low] - points[high])[bad[order]] / 2
    return spread(midpoints.reshape(-1, 3)[bad[order]], half)


def spread(points: Array, gaps: Iterable[float]) -> Array:
    """Points, each left out if it is nearer than its gap to one taken before."""
    taken: list[Array] = []
    for point, gap in zip(points, gaps, strict=True):
        if not taken or float(norm(np.array(taken) - point).min()) >= gap:
            taken.append(point)
    return np.array(taken).reshape(-1, 3)


__all__ = ["INNER_TURN", "CarrierMesh", "FoldedError", "carrier_mesh", "spread"]
