"""Gmsh's format 4.1 (.msh), binary or text, with every tag kept.

Every group is a physical group of one entity or several (`entities`); every node is on the entity
of least dimension that holds it. Nodes keep their order: number k is tagged k + 1.
Format: https://gmsh.info/doc/texinfo/gmsh.html#MSH-file-format
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from decomp.meshes.files.entities import Entities, entities
from decomp.meshes.files.msh_fields import fields
from decomp.meshes.files.names import physical_names
from decomp.meshes.model import TetMesh
from decomp.vectors import Array, Ints

TYPES = {
    0: {1: 15},
    1: {2: 1, 3: 8},
    2: {3: 2, 6: 9},
    3: {4: 4, 10: 11},
}
"""Gmsh's element types by dimension and number of nodes."""
INT, SIZE, DOUBLE = np.dtype("i4"), np.dtype("u8"), np.dtype("f8")


class _Body:
    """Numbers of a section, as bytes or as words."""

    def __init__(self, binary: bool) -> None:
        self._binary = binary
        self._parts: list[bytes] = []

    def row(
        self, *items: tuple[np.dtype[np.generic], Sequence[float] | NDArray[np.generic]]
    ) -> None:
        """Numbers of different types, one line of text."""
        if self._binary:
            self._parts += [np.asarray(values, dtype=kind).tobytes() for kind, values in items]
        else:
            words = [_word(kind, value) for kind, values in items for value in values]
            self._parts.append((" ".join(words) + "\n").encode())

    def table(self, kind: np.dtype[np.generic], rows: Array | Ints) -> None:
        """Rows (n, c), each a line of text."""
        if self._binary:
            self._parts.append(np.ascontiguousarray(rows, dtype=kind).tobytes())
        elif len(rows):
            lines = (" ".join(map(repr, row)) for row in rows.tolist())
            self._parts.append(("\n".join(lines) + "\n").encode())

    def section(self, name: str) -> bytes:
        """All of it between the section's marks."""
        end = b"\n" if self._binary else b""
        return b"$%s\n%s%s$End%s\n" % (name.encode(), b"".join(self._parts), end, name.encode())


def encoded(mesh: TetMesh, *, text: bool = False) -> bytes:
    """The contents of a file.

    Args:
        mesh: to write.
        text: whether to write text (with all digits) in place of binary numbers.
    """
    placed = entities(mesh)
    head = _Body(not text)
    if text:
        version = b"$MeshFormat\n4.1 0 8\n$EndMeshFormat\n"
    else:
        head.row((INT, [1]))
        version = head.section("MeshFormat").replace(b"\n", b"\n4.1 1 8\n", 1)
    parts = [
        version,
        physical_names(mesh),
        _entities(mesh, placed, _Body(not text)),
        _nodes(mesh, placed, _Body(not text)),
        _elements(mesh, placed, _Body(not text)),
        fields(mesh, text, np.argsort(placed.tets, kind="stable")),
    ]
    return b"".join(parts)


def _entities(mesh: TetMesh, placed: Entities, body: _Body) -> bytes:
    curves, surfaces, volumes = placed.bounds
    body.row((SIZE, [len(placed.points), len(curves), len(surfaces), len(volumes)]))
    groups = [_group_of(own, tags) for _, own, tags in _tagged(mesh, placed)]
    for number, node in enumerate(placed.points.tolist(), start=1):
        own = [groups[0][number]] if number in groups[0] else []
        place = mesh.points[node].tolist()
        body.row((INT, [number]), (DOUBLE, place), (SIZE, [len(own)]), (INT, own))
    for dimension, bounds in enumerate(placed.bounds, start=1):
        boxes = _boxes(mesh, placed, dimension)
        for tag in sorted(bounds):
            physical = [groups[dimension][tag]] if tag in groups[dimension] else []
            body.row(
                (INT, [tag]),
                (DOUBLE, boxes[tag].tolist()),
                (SIZE, [len(physical)]),
                (INT, physical),
                (SIZE, [len(bounds[tag])]),
                (INT, bounds[tag]),
            )
    return body.section("Entities")


def _tagged(mesh: TetMesh, placed: Entities) -> list[tuple[Ints, Ints, Ints]]:
    """Elements, their entities and their groups, by dimension from 0."""
    return [
        (mesh.nodes[:, None], placed.nodes, mesh.node_tags),
        (mesh.lines, placed.lines, mesh.line_tags),
        (mesh.triangles, placed.triangles, mesh.triangle_tags),
        (mesh.tets, placed.tets, mesh.tet_tags),
    ]


def _group_of(entities: Ints, groups: Ints) -> dict[int, int]:
    """The group of each entity, by their tags."""
    return dict(np.unique(np.stack([entities, groups], axis=1), axis=0).tolist())


def _boxes(mesh: TetMesh, placed: Entities, dimension: int) -> dict[int, Array]:
    """The box (6,) around each entity of a dimension."""
    if dimension == 1:
        corners = {
            k: placed.points[np.array(p, dtype=np.int64) - 1] for k, p in placed.bounds[0].items()
        }
        rows = _grouped(np.where(placed.dimension == 1, placed.tag, 0))
        nodes = {k: np.concatenate([rows.get(k, corners[k][:0]), corners[k]]) for k in corners}
    else:
        elements, tags = (
            (mesh.triangles, placed.triangles) if dimension == 2 else (mesh.tets, placed.tets)
        )
        nodes = {k: elements[rows].reshape(-1) for k, rows in _grouped(tags).items()}
    return {
        k: np.concatenate([mesh.points[own].min(axis=0), mesh.points[own].max(axis=0)])
        for k, own in nodes.items()
    }


def _nodes(mesh: TetMesh, placed: Entities, body: _Body) -> bytes:
    blocks = list(_blocks(placed))
    body.row((SIZE, [len(blocks), len(mesh.points), 1, len(mesh.points)]))
    for dimension, tag, nodes in blocks:
        body.row((INT, [dimension, tag, 0]), (SIZE, [len(nodes)]))
        body.table(SIZE, nodes[:, None] + 1)
        body.table(DOUBLE, mesh.points[nodes])
    return body.section("Nodes")


def _blocks(placed: Entities) -> Iterator[tuple[int, int, Ints]]:
    for dimension in range(4):
        found = _grouped(np.where(placed.dimension == dimension, placed.tag, 0))
        for tag in sorted(found):
            if tag:
                yield dimension, tag, found[tag]


def _elements(mesh: TetMesh, placed: Entities, body: _Body) -> bytes:
    blocks = [
        (dimension, tag, elements, rows)
        for dimension, (elements, entities, _) in enumerate(_tagged(mesh, placed))
        for tag, rows in sorted(_grouped(entities).items())
    ]
    count = sum(len(rows) for *_, rows in blocks)
    body.row((SIZE, [len(blocks), count, 1, count]))
    first = 1
    for dimension, tag, elements, rows in blocks:
        kind = TYPES[dimension][elements.shape[1]]
        body.row((INT, [dimension, tag, kind]), (SIZE, [len(rows)]))
        numbers = np.arange(first, first + len(rows))
        body.table(SIZE, np.column_stack([numbers, elements[rows] + 1]))
        first += len(rows)
    return body.section("Elements")


def _grouped(tags: Ints) -> dict[int, Ints]:
    """The rows of each tag, ascending."""
    order = np.argsort(tags, kind="stable")
    found, starts = np.unique(tags[order], return_index=True)
    return dict(zip(found.tolist(), np.split(order, starts)[1:], strict=True))


def _word(kind: np.dtype[np.generic], value: float) -> str:
    return repr(float(value)) if kind == DOUBLE else str(int(value))
