"""Scenes of skeletons: of one that was computed, and of a file (.vtu) that holds one."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from decomp.drawing.scene import Field, Part, Scene
from decomp.errors import InputError
from decomp.optional import needed
from decomp.plain import plain
from decomp.skeletons.cells.surface import side_triangles
from decomp.vectors import Array

if TYPE_CHECKING:
    from decomp.skeletons.model import Skeleton


def scene_of(skeleton: Skeleton) -> Scene:
    """Sheets, cells and faces of a skeleton, with the distance to the boundary."""
    radius = Field("radius", True, skeleton.radius)
    return Scene(skeleton.name, skeleton.complex.points, tuple(_parts(skeleton)), (radius,))


def _parts(skeleton: Skeleton) -> Iterator[Part]:
    from decomp.skeletons.sheet_kinds import sheet_kind

    mesh, number = skeleton.complex, 0
    for region in skeleton.regions:
        for sheet in region.sheets:
            between = "|".join(skeleton.sites[k].name for k in sheet.sites)
            kind = sheet_kind(skeleton, region, sheet).kind.value
            name = f"{region.name}/sheet-{number} {between}"
            yield Part("sheet", region.name, name, kind, mesh.patches[sheet.patch].triangles)
            number += 1
        for cell in region.cells:
            triangles = side_triangles(mesh, cell.sides)
            yield Part("cell", region.name, cell.name, "cell", triangles)
        for face, sides in zip(region.boundary.faces, region.face_sides, strict=True):
            name = f"{region.name}/{face.name}"
            yield Part("face", region.name, name, "face", side_triangles(mesh, sides))


def read(path: Path) -> Scene:
    """The scene of a skeleton's or mid-surface's file, with all its fields of one number.

    Raises:
        InputError: it holds something else, or pyvista is not installed.
    """
    pyvista = needed("pyvista", "pyvista", f"{path}: reading .vtu files")
    from decomp.skeletons.files.elements import SURFACES

    grid = pyvista.read(path)
    if "sheet" not in grid.cell_data or "radius" not in grid.point_data:
        raise InputError(
            f"{path}: this is no skeleton of decomp's: it has no sheets and radii; "
            "of a mesh, view the .msh file"
        )
    rows = np.flatnonzero(grid.celltypes == int(pyvista.CellType.TRIANGLE))
    triangles = np.asarray(grid.cells_dict[int(pyvista.CellType.TRIANGLE)], dtype=np.int64)
    sheet, surface = (np.asarray(grid.cell_data[name])[rows] for name in ("sheet", "surface"))
    parts = []
    for number in np.unique(sheet).tolist():
        own = triangles[sheet == number]
        kind = int(surface[sheet == number][0])
        if number < 0:
            parts.append(Part("face", "", "boundary", "face", own))
        else:
            what = SURFACES[kind].value if kind >= 0 else "sheet"
            parts.append(Part("sheet", "", f"sheet-{number}", what, own))
    fields = tuple(
        Field(name, True, np.asarray(values, dtype=np.float64))
        for name, values in grid.point_data.items()
        if np.ndim(values) == 1
    )
    points: Array = np.asarray(grid.points, dtype=np.float64)
    return Scene(plain(path.name), points, tuple(parts), fields)
