"""VTK's unstructured grids (.vtu), as ParaView and PyVista read them.

Arrays are inline base64 with a 64-bit length before them; numbers keep all their digits.
"""

from __future__ import annotations

import base64
import sys
from collections.abc import Mapping
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from decomp.skeletons.files.elements import Elements
from decomp.skeletons.files.sheet_tables import Table, region_tables, sheet_tables

Arrays: TypeAlias = Mapping[str, NDArray[Any]]
VTK_TRIANGLE, VTK_LINE, VTK_VERTEX = 5, 3, 1
TYPES = {"float64": "Float64", "int64": "Int64", "int32": "Int32", "int8": "Int8", "uint8": "UInt8"}


def encoded(
    parts: Elements, at_points: Arrays | None = None, at_triangles: Arrays | None = None
) -> bytes:
    """A grid of triangles, lines and vertices.

    Args:
        parts: what it holds.
        at_points: further point data, by name.
        at_triangles: further cell data, by name; of parts that are triangles alone.

    Point data: radius. Cell data: sheet, sites, parity, surface (what a sheet lies on, an index
    into `elements.SURFACES`) and its degree, kind (an index into `elements.KINDS`), region, seam;
    -1 stands for none. Field data: what every sheet lies on, by its number (`sheet_tables`), and
    how each region's skeleton was found (`region_tables`).
    """
    groups = (parts.triangles, parts.segments, parts.singles)
    sizes = np.repeat([3, 2, 1], [len(group) for group in groups])
    types = np.repeat([VTK_TRIANGLE, VTK_LINE, VTK_VERTEX], [len(group) for group in groups])
    cells: Arrays = {
        "connectivity": np.concatenate([group.reshape(-1) for group in groups]),
        "offsets": np.cumsum(sizes, dtype=np.int64),
        "types": types.astype(np.uint8),
    }
    data: Arrays = {
        "sheet": parts.sheet.astype(np.int32),
        "sites": parts.sites.astype(np.int32),
        "parity": parts.parity.astype(np.int8),
        "surface": parts.surface.astype(np.int8),
        "degree": parts.degree.astype(np.int8),
        "kind": parts.kind.astype(np.int8),
        "region": parts.region.astype(np.int32),
        "seam": parts.seam.astype(np.int32),
        **(at_triangles or {}),
    }
    order = "LittleEndian" if sys.byteorder == "little" else "BigEndian"
    lines = [
        '<?xml version="1.0"?>',
        f'<VTKFile type="UnstructuredGrid" version="1.0" byte_order="{order}" '
        'header_type="UInt64">',
        "<UnstructuredGrid>",
        *_field(sheet_tables(parts.sheet_kinds, parts.sheet_names) | region_tables(parts.methods)),
        f'<Piece NumberOfPoints="{len(parts.points)}" NumberOfCells="{len(sizes)}">',
        *_section("Points", {"Points": parts.points}),
        *_section("Cells", cells),
        *_section('PointData Scalars="radius"', {"radius": parts.radius, **(at_points or {})}),
        *_section('CellData Scalars="sheet"', data),
        "</Piece>",
        "</UnstructuredGrid>",
        "</VTKFile>",
    ]
    return "\n".join(lines).encode("ascii") + b"\n"


def _field(tables: Mapping[str, Table]) -> list[str]:
    if not tables:
        return []
    arrays = []
    for name, table in tables.items():
        words = [f'NumberOfTuples="{len(table.values)}"']
        words += [f'ComponentName{k}="{column}"' for k, column in enumerate(table.columns)]
        arrays.append(_array(name, table.values, f" {' '.join(words)}"))
    return ["<FieldData>", *arrays, "</FieldData>"]


def _section(tag: str, arrays: Arrays) -> list[str]:
    inner = [_array(name, values) for name, values in arrays.items()]
    return [f"<{tag}>", *inner, f"</{tag.split()[0]}>"]


def _array(name: str, values: NDArray[Any], more: str = "") -> str:
    width = f' NumberOfComponents="{values.shape[1]}"' if values.ndim == 2 else ""
    data = np.ascontiguousarray(values).tobytes()
    text = base64.b64encode(np.uint64(len(data)).tobytes() + data).decode("ascii")
    kind = TYPES[values.dtype.name]
    return f'<DataArray type="{kind}" Name="{name}"{width}{more} format="binary">{text}</DataArray>'
