"""What the lines and patches of a finished complex are in the skeleton of a region."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from decomp.complex.model import Complex, LineKind
from decomp.sites.site import SiteKind
from decomp.skeletons.assembly import RegionParts
from decomp.skeletons.curves.region_curves import RegionCurves
from decomp.skeletons.model import Junction, Parity, Reflexive, Sheet, SkeletonLine
from decomp.skeletons.radius_along import ranges_along
from decomp.skeletons.radius_range import DrawnSheet, SheetRadii
from decomp.skeletons.sheets.drawn_sheets import SheetPart
from decomp.vectors import Array, Ints, cross, norm


class RegionDescription:
    """Sheets, lines, junctions and reflexive loci of one region.

    Args:
        curves: of its skeleton.
        parts: its contribution to the complex.
        mesh: the complex, refined.
        radius: distance (n,) of the complex's points from the boundary.
        number: (k,) the new number of each point from before refining.
        patches: of the region's sheets in the complex.
        lines: of the region's curves in the complex.
    """

    def __init__(
        self,
        curves: RegionCurves,
        parts: RegionParts,
        mesh: Complex,
        radius: Array,
        number: Ints,
        patches: Sequence[int],
        lines: Sequence[int],
    ) -> None:
        self._queries = curves.incidence.context.queries
        self._curves, self._parts = curves, parts
        self._mesh, self._radius, self._number = mesh, radius, number
        self._patches, self._lines = patches, lines

    def sheets_and_lines(self) -> tuple[tuple[Sheet, ...], list[tuple[LineKind, SkeletonLine]]]:
        """All sheets, and all lines along which sheets meet."""
        drawn = zip(self._parts.sheets, self._patches, strict=True)
        sheets = tuple(self._sheet(part, patch) for part, patch in drawn)
        lines = self._meeting(sheets)
        return self._with_extrema(sheets, [line for _, line in lines]), lines

    def _sheet(self, part: SheetPart, patch: int) -> Sheet:
        """A sheet, with the least and greatest radius of its vertices."""
        triangles = self._mesh.patches[patch].triangles
        corners = self._mesh.points[triangles]
        doubled = norm(cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]))
        used = self._radius[triangles]
        return Sheet(
            part.sites,
            _parity(self._curves, part.sites),
            patch,
            float(doubled.sum() / 2),
            (float(used.min()), float(used.max())),
        )

    def _with_extrema(
        self, sheets: tuple[Sheet, ...], lines: list[SkeletonLine]
    ) -> tuple[Sheet, ...]:
        """The sheets with the extreme radii between vertices, along their borders and inside."""
        mesh, ranges = self._mesh, [sheet.radius for sheet in sheets]
        drawn = [mesh.lines[line.line] for line in lines]
        along = ranges_along(
            self._queries,
            [line.curve for line in drawn],
            [line.vertices for line in drawn],
            mesh.points,
            self._radius,
        )
        for line, (low, high) in zip(lines, along, strict=True):
            for k in line.sheets:
                ranges[k] = (min(ranges[k][0], low), max(ranges[k][1], high))
        patches = [mesh.patches[sheet.patch] for sheet in sheets]
        asked = [
            DrawnSheet(sheet.sites, patch.surface, patch.triangles, known)
            for sheet, patch, known in zip(sheets, patches, ranges, strict=True)
        ]
        found = SheetRadii(self._queries, asked).ranges(mesh.points, self._radius)
        return tuple(replace(s, radius=own) for s, own in zip(sheets, found, strict=True))

    def _meeting(self, sheets: tuple[Sheet, ...]) -> list[tuple[LineKind, SkeletonLine]]:
        """Seams, trims and rims, by the number of sheets that meet along them."""
        meeting: dict[tuple[int, int], list[int]] = {}
        drawn = [self._mesh.lines[line].vertices for line in self._lines]
        firsts = np.array([np.sort(vertices[:2]) for vertices in drawn]).reshape(-1, 2)
        for k, sheet in enumerate(sheets):
            for side in _sides_among(self._mesh.patches[sheet.patch].triangles, firsts).tolist():
                meeting.setdefault((side[0], side[1]), []).append(k)
        found = []
        curves = self._curves
        for piece, first, line_number in zip(
            curves.pieces, firsts.tolist(), self._lines, strict=True
        ):
            vertices = self._mesh.lines[line_number].vertices
            around = meeting.get((first[0], first[1]), [])
            if not around:
                continue
            kind = _kind(len(around))
            sites = tuple(dict.fromkeys(site for c in piece.contacts for site in c))
            length = float(norm(np.diff(self._mesh.points[vertices], axis=0)).sum())
            closed = piece.ends is None
            line = SkeletonLine(sites, tuple(sorted(set(around))), line_number, length, closed)
            found.append((kind, line))
        return found

    def junctions(self) -> tuple[Junction, ...]:
        """The nodes at which seams end: all but those where one seam merely crosses a trim."""
        curves, parts = self._curves, self._parts
        ending: dict[int, int] = {}
        sites: dict[int, list[int]] = {}
        for piece in curves.pieces:
            for end in piece.ends or ():
                if len(piece.pairs) > 2:
                    ending[end] = ending.get(end, 0) + 1
                sites.setdefault(end, []).extend(s for c in piece.contacts for s in c)
        found = []
        for node, count in sorted(ending.items()):
            if count == 2:
                continue
            vertex = int(self._number[parts.node[node]])
            found.append(
                Junction(vertex, float(self._radius[vertex]), tuple(dict.fromkeys(sites[node])))
            )
        return tuple(found)

    def reflexive(self) -> tuple[Reflexive, ...]:
        curves, parts = self._curves, self._parts
        found = []
        for piece, line_number in zip(curves.pieces, self._lines, strict=True):
            if piece.kind is not LineKind.REFLEXIVE:
                continue
            vertices = self._mesh.lines[line_number].vertices
            length = float(norm(np.diff(self._mesh.points[vertices], axis=0)).sum())
            found.append(
                Reflexive(piece.contacts[0][0], 1, line_number, None, length, piece.ends is None)
            )
        for k, part in enumerate(curves.points):
            vertex = int(self._number[parts.node[curves.vertices + k]])
            found.append(Reflexive(part.sites[0], 0, None, vertex, 0.0, False))
        return tuple(found)


def _kind(sheets: int) -> LineKind:
    if sheets >= 3:
        return LineKind.SEAM
    return LineKind.TRIM if sheets == 2 else LineKind.RIM


def _sides_among(triangles: Ints, segments: Ints) -> Ints:
    """Those sides of triangles (lower vertex first) that are among segments (k, 2).

    A segment stands as often as triangles meet there: twice where a sheet lies on both sides.
    """
    sides = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    sides = np.sort(sides, axis=1)
    stride = int(max(triangles.max(initial=0), segments.max(initial=0))) + 1
    wanted = segments[:, 0] * stride + segments[:, 1]
    return np.asarray(sides[np.isin(sides[:, 0] * stride + sides[:, 1], wanted)])


def _parity(curves: RegionCurves, pair: tuple[int, int]) -> Parity | None:
    incidence = curves.incidence
    sites = [incidence.sites[s] for s in pair]
    if any(site.kind is not SiteKind.FACE for site in sites):
        return None
    a, b = (incidence.boundary.faces[site.index].outward for site in sites)
    return Parity.EVEN if a == b else Parity.ODD
