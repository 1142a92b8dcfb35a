"""One carrier laid out flat, with all pieces, nodes and faces of all regions that are on it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from decomp.carriers import Carrier
from decomp.carriers.charts import Chart
from decomp.complex.boundary.boundary_pieces import WELD, Pieces
from decomp.complex.boundary.boundary_samples import Samples
from decomp.geometry import Geometry
from decomp.vectors import Array, Ints, norm

POLES = 400


@dataclass(frozen=True, eq=False)
class FaceUse:
    """A face of a region on the carrier.

    Args:
        region, face: indices.
        outward: +1 if the region lies on the carrier's inside, -1 if on its outside.
        border: (piece, +1 or -1) with the face on the left, seen from the carrier's outside.
    """

    region: int
    face: int
    outward: int
    border: tuple[tuple[int, int], ...]


@dataclass(frozen=True, eq=False)
class Layout:
    """What is on a carrier.

    Args:
        index: of the carrier.
        carrier: itself.
        chart: that draws it.
        pole: on a sphere the point (3,) that has no place in the chart, else None.
        nodes: on the carrier.
        pieces: on the carrier.
        faces: of all regions.
    """

    index: int
    carrier: Carrier
    chart: Chart
    pole: Array | None
    nodes: Ints
    pieces: tuple[int, ...]
    faces: tuple[FaceUse, ...]

    def vertices(self, samples: Samples) -> Ints:
        """The points on the carrier: nodes, and all samples of pieces."""
        return np.unique(np.concatenate([self.nodes, *(samples.vertices[k] for k in self.pieces)]))

    def segments(self, samples: Samples) -> tuple[Ints, Ints]:
        """Segments (k, 2) of points, and the (piece, segment) (k, 2) that they are."""
        found, names = [np.empty((0, 2), dtype=np.int64)], [np.empty((0, 2), dtype=np.int64)]
        for piece in self.pieces:
            chain = samples.vertices[piece]
            segments = np.stack([chain[:-1], chain[1:]], axis=1)
            found.append(segments)
            rows = np.arange(len(segments))
            names.append(np.stack([np.full(len(rows), piece), rows], axis=1))
        return np.concatenate(found), np.concatenate(names)


def layouts(geometry: Geometry, pieces: Pieces, samples: Samples) -> tuple[Layout, ...]:
    """Lay out every carrier that some face is on."""
    uses = _face_uses(geometry, pieces)
    on_carrier: dict[int, list[int]] = {k: [] for k in uses}
    for number, piece in enumerate(pieces.pieces):
        for k in piece.carriers:
            if k in on_carrier:
                on_carrier[k].append(number)
    form = geometry.boundaries.form
    tolerance = WELD * form.tolerance
    result = []
    for k, faces in sorted(uses.items()):
        carrier = form.carriers[k]
        nodes = np.flatnonzero(np.abs(carrier.signed_distance(pieces.nodes)) <= tolerance)
        here = tuple(on_carrier[k])
        points = samples.points[
            np.unique(np.concatenate([nodes, *(samples.vertices[p] for p in here)])).astype(int)
        ]
        pole, direction, tip, reach = None, None, False, 1.0
        if carrier.needs_pole:
            direction = _clearest(carrier, points)
            pole = carrier.place + carrier.width * direction
        if carrier.tip is not None:
            away = norm(points - carrier.tip)
            tip = bool((away <= tolerance).any())
            reach = float(away.max(initial=1.0))
        chart = carrier.chart(tip, reach, direction)
        result.append(Layout(k, carrier, chart, pole, nodes, here, tuple(faces)))
    return tuple(result)


def _face_uses(geometry: Geometry, pieces: Pieces) -> dict[int, list[FaceUse]]:
    """The faces of all regions by carrier."""
    uses: dict[int, list[FaceUse]] = {}
    for r, region in enumerate(geometry.regions):
        for f, face in enumerate(region.faces):
            border = [
                (piece, sign * direction * face.outward)
                for loop in face.loops
                for edge, direction in loop
                for piece, sign in pieces.of_edge[r][edge]
            ]
            uses.setdefault(face.carrier, []).append(FaceUse(r, f, face.outward, tuple(border)))
    return uses


def _clearest(sphere: Carrier, points: Array) -> Array:
    """Of many directions from the centre the one that keeps farthest from the points."""
    if not len(points):
        return np.array([0.0, 0.0, 1.0])
    # directions evenly spread along a spiral
    k = np.arange(POLES) + 0.5
    z, angle = 1 - 2 * k / POLES, k * np.pi * (1 + np.sqrt(5))
    flat = np.sqrt(1 - z**2)
    spiral = np.stack([flat * np.cos(angle), flat * np.sin(angle), z], axis=1)
    # the middle of the points and its antipode make symmetrical pictures
    middle = sphere.normal(points).mean(axis=0)
    if float(norm(middle)) > 1e-3:
        middle = middle / norm(middle)
        spiral = np.concatenate([[middle, -middle], spiral])
    nearest = (spiral @ sphere.normal(points).T).max(axis=1)
    best = float(nearest.min())
    good: Sequence[int] = np.flatnonzero(nearest <= best + 1e-2).tolist()
    return np.asarray(spiral[good[0]])
