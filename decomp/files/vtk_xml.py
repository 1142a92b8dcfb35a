"""VTK's unstructured grids (.vtu) as text: what files of meshes and of skeletons have in common.

Arrays are inline base64 with a 64-bit length before them; numbers keep all their digits.
"""

from __future__ import annotations

import base64
import sys
from collections.abc import Iterable, Mapping
from typing import Any
from xml.sax.saxutils import quoteattr

import numpy as np
from numpy.typing import NDArray

from decomp.plain import plain

TYPES = {"float64": "Float64", "int64": "Int64", "int32": "Int32", "int8": "Int8", "uint8": "UInt8"}


def grid(points: int, cells: int, field_data: Iterable[str], sections: Iterable[str]) -> bytes:
    """A file of one piece.

    Args:
        points, cells: how many there are.
        field_data: arrays of the whole file (`data_array`).
        sections: of the piece (`section`): points, cells, and data of both.
    """
    order = "LittleEndian" if sys.byteorder == "little" else "BigEndian"
    arrays = list(field_data)
    lines = [
        '<?xml version="1.0"?>',
        f'<VTKFile type="UnstructuredGrid" version="1.0" byte_order="{order}" '
        'header_type="UInt64">',
        "<UnstructuredGrid>",
        *(["<FieldData>", *arrays, "</FieldData>"] if arrays else []),
        f'<Piece NumberOfPoints="{points}" NumberOfCells="{cells}">',
        *sections,
        "</Piece>",
        "</UnstructuredGrid>",
        "</VTKFile>",
    ]
    return "\n".join(lines).encode() + b"\n"


def section(tag: str, arrays: Mapping[str, NDArray[Any]]) -> list[str]:
    """The lines of a section: arrays by name in a tag, which may have attributes."""
    inner = [data_array(name, values) for name, values in arrays.items()]
    return [f"<{tag}>", *inner, f"</{tag.split()[0]}>"]


def data_array(name: str, values: NDArray[Any], attributes: str = "") -> str:
    """One array (n,) or (n, columns), with further attributes."""
    width = f' NumberOfComponents="{values.shape[1]}"' if values.ndim == 2 else ""
    data = np.ascontiguousarray(values).tobytes()
    text = base64.b64encode(np.uint64(len(data)).tobytes() + data).decode("ascii")
    head = f'type="{TYPES[values.dtype.name]}" Name={quoteattr(plain(name))}{width}{attributes}'
    return f'<DataArray {head} format="binary">{text}</DataArray>'
