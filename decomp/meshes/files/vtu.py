"""VTK's unstructured grids (.vtu) of tetrahedra and all elements of groups, for ParaView, PyVista.

Cell data: `group` (tag, unique among elements of one dimension), `region` (number), `bc` (the
input's boundary condition number, -1 for none) and `cell` (its number, where there are cells).
Point data: `unprojected`. Field data: for each name an array of one number, `volume NAME`,
`surface NAME`, `curve NAME` and `point NAME` the tag, `region NAME` the number. (Arrays of strings
would be plainer, but meshio refuses files with any.)
Fields asked for have their own names; elements that are no tetrahedra have -1.
Arrays are inline base64 with a 64-bit length before them; numbers keep all their digits.
"""

from __future__ import annotations

import base64
import sys
from typing import Any
from xml.sax.saxutils import quoteattr

import numpy as np
from numpy.typing import NDArray

from decomp.meshes.convert import VTK_TYPES, region_names, region_numbers
from decomp.meshes.group import NOUNS
from decomp.meshes.lower import lower_blocks
from decomp.meshes.model import TetMesh
from decomp.meshes.ordering import in_vtk_order
from decomp.meshes.parts import looked_up
from decomp.plain import plain
from decomp.vectors import Ints

TYPES = {"float64": "Float64", "int64": "Int64", "int32": "Int32", "uint8": "UInt8"}


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
    order = "LittleEndian" if sys.byteorder == "little" else "BigEndian"
    lines = [
        '<?xml version="1.0"?>',
        f'<VTKFile type="UnstructuredGrid" version="1.0" byte_order="{order}" '
        'header_type="UInt64">',
        "<UnstructuredGrid>",
        *_field_data(mesh),
        f'<Piece NumberOfPoints="{len(mesh.points)}" NumberOfCells="{len(widths)}">',
        "<Points>",
        _array("Points", mesh.points),
        "</Points>",
        "<Cells>",
        _array("connectivity", np.concatenate([block.reshape(-1) for block in blocks])),
        _array("offsets", np.cumsum(widths, dtype=np.int64)),
        _array("types", np.repeat(kinds, [len(block) for block in blocks]).astype(np.uint8)),
        "</Cells>",
        "<PointData>",
        _array("unprojected", unprojected),
        *(_array(name, values) for name, values in mesh.point_data.items()),
        "</PointData>",
        '<CellData Scalars="group">',
        _array("group", np.concatenate([*(each.tags for each in lower), mesh.tet_tags])),
        _array("region", region),
        _array("bc", condition),
        *(
            _array(name, np.concatenate([none, values]))
            for name, values in mesh.cell_data.items()
            if name != "region"
        ),
        "</CellData>",
        "</Piece>",
        "</UnstructuredGrid>",
        "</VTKFile>",
    ]
    return "\n".join(lines).encode() + b"\n"


def _conditions(mesh: TetMesh) -> Ints:
    """The boundary condition number of each triangle, -1 for none."""
    known = {s.tag: s.bc for s in mesh.all_parts.surfaces if s.bc is not None}
    return looked_up(known, mesh.triangle_parts)


def _field_data(mesh: TetMesh) -> list[str]:
    numbers = {f"{NOUNS[group.dimension]} {group.name}": group.tag for group in mesh.groups}
    numbers |= {f"region {name}": k for k, name in enumerate(region_names(mesh))}
    arrays = (_array(name, np.array([number]), True) for name, number in numbers.items())
    return ["<FieldData>", *arrays, "</FieldData>"]


def _array(name: str, values: NDArray[Any], counted: bool = False) -> str:
    width = f' NumberOfComponents="{values.shape[1]}"' if values.ndim == 2 else ""
    if counted:
        width += f' NumberOfTuples="{len(values)}"'
    data = np.ascontiguousarray(values).tobytes()
    text = base64.b64encode(np.uint64(len(data)).tobytes() + data).decode("ascii")
    kind = TYPES[values.dtype.name]
    label = quoteattr(plain(name))
    return f'<DataArray type="{kind}" Name={label}{width} format="binary">{text}</DataArray>'
