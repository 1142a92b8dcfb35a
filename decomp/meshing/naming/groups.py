"""Names and tags of the parts of a mesh: its regions, cells, faces, interfaces and sheets."""

from __future__ import annotations

import numpy as np

from decomp.complex.model import PatchKind
from decomp.geometry import Geometry
from decomp.meshes.group import Group, GroupKind
from decomp.meshing.naming.tagging import Tagged
from decomp.meshing.surface.cells import OUTSIDE, CellMap
from decomp.meshing.surface.layout import Layout
from decomp.meshing.surface.surface import MeshSurface
from decomp.vectors import Array, Ints


def cell_parts(geometry: Geometry, cells: CellMap, sizes: Array) -> list[Group]:
    """A part for each cell, in their order; the largest lengths (r,) are asked in the regions."""
    found = []
    for number, cell in enumerate(cells.cells):
        region = geometry.model.regions[int(cells.region[number])]
        found.append(
            Group(
                GroupKind.CELL,
                number + 1,
                cell.name,
                (region.name,),
                cell.faces,
                cell.volume,
                region.options.get("maxh"),
                length=float(sizes[cells.region[number]]),
            )
        )
    return found


def region_parts(geometry: Geometry, sizes: Array) -> list[Group]:
    """A part for each region, in their order; the largest lengths (r,) are asked in them."""
    return [
        Group(
            GroupKind.REGION,
            number + 1,
            region.name,
            (region.name,),
            (),
            geometry.regions[number].volume,
            region.options.get("maxh"),
            length=float(sizes[number]),
        )
        for number, region in enumerate(geometry.model.regions)
    ]


def surface_parts(
    geometry: Geometry,
    surface: MeshSurface,
    cells: CellMap,
    plan: Layout,
    tagged: Tagged,
    sizes: Array,
) -> tuple[list[Group], Ints]:
    """Boundary faces, interfaces and sheets, and each triangle's tag, 0 for none.

    Every face and interface of the model is a part, a pair of cells where triangles part them.

    Args:
        geometry, surface, cells, plan: of the model.
        tagged: the triangles.
        sizes: (r,) the largest length asked in each region.
    """
    names = [region.name for region in geometry.model.regions]
    groups: list[Group] = []
    of_face: dict[tuple[tuple[int, int], ...], int] = {}
    tag_of_patch = np.zeros(len(plan.sides), dtype=np.int64)
    ordered = sorted(range(len(plan.sides)), key=lambda k: len(plan.sides[k]))
    for patch in ordered:
        sides = plan.sides[patch]
        if not sides:
            continue
        if sides not in of_face:
            faces = [geometry.regions[r].faces[f] for r, f in sides]
            full = [f"{names[r]}/{face.name}" for (r, _), face in zip(sides, faces, strict=True)]
            numbers = [face.options.get("bc") for face in faces]
            bc = next((number for number in numbers if number is not None), None)
            every = [face.options.get("maxh") for face in faces]
            maxh = min((length for length in every if length is not None), default=None)
            least = min(float(sizes[r]) for r, _ in sides)
            kind = GroupKind.FACE if len(sides) == 1 else GroupKind.INTERFACE
            of_face[sides] = len(groups) + 1
            groups.append(
                Group(
                    kind,
                    len(groups) + 1,
                    "|".join(full),
                    tuple(names[r] for r, _ in sides),
                    tuple(face.name for face in faces),
                    maxh=maxh,
                    bc=bc,
                    length=least if maxh is None else min(least, maxh),
                )
            )
        tag_of_patch[patch] = of_face[sides]
    tags = tag_of_patch[tagged.patches]
    _sheet_parts(surface, cells, plan, tagged, groups, tags)
    return groups, tags


def _sheet_parts(
    surface: MeshSurface,
    cells: CellMap,
    plan: Layout,
    tagged: Tagged,
    groups: list[Group],
    tags: Ints,
) -> None:
    """One part for each two cells that touch; sets the tags of their triangles."""
    kinds = [patch.kind for patch in plan.complex.patches]
    sheet = np.array([kind is PatchKind.SHEET for kind in kinds])[tagged.patches]
    inner = (tagged.cells[:, 1] != OUTSIDE) & sheet
    rows = np.flatnonzero(inner & (tags == 0))
    pairs, which = np.unique(tagged.cells[rows], axis=0, return_inverse=True)
    first = len(groups)
    for low, high in pairs.tolist():
        region = surface.regions[int(cells.region[low])].name
        one, two = (cells.cells[k].name.removeprefix(f"{region}/") for k in (low, high))
        name = f"{region}/{one}|{two}"
        groups.append(Group(GroupKind.SHEET, len(groups) + 1, name, (region,)))
    tags[rows] = first + 1 + which.reshape(-1)
