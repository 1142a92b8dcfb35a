"""VTK's unstructured grids (.vtu), as ParaView and PyVista read them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from decomp.files.vtk_xml import data_array, grid, section
from decomp.skeletons.files.elements import Elements
from decomp.skeletons.files.sheet_tables import Table, region_tables, sheet_tables

Arrays: TypeAlias = Mapping[str, NDArray[Any]]
VTK_TRIANGLE, VTK_LINE, VTK_VERTEX = 5, 3, 1


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
    return grid(
        len(parts.points),
        len(sizes),
        _field(sheet_tables(parts.sheet_kinds, parts.sheet_names) | region_tables(parts.methods)),
        [
            *section("Points", {"Points": parts.points}),
            *section("Cells", cells),
            *section('PointData Scalars="radius"', {"radius": parts.radius, **(at_points or {})}),
            *section('CellData Scalars="sheet"', data),
        ],
    )


def _field(tables: Mapping[str, Table]) -> Iterator[str]:
    for name, table in tables.items():
        words = [f'NumberOfTuples="{len(table.values)}"']
        words += [f'ComponentName{k}="{column}"' for k, column in enumerate(table.columns)]
        yield data_array(name, table.values, f" {' '.join(words)}")
