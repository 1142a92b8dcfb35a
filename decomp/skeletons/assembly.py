"""Putting the curves and sheets of all regions over the boundary into one complex."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from scipy.spatial import cKDTree  # type: ignore[import-untyped]

from decomp.boundary.topology import Convexity
from decomp.complex.model import Line, LineKind, Patch
from decomp.curves.circle import Circle
from decomp.errors import GeometryError
from decomp.sites.site import SiteKind
from decomp.skeletons.balls.contacts import contacts
from decomp.skeletons.balls.loci import axis_gap, on_locus
from decomp.skeletons.curves.curve_elements import RayCurve
from decomp.skeletons.curves.leaving_together import matched
from decomp.skeletons.curves.passing_close import parted
from decomp.skeletons.curves.pieces import CurvePiece
from decomp.skeletons.curves.region_curves import RegionCurves
from decomp.skeletons.curves.rim_curve import RimCurve
from decomp.skeletons.curves.sampling import sampled
from decomp.skeletons.model import TrimSurface
from decomp.skeletons.sheets.closed_sheets import ClosedSheetMaker
from decomp.skeletons.sheets.drawn_sheets import SheetPart
from decomp.skeletons.sheets.self_sheets import SelfSheetMaker
from decomp.skeletons.sheets.sheets import SheetMaker
from decomp.skeletons.sheets.trim_maker import BoundaryVertices, TrimMaker
from decomp.tolerance import AT_END
from decomp.vectors import Array, Ints, norm

Pair = tuple[int, int]

ALONG_LOCI = 24
"""Chords at least along a reflexive curve to which trim surfaces lead."""
ALONG_SELF = 8
"""Chords at least along a curve that borders a sheet of an edge with itself."""
TURN = 0.35
"""The most (radians) that normals turn from one sample of a trim to the next."""
ON_BOUNDARY = 1e-8
"""Nodes nearer to a vertex of the boundary than this part of the size are it."""


@dataclass(eq=False)
class RegionParts:
    """One region's contribution to the complex, vertices counted in the whole.

    Args:
        points: (k, 3) new points.
        lines: one for each curve piece.
        sheets: all of them.
        trims: trim surfaces as (sites: face's or vertex's side first, triangles, surface).
        rulings: normals in which trim surfaces end, shared by those that meet there.
        node: the vertex of each node of the curves.
    """

    points: Array
    lines: list[Line]
    sheets: list[SheetPart]
    trims: list[tuple[TrimSurface, Patch]] = field(default_factory=list)
    rulings: list[Line] = field(default_factory=list)
    node: list[int] = field(default_factory=list)


class RegionAssembler:
    """Samples a region's curves and triangulates its sheets.

    Args:
        curves: of the region.
        boundary: its boundary in the complex.
        before: (b, 3) all points of the complex so far, those of the boundary first.
        tolerance: of chords along curves.
        chords: of every curve at least, also of straight ones.
        finest: whether there will be no finer ones.
    """

    def __init__(
        self,
        curves: RegionCurves,
        boundary: BoundaryVertices,
        before: Array,
        tolerance: float,
        chords: int = 1,
        finest: bool = False,
    ) -> None:
        self._curves, self._boundary = curves, boundary
        self._tolerance, self._chords, self._finest = tolerance, chords, finest
        self._before = before
        self._new: list[Array] = []
        self._size = curves.incidence.boundary.diagonal
        # vertices are the first nodes
        edges = [e.vertices for e in curves.incidence.boundary.edges if e.vertices is not None]
        ends = [piece.ends for piece in curves.pieces if piece.ends is not None]
        self._between = Counter(_ends(each) for each in (*edges, *ends))

    def assemble(self) -> RegionParts:
        """Make the region's lines, sheets and trim surfaces.

        Raises:
            CrossingError: curves must be sampled more finely.
            GeometryError: a sheet or trim surface cannot be made; says where.
        """
        nodes = self._place_nodes()
        pieces = self._curves.pieces
        samples = [self._sampled(piece) for piece in pieces]
        samples = matched(pieces, parted(pieces, samples, self._tolerance, self._size))
        lines = [self._line(*each, nodes) for each in zip(pieces, samples, strict=True)]
        points = self._points()
        kinks = self._kinks(nodes)
        sheets = self._sheets(points, lines, kinks)
        closed = ClosedSheetMaker(self._curves.incidence, self._boundary, self._add)
        sheets += closed.sheets({sheet.sites for sheet in sheets}, kinks, points)
        points = self._points()
        parts = RegionParts(
            np.array(self._new).reshape(-1, 3),
            [
                Line(piece.kind, piece.element, line)
                for piece, line in zip(self._curves.pieces, lines, strict=True)
            ],
            sheets,
            node=nodes,
        )
        maker = TrimMaker(self._curves, self._boundary, points, lines)
        parts.trims.extend(maker.surfaces())
        parts.rulings.extend(maker.rulings())
        return parts

    def _points(self) -> Array:
        return np.concatenate([self._before, np.array(self._new).reshape(-1, 3)])

    def _add(self, point: Array) -> int:
        self._new.append(point)
        return len(self._before) + len(self._new) - 1

    def _place_nodes(self) -> list[int]:
        fixed = self._curves.vertices
        used = {end for piece in self._curves.pieces for end in piece.ends or ()}
        used |= set(range(fixed, fixed + len(self._curves.points)))
        result = [-1] * len(self._curves.nodes)
        gaps, near = cKDTree(self._boundary.points).query(self._curves.nodes)
        for number, point in enumerate(self._curves.nodes):
            if number < fixed:
                result[number] = self._boundary.of_vertex[number]
            elif number in used:
                known = gaps[number] <= ON_BOUNDARY * self._size
                result[number] = int(near[number]) if known else self._add(point)
        return result

    def _sampled(self, piece: CurvePiece) -> Array:
        """Samples (n, 3) of a curve, its ends included."""
        loop = piece.ends is None or piece.ends[0] == piece.ends[1]
        # rulings of trim surfaces have no points inside
        chords = 1 if isinstance(piece.element, RayCurve) else self._chords
        least = max(3 if loop else 1, chords, self._least_chords(piece))
        return sampled(piece.element, piece.points, self._tolerance, least)

    def _line(self, piece: CurvePiece, found: Array, nodes: Sequence[int]) -> Ints:
        """The vertices of a curve's samples."""
        inner = [self._add(p) for p in found[1:-1]]
        if piece.ends is None:
            first = last = self._add(found[0])
        else:
            first, last = (nodes[k] for k in piece.ends)
        return np.array([first, *inner, last], dtype=np.int64)

    def _least_chords(self, piece: CurvePiece) -> int:
        """Chords that are needed beyond those that the tolerance asks for.

        Trim surfaces need some along their upper ends, lest their triangles fold, and the sheets of
        an edge with itself, lest the feet of neighbouring points be mistaken for each other. Curves
        between the same two nodes must not share a chord.
        """
        if piece.kind is LineKind.REFLEXIVE and any(not run.resting for run in self._curves.runs):
            return ALONG_LOCI
        least = ALONG_SELF if any(a == b for a, b in piece.pairs) else 1
        if piece.ends is not None and self._between[_ends(piece.ends)] > 1:
            least = max(least, 2)
        turns = [0.0]
        for number in piece.over:
            ways = self._curves.over[number].directions(
                self._curves.over[number].parameter(piece.points)
            )
            turns.append(float(norm(np.diff(ways, axis=0)).sum()))
        return max(least, 1 + int(max(turns) / TURN))

    def _sheets(
        self, points: Array, lines: Sequence[Ints], kinks: Mapping[Pair, Sequence[int]]
    ) -> list[SheetPart]:
        borders: dict[tuple[int, int], list[Ints]] = {}
        rims: dict[tuple[int, int], list[RimCurve | None]] = {}
        for piece, line in zip(self._curves.pieces, lines, strict=True):
            for pair in set(piece.pairs):
                borders.setdefault(pair, []).append(line)
                rim = piece.element if isinstance(piece.element, RimCurve) else None
                rims.setdefault(pair, []).append(rim)
        incidence = self._curves.incidence
        for number, edge in enumerate(incidence.boundary.edges):
            if edge.convexity is Convexity.CONVEX:
                a, b = sorted(incidence.face_site[f] for f in edge.faces)
                borders.setdefault((a, b), []).append(self._boundary.of_edge[number])
        maker = SheetMaker(incidence, points, self._add, self._finest)
        own = SelfSheetMaker(incidence, points, self._add)
        sheets = []
        for pair in sorted(borders):
            if pair[0] == pair[1]:
                sheets.extend(own.sheets(pair[0], borders[pair], rims[pair]))
                continue
            sheets.extend(maker.sheets(pair, borders[pair], kinks.get(pair, [])))
        return sheets

    def _kinks(self, nodes: Sequence[int]) -> dict[tuple[int, int], list[int]]:
        """Points in which sheets are pointed: ends of reflexive loci, and balls' centres.

        At the end of a locus it is a sheet between the carrier and another site.
        """
        curves, found = self._curves, self._centres_inside(nodes)
        for part in curves.reflexive:
            for end, other in zip(part.ends, part.others, strict=True):
                if other < 0:
                    continue
                gaps = norm(curves.nodes - end)
                number = int(np.argmin(gaps))
                if gaps[number] > AT_END * self._size or nodes[number] < 0:
                    raise GeometryError("the reflexive locus that ends at {at} has no node", at=end)
                for pair in self._pointed(part.sites, other, end):
                    if nodes[number] not in found.setdefault(pair, []):
                        found[pair].append(nodes[number])
        return found

    def _centres_inside(self, nodes: Sequence[int]) -> dict[Pair, list[int]]:
        """Balls' centres that no curve leads to, for the pairs of edges whose sheets hold them.

        Where a ball shows through two faces its centre is inside the sheet between both edges.
        """
        curves, found = self._curves, dict[Pair, list[int]]()
        incidence, slack = curves.incidence, AT_END * self._size
        ends = {end for piece in curves.pieces for end in piece.ends or ()}
        edges = {k for k, site in enumerate(incidence.sites) if site.kind is SiteKind.EDGE}
        every = {pair for piece in curves.pieces for pair in piece.pairs}
        pairs = sorted(pair for pair in every if pair[0] != pair[1] and edges.issuperset(pair))
        queries = incidence.context.queries
        for number, part in enumerate(curves.points, curves.vertices):
            if number in ends or not pairs:
                continue
            at = part.ends[0][None]
            radius = float(queries.depth(at)[1][0])
            for pair in pairs:
                away = norm(at - incidence.feet(pair, at)[0])
                if float(np.abs(away - radius).max()) <= slack:
                    found.setdefault(pair, []).append(nodes[number])
        return found

    def _pointed(self, sites: Sequence[int], other: int, end: Array) -> set[tuple[int, int]]:
        """The pairs of sites whose sheets can be pointed at an end of a locus of some sites.

        One of the two is as near all around: a site of the locus, or one whose own locus has no
        length as it ends there too.
        """
        incidence, slack = self._curves.incidence, AT_END * self._size
        touching = contacts(incidence.context, end, slack)
        touched = {site for group in touching.sites for site in group} | {other, *sites}
        touched |= self._edges_about(touched, touching.radius, end)
        around = set(sites)
        for site in touched:
            if on_locus(incidence.context, [site], end[None], AT_END)[0]:
                around.add(site)
        return {(min(a, b), max(a, b)) for a in around for b in touched if a != b}

    def _edges_about(self, sites: Collection[int], radius: float, end: Array) -> set[int]:
        """Circular reentrant edges of faces that are touched all along from the end of a locus."""
        incidence, found = self._curves.incidence, set()
        for number in sites:
            it = incidence.sites[number]
            near = incidence.edges_of_face[it.index] if it.kind is SiteKind.FACE else []
            for edge in near:
                curve = incidence.boundary.edges[edge].curve
                if edge in incidence.edge_site and isinstance(curve, Circle):
                    away = float(np.hypot(norm(end - curve.centre), curve.radius)) - radius
                    if max(float(axis_gap(curve, end[None])[0]), abs(away)) <= AT_END * self._size:
                        found.add(incidence.edge_site[edge])
        return found


def _ends(nodes: Pair) -> Pair:
    """The two nodes at the ends of a curve, whichever is first."""
    return (min(nodes), max(nodes))
