"""The skeleton of one traced region in a finished complex, with its certificate."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from decomp.complex.model import Complex
from decomp.geometry import Geometry
from decomp.skeletons.assembly import RegionParts
from decomp.skeletons.cells.partition import face_cells, skeleton_cells
from decomp.skeletons.certificate.certificate import Certified
from decomp.skeletons.certificate.evidence import Evidence
from decomp.skeletons.certified_region import certified_region
from decomp.skeletons.curves.region_curves import RegionCurves
from decomp.skeletons.described import RegionDescription
from decomp.skeletons.model import Method, RegionSkeleton, TrimSurface
from decomp.skeletons.sheets.trim_maker import owners
from decomp.vectors import Array, Ints


@dataclass(frozen=True, eq=False)
class TracedRegion:
    """What is known of a traced region before its complex is refined.

    Args:
        number: the region's.
        curves: of its skeleton.
        parts: its contribution to the complex.
        sheet_patches: the patch of each of its sheets.
        trims: its trim surfaces.
        part_lines: the line of each of its parts' lines.
        face_sides: for each face its patches, +1 where their normals point out of the region.
    """

    number: int
    curves: RegionCurves
    parts: RegionParts
    sheet_patches: Sequence[int]
    trims: tuple[TrimSurface, ...]
    part_lines: Sequence[int]
    face_sides: tuple[tuple[tuple[int, int], ...], ...]

    def finished(
        self, geometry: Geometry, mesh: Complex, radius: Array, renumbered: Ints
    ) -> tuple[RegionSkeleton, Certified]:
        """The region's skeleton, with what its certificate found.

        Args:
            geometry: of the model.
            mesh: the complex, refined.
            radius: distance (n,) of its points from the boundary.
            renumbered: (k,) the new number of each point from before refining.
        """
        boundary = geometry.regions[self.number]
        drawn = RegionDescription(
            self.curves,
            self.parts,
            mesh,
            radius,
            renumbered,
            self.sheet_patches,
            self.part_lines,
        )
        sheets, lines = drawn.sheets_and_lines()
        reflexive = drawn.reflexive()
        owner = owners(self.curves)
        of_faces = face_cells(mesh, boundary, self.face_sides, sheets, self.trims, owner)
        cells = skeleton_cells(mesh, boundary, of_faces, self.trims)
        evidence = Evidence(
            geometry.index,
            self.number,
            geometry.diagonal,
            mesh,
            radius,
            sheets,
            reflexive,
            self.face_sides,
            cells,
            of_faces,
        )
        return certified_region(evidence, boundary, lines, drawn.junctions(), Method.TRACED)
