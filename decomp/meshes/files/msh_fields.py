"""Fields in Gmsh's formats: sections NodeData and ElementData, alike in 2.2 and 4.1."""

from __future__ import annotations

import numpy as np

from decomp.meshes.model import TetMesh
from decomp.vectors import Array, Ints

ROW = np.dtype([("tag", "<i4"), ("value", "<f8")])


def fields(mesh: TetMesh, text: bool, rows: Ints) -> bytes:
    """The sections of all fields of a mesh; tetrahedra are numbered after all other elements.

    These have -1 where tetrahedra have values, as meshio reads no file in which elements lack any.

    Args:
        mesh: with fields, or without.
        text: whether numbers are written as words.
        rows: (m,) the tetrahedra in the order of their numbers.
    """
    parts = [
        _section("NodeData", name, np.arange(1, len(values) + 1), values, text)
        for name, values in mesh.point_data.items()
    ]
    none = np.full(len(mesh.nodes) + len(mesh.lines) + len(mesh.triangles), -1.0)
    numbers = np.arange(1, len(none) + len(mesh.tets) + 1)
    parts += [
        _section("ElementData", name, numbers, np.concatenate([none, values[rows]]), text)
        for name, values in mesh.cell_data.items()
    ]
    return b"".join(parts)


def _section(kind: str, name: str, tags: Ints, values: Array, text: bool) -> bytes:
    """One field: its name, the time 0, and step 0, one component, the number of values."""
    head = f'${kind}\n1\n"{name}"\n1\n0\n3\n0\n1\n{len(values)}\n'
    if text:
        rows = "".join(f"{t} {v!r}\n" for t, v in zip(tags.tolist(), values.tolist(), strict=True))
        return f"{head}{rows}$End{kind}\n".encode()
    table = np.empty(len(values), dtype=ROW)
    table["tag"], table["value"] = tags, values
    return head.encode() + table.tobytes() + f"\n$End{kind}\n".encode()
