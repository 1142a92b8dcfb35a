"""The sites of one region as arrays: its faces, reentrant edges and reentrant vertices.

Edges that are neither lines nor circles are cut into short pieces. Candidates for the nearest site
are numbered faces first, then pieces of edges, then vertices.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from decomp.boundary.topology import Convexity, Edge, RegionBoundary
from decomp.carriers.compiled_carriers import CarrierTable
from decomp.curves.circle import Circle
from decomp.curves.line import Line
from decomp.kernels.records import Record
from decomp.sites.edge_feet import ARC, LINE, SAMPLED, chord_gap
from decomp.sites.site_boxes import edge_box, face_box
from decomp.vectors import Array, Ints

PIECE = 6
"""Chords in a piece of a sampled edge."""
SITE_CONVEXITIES = (Convexity.REENTRANT, Convexity.SADDLE)


@dataclass(frozen=True, eq=False)
class SiteTable(Record):
    """Candidates of one region.

    Args:
        face_carriers: (f,).
        kinds: of edge pieces (e,): LINE, ARC or SAMPLED.
        data: (e, 12), see `edge_feet`.
        spans: first and last sample (e, 2) of sampled pieces.
        flanks: the two carriers (e, 2) of sampled pieces.
        ended: (e, 2), whether the piece's first and last point are sites of their own.
        gaps: distance (e,) between sampled pieces and their chords.
        samples: (m, 3).
        vertices: (v, 3).
        boxes: of faces and edge pieces (f + e, 6), lower corner first.
    """

    face_carriers: Ints
    kinds: Ints
    data: Array
    spans: Ints
    flanks: Ints
    ended: Ints
    gaps: Array
    samples: Array
    vertices: Array
    boxes: Array


@dataclass(frozen=True, eq=False)
class RegionSites:
    """A region's sites and how its candidates name them.

    Args:
        table: candidates.
        edges, vertices: indices into the boundary's edges and vertices of those that are sites.
        site_of: for each candidate its site, counted within the region.
        crowded: for each face whether its carrier holds another face of the region too.
    """

    table: SiteTable
    edges: tuple[int, ...]
    vertices: tuple[int, ...]
    site_of: Ints
    crowded: Ints

    @property
    def count(self) -> int:
        """Number of sites."""
        return len(self.crowded) + len(self.edges) + len(self.vertices)


def region_sites(boundary: RegionBoundary, carriers: CarrierTable) -> RegionSites:
    """Lay out the sites of a region."""
    faces = boundary.faces
    face_carriers = np.array([face.carrier for face in faces], dtype=np.int64)
    around = [edge_box(edge) for edge in boundary.edges]
    boxes = [face_box(boundary, face, around) for face in faces]
    edges = [k for k, e in enumerate(boundary.edges) if e.convexity is Convexity.REENTRANT]
    vertices = [k for k, v in enumerate(boundary.vertices) if v.convexity in SITE_CONVEXITIES]

    pieces = _Pieces(carriers, set(vertices))
    for number, k in enumerate(edges):
        pieces.add(boundary.edges[k], len(faces) + number)
    last = len(faces) + len(edges)
    site_of = [*range(len(faces)), *pieces.site, *range(last, last + len(vertices))]
    counts = np.bincount(face_carriers, minlength=1)
    table = SiteTable(
        face_carriers,
        np.array(pieces.kind, dtype=np.int64),
        np.array(pieces.data, dtype=np.float64).reshape(-1, 12),
        np.array(pieces.span, dtype=np.int64).reshape(-1, 2),
        np.array(pieces.flanks, dtype=np.int64).reshape(-1, 2),
        np.array(pieces.ended, dtype=np.int64).reshape(-1, 2),
        np.array(pieces.gap, dtype=np.float64),
        np.concatenate([*pieces.samples, np.empty((0, 3))]),
        np.array([boundary.vertices[k].point for k in vertices], dtype=np.float64).reshape(-1, 3),
        np.array([*boxes, *pieces.box], dtype=np.float64).reshape(-1, 6),
    )
    crowded = (counts[face_carriers] > 1).astype(np.int64)
    site = np.array(site_of, dtype=np.int64)
    return RegionSites(table, tuple(edges), tuple(vertices), site, crowded)


class _Pieces:
    """Collects the rows of edge pieces."""

    def __init__(self, carriers: CarrierTable, vertices: set[int]) -> None:
        self._carriers = carriers
        self._vertices = vertices
        self._count = 0
        self.kind: list[int] = []
        self.data: list[Array] = []
        self.span: list[tuple[int, int]] = []
        self.flanks: list[tuple[int, int]] = []
        self.ended: list[tuple[bool, bool]] = []
        self.gap: list[float] = []
        self.samples: list[Array] = []
        self.box: list[Array] = []
        self.site: list[int] = []

    def add(self, edge: Edge, site: int) -> None:
        curve = edge.curve
        start_is_site, end_is_site = (v in self._vertices for v in edge.vertices or (-1, -1))
        if isinstance(curve, Line):
            start = curve.point(np.array(edge.start))
            data = np.concatenate(
                [start, curve.direction, np.zeros(3), [edge.end - edge.start, 0.0, 0.0]]
            )
            self._row(LINE, data, edge, (0, 0), 0.0, edge_box(edge), site)
            self.ended[-1] = (start_is_site, end_is_site)
        elif isinstance(curve, Circle):
            data = np.concatenate(
                [curve.centre, curve.x, curve.y, [curve.radius, edge.start, edge.end]]
            )
            self._row(ARC, data, edge, (0, 0), 0.0, edge_box(edge), site)
            self.ended[-1] = (start_is_site, end_is_site)
        else:
            samples = np.ascontiguousarray(edge.samples, dtype=np.float64)
            self.samples.append(samples)
            for first in range(0, len(samples) - 1, PIECE):
                last = min(first + PIECE, len(samples) - 1)
                a, b = edge.carriers
                gap = max(chord_gap(self._carriers, a, b, samples, i) for i in range(first, last))
                part = samples[first : last + 1]
                box = np.concatenate([part.min(axis=0) - gap, part.max(axis=0) + gap])
                span = (self._count + first, self._count + last)
                self._row(SAMPLED, np.zeros(12), edge, span, gap, box, site)
                self.ended[-1] = (
                    start_is_site and first == 0,
                    end_is_site and last == len(samples) - 1,
                )
            self._count += len(samples)

    def _row(
        self,
        kind: int,
        data: Array,
        edge: Edge,
        span: tuple[int, int],
        gap: float,
        box: Array,
        site: int,
    ) -> None:
        self.kind.append(kind)
        self.data.append(data)
        self.span.append(span)
        self.flanks.append(edge.carriers)
        self.ended.append((False, False))
        self.gap.append(gap)
        self.box.append(box)
        self.site.append(site)
