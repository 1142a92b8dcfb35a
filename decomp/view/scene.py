"""What a view shows: named parts of triangles with values to colour them by."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from decomp.cells.surface import side_triangles
from decomp.errors import InputError
from decomp.optional import needed
from decomp.places import FAR
from decomp.plain import plain
from decomp.tetra.incidence import faces_of, row_keys
from decomp.tetra.quality import radius_ratios
from decomp.vectors import Array, Ints, norm
from decomp.view.colours import CATEGORIES

if TYPE_CHECKING:
    from decomp.medial.result import Skeleton

MODELS, MESHES, SKELETONS = (".geo", ".csg", ".json"), (".msh",), (".vtu",)


@dataclass(frozen=True, eq=False)
class Part:
    """One thing that can be shown and hidden.

    Args:
        group: `cell`, `sheet` or `face`.
        name: what it is called.
        kind: the kind of surface of a sheet, else the group.
        corners: (m, 3, 3) of its triangles.
        value: (m, 3) at these corners: radius for sheets, quality (3 r / R, 1 is best) for cells of
            meshes, else zeros.
    """

    group: str
    name: str
    kind: str
    corners: Array
    value: Array


@dataclass(frozen=True, eq=False)
class Scene:
    """All parts.

    Args:
        title: of what is shown.
        parts: by group.
        values: what the values are: `radius` or `quality`.
    """

    title: str
    parts: tuple[Part, ...]
    values: str

    @property
    def opaque(self) -> str:
        """The group that is seen first: the sheets, or the cells of a mesh."""
        groups = {part.group for part in self.parts}
        return "cell" if self.values == "quality" or "sheet" not in groups else "sheet"


def coloured(scene: Scene) -> list[tuple[Part, str]]:
    """The opaque parts with a colour each: by kind if there are several, else by number."""
    shown = [part for part in scene.parts if part.group == scene.opaque]
    kinds = list(dict.fromkeys(part.kind for part in shown))
    return [
        (part, CATEGORIES[(kinds.index(part.kind) if len(kinds) > 1 else k) % len(CATEGORIES)])
        for k, part in enumerate(shown)
    ]


def scene_of(path: Path, skeleton: Skeleton | None = None) -> Scene:
    """The scene of a file, about its own middle if that is far from the origin.

    Args:
        path: of a mesh (.msh) or of a skeleton's file (.vtu), or of a model.
        skeleton: of the model, where it is one.

    Raises:
        InputError: the file is of none of these kinds, or what reads it is not installed.
        FileError: it cannot be read.
    """
    return _brought_near(_scene_of(path, skeleton))


def _brought_near(scene: Scene) -> Scene:
    """Views tell no coordinates, and have no digits for those of what is far away."""
    ends = [each.corners.reshape(-1, 3) for each in scene.parts if len(each.corners)]
    if not ends:
        return scene
    low = np.min([each.min(axis=0) for each in ends], axis=0)
    high = np.max([each.max(axis=0) for each in ends], axis=0)
    middle = (low + high) / 2
    if not norm(middle) > FAR * norm(high - low):
        return scene
    parts = tuple(replace(each, corners=each.corners - middle) for each in scene.parts)
    return replace(scene, parts=parts)


def _scene_of(path: Path, skeleton: Skeleton | None) -> Scene:
    suffix = path.suffix.lower()
    if suffix in MESHES:
        return _of_mesh(path)
    if suffix in SKELETONS:
        return _of_grid(path)
    if skeleton is None:
        known = ", ".join((*MODELS, *MESHES, *SKELETONS))
        raise InputError(
            f"{path}: {suffix!r} is nothing that can be viewed; views are of {known} files"
        )
    return Scene(skeleton.name, tuple(_of_skeleton(skeleton)), "radius")


def _of_skeleton(skeleton: Skeleton) -> Iterator[Part]:
    from decomp.medial.sheet_kinds import sheet_kind

    mesh, number = skeleton.complex, 0

    def part(group: str, name: str, kind: str, triangles: Ints) -> Part:
        corners, radius = mesh.points[triangles], skeleton.radius[triangles]
        return Part(group, name, kind, corners, radius)

    for region in skeleton.regions:
        for sheet in region.sheets:
            between = "|".join(skeleton.sites[k].name for k in sheet.sites)
            kind = sheet_kind(skeleton, region, sheet).kind.value
            name = f"{region.name}/sheet-{number} {between}"
            yield part("sheet", name, kind, mesh.patches[sheet.patch].triangles)
            number += 1
        for cell in region.cells:
            yield part("cell", cell.name, "cell", side_triangles(mesh, cell.sides))
        for face, sides in zip(region.boundary.faces, region.face_sides, strict=True):
            triangles = side_triangles(mesh, sides)
            yield part("face", f"{region.name}/{face.name}", "face", triangles)


def _of_mesh(path: Path) -> Scene:
    from decomp.tetra.finest import finest
    from decomp.tetra.msh_reader import read_msh

    read = read_msh(path)
    mesh = finest(read)
    parts = []
    tets = mesh.tets[:, :4]
    quality = radius_ratios(mesh.points, tets)
    for tag in np.unique(mesh.tet_tags).tolist():
        own = np.flatnonzero(mesh.tet_tags == tag)
        faces = faces_of(tets[own])
        _, first, count = np.unique(row_keys(faces), return_index=True, return_counts=True)
        outer = first[count == 1]
        value = np.repeat(quality[own[outer // 4]][:, None], 3, axis=1)
        name = mesh.names.get((3, tag), "") or f"volume {tag}"
        parts.append(Part("cell", name, "cell", mesh.points[faces[outer]], value))
    own_triangles = len(read.triangles)
    inner = (mesh.triangles[own_triangles:], mesh.triangle_tags[own_triangles:], mesh.names)
    for elements, tags, names in ((read.triangles, read.triangle_tags, read.names), inner):
        for number in np.unique(tags).tolist():
            triangles = elements[tags == number, :3]
            name = names.get((2, number), "") or f"surface {number}"
            corners = mesh.points[triangles]
            group = "sheet" if "|" in name and name.count("/") == 1 else "face"
            parts.append(Part(group, name, group, corners, np.zeros(triangles.shape)))
    return Scene(plain(path.name), tuple(parts), "quality")


def _of_grid(path: Path) -> Scene:
    """A skeleton's or mid-surface's .vtu file."""
    pyvista = needed("pyvista", "pyvista", f"{path}: reading .vtu files")
    from decomp.output.elements import SURFACES

    grid = pyvista.read(path)
    if "sheet" not in grid.cell_data or "radius" not in grid.point_data:
        raise InputError(
            f"{path}: this is no skeleton of decomp's: it has no sheets and radii; "
            "of a mesh, view the .msh file"
        )
    rows = np.flatnonzero(grid.celltypes == int(pyvista.CellType.TRIANGLE))
    triangles = np.asarray(grid.cells_dict[int(pyvista.CellType.TRIANGLE)], dtype=np.int64)
    sheet, surface = (np.asarray(grid.cell_data[name])[rows] for name in ("sheet", "surface"))
    points, radius = np.asarray(grid.points, dtype=np.float64), np.asarray(grid["radius"])
    parts = []
    for number in np.unique(sheet).tolist():
        own = triangles[sheet == number]
        kind = int(surface[sheet == number][0])
        if number < 0:
            parts.append(Part("face", "boundary", "face", points[own], radius[own]))
        else:
            what = SURFACES[kind].value if kind >= 0 else "sheet"
            parts.append(Part("sheet", f"sheet-{number}", what, points[own], radius[own]))
    return Scene(plain(path.name), tuple(parts), "radius")
