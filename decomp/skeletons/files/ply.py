"""Polygon files (.ply), binary, with coordinates in double precision."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from decomp.skeletons.files.elements import KINDS, Elements
from decomp.vectors import Array, Ints

WORDS = {"<f8": "double", "<i4": "int", "u1": "uchar"}
Column = tuple[str, str, NDArray[Any]]
"""Name, type and values."""


def encoded(
    parts: Elements,
    at_points: Mapping[str, Array] | None = None,
    at_triangles: Mapping[str, Array] | None = None,
) -> bytes:
    """Triangles with their sheet and region, and the reflexive curves as edges.

    Args:
        parts: what the file holds.
        at_points: further values of vertices, by name.
        at_triangles: has no place here.
    """
    count = len(parts.triangles)
    curves = parts.kind[count : count + len(parts.segments)] == KINDS.index("reflexive")
    segments = parts.segments[curves]
    extra = [("sheet", "<i4", parts.sheet[:count]), ("region", "<i4", parts.region[:count])]
    values = {"radius": parts.radius, **(at_points or {})}
    vertices = _coordinates(parts.points)
    vertices += [(name, "<f8", column) for name, column in values.items()]
    ends = [("vertex1", "<i4", segments[:, 0]), ("vertex2", "<i4", segments[:, 1])]
    return _file(vertices, parts.triangles, extra, ends if len(segments) else [])


def surface(points: Array, triangles: Ints) -> bytes:
    """Points (n, 3) and triangles (m, 3) alone."""
    return _file(_coordinates(points), triangles, [], [])


def _coordinates(points: Array) -> list[Column]:
    return [(axis, "<f8", points[:, k]) for k, axis in enumerate("xyz")]


def _file(
    vertices: Sequence[Column],
    triangles: Ints,
    extra: Sequence[Column],
    edges: Sequence[Column],
) -> bytes:
    header = ["ply", "format binary_little_endian 1.0", "comment made by decomp"]
    header += [f"element vertex {len(vertices[0][2])}", *_properties(vertices)]
    header += [f"element face {len(triangles)}", "property list uchar int vertex_indices"]
    header += _properties(extra)
    faces: list[Column] = [("n", "u1", np.full(len(triangles), 3))]
    faces += [(f"v{k}", "<i4", triangles[:, k]) for k in range(3)]
    body = _rows(vertices) + _rows([*faces, *extra])
    if edges:
        header += [f"element edge {len(edges[0][2])}", *_properties(edges)]
        body += _rows(edges)
    return "\n".join([*header, "end_header\n"]).encode("ascii") + body


def _properties(columns: Sequence[Column]) -> list[str]:
    return [f"property {WORDS[kind]} {name}" for name, kind, _ in columns]


def _rows(columns: Sequence[Column]) -> bytes:
    table = np.empty(len(columns[0][2]), dtype=[(name, kind) for name, kind, _ in columns])
    for name, _, values in columns:
        table[name] = values
    return table.tobytes()
