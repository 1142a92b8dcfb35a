"""What the skeleton of a model is given as."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from enum import Enum
from pathlib import Path
from typing import Any

import numpy as np

from decomp.boundary.topology import RegionBoundary
from decomp.complex.model import Complex
from decomp.parity import Parity as Parity
from decomp.shown import Shown
from decomp.sites.site import Site
from decomp.vectors import Array


class Method(Enum):
    """How a skeleton was found: by tracing its curves, or as walls between sampled labels."""

    TRACED = "traced"
    SAMPLED = "sampled"


@dataclass(frozen=True, eq=False)
class Sheet:
    """A maximal connected two-dimensional piece of the skeleton on one Vor(f, g).

    Args:
        sites: f and g, indices into `Skeleton.sites`; the same one twice for an edge's sheet with
            itself.
        parity: None unless both sites are faces.
        patch: index into the complex's patches; its normal points from f's side to g's.
        area: of its triangles.
        radius: least and greatest distance to the boundary.
    """

    sites: tuple[int, int]
    parity: Parity | None
    patch: int
    area: float
    radius: tuple[float, float]


@dataclass(frozen=True, eq=False)
class SkeletonLine(Shown):
    """A seam (three or more sheets), a trim (two that go on smoothly) or a rim (one).

    Args:
        sites: the site of each contact.
        sheets: that meet along it, indices into `RegionSkeleton.sheets`.
        line: index into the complex's lines.
        length: of its polyline.
        closed: whether it ends where it begins without a junction.
    """

    sites: tuple[int, ...]
    sheets: tuple[int, ...]
    line: int
    length: float
    closed: bool


@dataclass(frozen=True, eq=False)
class Junction(Shown):
    """A point where seams end; on the boundary (radius 0) a vertex that they reach.

    Args:
        vertex: index into the complex's points.
        radius: distance to the boundary.
        sites: of its contacts; sites that share a contact follow each other.
    """

    vertex: int
    radius: float
    sites: tuple[int, ...]


@dataclass(frozen=True, eq=False)
class Reflexive:
    """A part of a carrier's reflexive locus whose points are nearest to that carrier's face.

    Args:
        site: the face.
        dimension: 1 for a curve, 0 for a point.
        line: index into the complex's lines, None for a point.
        vertex: index into the complex's points, None for a curve.
        length: of the curve, 0 for a point.
        closed: whether the curve is a loop.
    """

    site: int
    dimension: int
    line: int | None
    vertex: int | None
    length: float
    closed: bool


@dataclass(frozen=True)
class TrimSurface:
    """A trim surface between the cells of two faces.

    Args:
        patch: index into the complex's patches.
        faces: that own the space on the side away from the patch's normal, and on the side that
            the normal points to; indices into the region's faces. They may be the same.
    """

    patch: int
    faces: tuple[int, int]


@dataclass(frozen=True, eq=False)
class Cell(Shown):
    """A part of a region bounded by boundary faces, sheets and (face cells only) trim surfaces.

    Args:
        name: `region/face`, `region/face+face`, or `region/cell-N` beyond three faces.
        faces: names of the boundary faces it has.
        sides: its closed surface, as (patch, +1 or -1): the patch's own orientation or the
            opposite one points out of the cell. A sheet with the cell on both sides stands twice.
        volume: inside its closed surface.
    """

    name: str
    faces: tuple[str, ...]
    sides: tuple[tuple[int, int], ...]
    volume: float


@dataclass(frozen=True)
class Certificate:
    """How good a skeleton is. Lengths are relative to the model's diagonal.

    Args:
        residual: largest difference between the distances of a skeleton vertex to its sites, or
            distance of a boundary vertex from its carriers.
        chord_error: largest distance of a triangle or segment from its exact surface or curve.
        flipped: triangles whose normal opposes their surface's.
        open_cells: cells whose surface is not a closed 2-cycle.
        volume_error: of the sum of the cells' volumes, relative to the region's volume.
        euler: Euler characteristic of the skeleton with its reflexive curves and points.
        expected_euler: the region's.
        intrusion: largest depth to which the boundary enters the ball of a skeleton vertex.
        coverage: largest distance from the end of a shrinking ball to the skeleton.
    """

    residual: float
    chord_error: float
    flipped: int
    open_cells: int
    volume_error: float
    euler: int
    expected_euler: int
    intrusion: float
    coverage: float


@dataclass(frozen=True, eq=False)
class RegionSkeleton(Shown):
    """The skeleton of one region.

    Args:
        name: the region's.
        boundary: its exact boundary.
        face_sides: for each face of the region its patches, as (patch, +1 or -1): the sign tells
            whether the patch's normal points out of the region.
        cells: skeleton cells, bounded by boundary faces and sheets alone.
        face_cells: one for each face, bounded by trim surfaces too.
        method: how it was found.
        cause: why it was not traced, where that was tried first.
    """

    name: str
    boundary: RegionBoundary
    sheets: tuple[Sheet, ...]
    seams: tuple[SkeletonLine, ...]
    trims: tuple[SkeletonLine, ...]
    rims: tuple[SkeletonLine, ...]
    junctions: tuple[Junction, ...]
    reflexive: tuple[Reflexive, ...]
    face_sides: tuple[tuple[tuple[int, int], ...], ...]
    cells: tuple[Cell, ...]
    face_cells: tuple[Cell, ...]
    certificate: Certificate
    method: Method = Method.TRACED
    cause: str | None = None

    def _facts(self) -> Mapping[str, Any]:
        parts = ("name", "sheets", "seams", "trims", "rims", "junctions", "reflexive", "cells")
        return {part: getattr(self, part) for part in parts} | {"method": self.method.value}


@dataclass(frozen=True, eq=False)
class Skeleton(Shown):
    """The skeleton of a model, all regions over one complex.

    Args:
        name: the model's.
        diagonal: length of the diagonal of the box around all regions.
        tolerance: the chord tolerance it was made to, in model units.
        sites: what points can be nearest to (`SiteIndex.sites`).
        complex: all triangles and lines.
        radius: distance (n,) from each of the complex's points to the boundary, 0 on it.
        regions: in the model's order.
        source: the file that the model was read from, if any; no output may replace it.
        offset: (3,) the point near the model about which it was computed, 0 near the origin
            (`Geometry.offset`).
        unmoved: the same skeleton in coordinates about `offset`, None where that is 0.
    """

    name: str
    diagonal: float
    tolerance: float
    sites: tuple[Site, ...]
    complex: Complex
    radius: Array
    regions: tuple[RegionSkeleton, ...]
    source: Path | None = None
    offset: Array = field(default_factory=lambda: np.zeros(3))
    unmoved: Skeleton | None = None

    def _facts(self) -> Mapping[str, Any]:
        return {
            "name": self.name,
            "regions": tuple(region.name for region in self.regions),
            "sheets": sum(len(region.sheets) for region in self.regions),
            "junctions": sum(len(region.junctions) for region in self.regions),
            "cells": sum(len(region.cells) for region in self.regions),
            "triangles": sum(len(patch.triangles) for patch in self.complex.patches),
            "tolerance": self.tolerance,
        }

    def _table(self) -> tuple[Sequence[str], Iterable[Sequence[Any]]]:
        rows = (
            (r.name, r.method, len(r.sheets), len(r.junctions), len(r.cells), r.certificate.euler)
            for r in self.regions
        )
        return ("region", "method", "sheets", "junctions", "cells", "Euler characteristic"), rows

    def plot(self, **options: Any) -> Any:
        """Show its sheets, coloured by radius, with PyVista, in a window or in a notebook.

        Args:
            options: of `pyvista.DataSet.plot`, such as `off_screen`, `screenshot`, `cpos`.

        Raises:
            MissingPackageError: pyvista is not installed.
        """
        from decomp.view.plot import plot_skeleton

        return plot_skeleton(self, options)

    @property
    def local(self) -> Skeleton:
        """The skeleton in coordinates about `offset`, in which nothing is lost to rounding."""
        return self if self.unmoved is None else self.unmoved
