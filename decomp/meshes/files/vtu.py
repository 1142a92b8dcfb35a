"""VTK's unstructured grids (.vtu) of tetrahedra and all elements of groups, for ParaView, PyVista.

Cell data: `group` (tag, unique among elements of one dimension), `region` (number), `bc` (the
input's boundary condition number, -1 for none) and `cell` (its number, where there are cells).
Point data: `unprojected`. Field data: for each name an array of one number, `volume NAME`,
`surface NAME`, `curve NAME` and `point NAME` the tag, `region NAME` the number. (Arrays of strings
would be plainer, but meshio refuses files with any.)
Fields asked for have their own names; elements that are no tetrahedra have -1.
"""

from __future__ import annotations

import numpy as np

from decomp.files.vtk_xml import data_array, grid, section
from decomp.meshes.convert import VTK_TYPES, region_names, region_numbers
from decomp.meshes.group import NOUNS
from decomp.meshes.lower import lower_blocks
from decomp.meshes.model import TetMesh
from decomp.meshes.ordering import in_vtk_order
from decomp.meshes.parts import looked_up
from decomp.vectors import Ints


def encoded(mesh: TetMesh) -> bytes:
    """The contents of a file: points, lines and triangles first, then tetrahedra."""
    lower = lower_blocks(mesh)
    blocks = [*(each.elements for each in lower), in_vtk_order(mesh.tets)]
    widths = np.repeat([block.shape[1] for block in blocks], [len(block) for block in blocks])
    kinds = [*(each.vtk for each in lower), VTK_TYPES[mesh.tets.shape[1]]]
    none = np.full(sum(len(each.elements) for each in lower), -1)
    unprojected = np.zeros(len(mesh.points), dtype=np.uint8)
    unprojected[mesh.unprojected] = 1
    thin = len(none) - len(mesh.triangles)
    region = np.concatenate([none[:thin], region_numbers(mesh, 2), region_numbers(mesh, 3)])
    condition = np.concatenate([none[:thin], _conditions(mesh), np.full(len(mesh.tets), -1)])
    cells = {
        "connectivity": np.concatenate([block.reshape(-1) for block in blocks]),
        "offsets": np.cumsum(widths, dtype=np.int64),
        "types": np.repeat(kinds, [len(block) for block in blocks]).astype(np.uint8),
    }
    data = {
        "group": np.concatenate([*(each.tags for each in lower), mesh.tet_tags]),
        "region": region,
        "bc": condition,
    }
    further = {name: values for name, values in mesh.cell_data.items() if name not in data}
    data |= {name: np.concatenate([none, values]) for name, values in further.items()}
    return grid(
        len(mesh.points),
        len(widths),
        _field_data(mesh),
        [
            *section("Points", {"Points": mesh.points}),
            *section("Cells", cells),
            *section("PointData", {"unprojected": unprojected, **mesh.point_data}),
            *section('CellData Scalars="group"', data),
        ],
    )


def _conditions(mesh: TetMesh) -> Ints:
    """The boundary condition number of each triangle, -1 for none."""
    known = {s.tag: s.bc for s in mesh.all_parts.surfaces if s.bc is not None}
    return looked_up(known, mesh.triangle_parts)


def _field_data(mesh: TetMesh) -> list[str]:
    numbers = {f"{NOUNS[group.dimension]} {group.name}": group.tag for group in mesh.groups}
    numbers |= {f"region {name}": k for k, name in enumerate(region_names(mesh))}
    one = ' NumberOfTuples="1"'
    return [data_array(name, np.array([number]), one) for name, number in numbers.items()]
