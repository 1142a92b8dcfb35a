"""Meshes of tetrahedra from Gmsh files (.msh) of formats 4.1 and 2.2, binary or text.

Format: https://gmsh.info/doc/texinfo/gmsh.html#MSH-file-format
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from decomp.errors import FileError
from decomp.magnitude import LARGEST
from decomp.meshes.about import About
from decomp.meshes.files.msh_data import read_data
from decomp.meshes.files.msh_sections import Numbers, Sections, sections
from decomp.shown import Shown
from decomp.vectors import Array, Ints

NODES = {1: 2, 2: 3, 3: 4, 4: 4, 5: 8, 6: 6, 7: 5, 8: 3, 9: 6, 10: 9, 11: 10, 15: 1}
"""Number of nodes of Gmsh's element types."""
NODES |= {12: 27, 13: 18, 14: 14, 16: 8, 17: 20, 18: 15, 19: 13, 21: 10, 29: 20}
POINTS, LINES, TRIANGLES, TETS = (15, 15), (1, 8), (2, 9), (4, 11)
SURFACES, SOLIDS = (2, 3, 9, 10, 16, 21), (4, 5, 6, 7, 11, 12, 13, 14, 17, 18, 19, 29)
NONE, SEVERAL = 0, -1


@dataclass(frozen=True, eq=False)
class ReadMesh(Shown):
    """A mesh as a file has it.

    Args:
        points: (n, 3) nodes of its elements.
        tets: (m, 4) or (m, 10), as numbers of points, in Gmsh's order.
        tet_tags: (m,) the tag of each one's physical group; NONE or SEVERAL where it is not one.
        triangles: (k, 3) or (k, 6).
        triangle_tags: (k,) like `tet_tags`.
        names: of the physical groups, by dimension and tag; "" for those without.
        tet_entities: (m,) the tag of each one's entity; None if unknown.
        triangle_entities: (k,) like `tet_entities`.
        lines: (e, 2) or (e, 3), those in a physical group.
        line_tags: (e,) like `tet_tags`.
        nodes: (p,) the nodes of elements of one node in a physical group.
        node_tags: (p,) like `tet_tags`.
        point_data: (n,) values at nodes by name, where all have one.
        cell_data: (m,) values of tetrahedra by name, where all have one.
        about: what the file tells of groups and parts, if decomp has written it.
    """

    points: Array
    tets: Ints
    tet_tags: Ints
    triangles: Ints
    triangle_tags: Ints
    names: dict[tuple[int, int], str]
    tet_entities: Ints | None = None
    triangle_entities: Ints | None = None
    lines: Ints = field(default_factory=lambda: np.empty((0, 2), dtype=np.int64))
    line_tags: Ints = field(default_factory=lambda: np.empty(0, dtype=np.int64))
    nodes: Ints = field(default_factory=lambda: np.empty(0, dtype=np.int64))
    node_tags: Ints = field(default_factory=lambda: np.empty(0, dtype=np.int64))
    point_data: Mapping[str, Array] = field(default_factory=dict)
    cell_data: Mapping[str, Array] = field(default_factory=dict)
    about: About | None = None


@dataclass(frozen=True, eq=False)
class _Block:
    """Elements of one type.

    Nodes' tags (m, c), and tags (m,) of their physical groups, of their entities, and their own.
    """

    kind: int
    nodes: Ints
    tags: Ints
    entities: Ints
    numbers: Ints


def read_msh(path: str | Path) -> ReadMesh:
    """Read a file.

    Raises:
        FileError: it cannot be read, has another format, or has elements other than tetrahedra and
            triangles of order 1 or 2.
    """
    parts = sections(path)
    if parts.version == 4.1:
        tags, points, blocks = _read_41(parts)
    elif 2.0 <= parts.version < 3.0:
        tags, points, blocks = _read_22(parts)
    else:
        raise FileError(f"format {parts.version:g} is not read, only 4.1 and 2.2", path)
    tets, triangles = _joined(blocks, TETS, path), _joined(blocks, TRIANGLES, path)
    lines, corners = (_in_groups(_joined(blocks, kinds, path)) for kinds in (LINES, POINTS))
    for block in blocks:
        if block.kind in SURFACES + SOLIDS and block.kind not in TRIANGLES + TETS:
            what = f"{len(block.nodes)} elements of Gmsh's type {block.kind}"
            raise FileError(f"{what}: only tetrahedra and triangles are read", path)
    if not len(tets.nodes):
        raise FileError("there are no tetrahedra in it", path)
    every = (tets, triangles, lines, corners)
    used = np.unique(np.concatenate([each.nodes.reshape(-1) for each in every]))
    order = np.argsort(tags)
    if not np.isin(used, tags).all():
        raise FileError("there are elements with nodes that it does not define", path)
    place = order[np.searchsorted(tags[order], used)]
    if not (np.abs(points[place]) <= LARGEST).all():
        raise FileError("a node's coordinates are not finite, or too large to compute with", path)
    names: dict[tuple[int, int], str] = {}
    for dimension, each in ((2, triangles), (3, tets), (1, lines), (0, corners)):
        names |= {(dimension, int(tag)): "" for tag in np.unique(each.tags) if tag > 0}
    names |= {key: name for key, name in parts.names.items() if key[0] in (2, 3) or key in names}
    data = read_data(parts)
    at_nodes = {each.name: each.of(used) for each in data if each.at_nodes}
    of_tets = {each.name: each.of(tets.numbers) for each in data if not each.at_nodes}
    return ReadMesh(
        points[place],
        np.searchsorted(used, tets.nodes),
        tets.tags,
        np.searchsorted(used, triangles.nodes),
        triangles.tags,
        names,
        tets.entities,
        triangles.entities,
        np.searchsorted(used, lines.nodes),
        lines.tags,
        np.searchsorted(used, corners.nodes[:, 0]),
        corners.tags,
        {name: values for name, values in at_nodes.items() if values is not None},
        {name: values for name, values in of_tets.items() if values is not None},
        parts.about,
    )


def _joined(blocks: list[_Block], kinds: tuple[int, int], path: str | Path) -> _Block:
    """All elements of one dimension."""
    own = [block for block in blocks if block.kind in kinds and len(block.nodes)]
    if len({block.kind for block in own}) > 1:
        raise FileError("it has elements of both order 1 and order 2", path)
    kind = own[0].kind if own else kinds[0]
    none = np.empty(0, dtype=np.int64)
    nodes = np.concatenate([none.reshape(0, NODES[kind]), *(b.nodes for b in own)])
    each = ((b.tags, b.entities, b.numbers) for b in own)
    tags, entities, numbers = (
        (np.concatenate([none, *some]) for some in zip(*each, strict=True))
        if own
        else (none, none, none)
    )
    return _Block(kind, nodes, tags, entities, numbers)


def _in_groups(block: _Block) -> _Block:
    """Those elements that are in a physical group."""
    rows = block.tags != NONE
    return _Block(
        block.kind, block.nodes[rows], block.tags[rows], block.entities[rows], block.numbers[rows]
    )


def _read_41(parts: Sections) -> tuple[Ints, Array, list[_Block]]:
    physical: dict[tuple[int, int], int] = _physical(parts) if parts.has("Entities") else {}
    numbers = parts.numbers("Nodes")
    count = int(numbers.take("u8", 4)[0])
    tags, points = [np.empty(0, dtype=np.int64)], [np.empty((0, 3))]
    for _ in range(count):
        dimension, _, parametric = (int(k) for k in numbers.take("i4", 3))
        size = numbers.one("u8")
        tags.append(numbers.take("u8", size).astype(np.int64))
        width = 3 + (dimension if parametric else 0)
        points.append(numbers.take("f8", width * size).reshape(size, width)[:, :3])
    blocks = []
    numbers = parts.numbers("Elements")
    for _ in range(int(numbers.take("u8", 4)[0])):
        dimension, entity, kind = (int(k) for k in numbers.take("i4", 3))
        size = numbers.one("u8")
        width = _width(kind, parts) + 1
        rows = numbers.take("u8", width * size).reshape(size, width).astype(np.int64)
        tag = physical.get((dimension, entity), NONE)
        tags_of, entities = (np.full(size, k, dtype=np.int64) for k in (tag, entity))
        blocks.append(_Block(kind, rows[:, 1:], tags_of, entities, rows[:, 0]))
    return np.concatenate(tags), np.concatenate(points), blocks


def _physical(parts: Sections) -> dict[tuple[int, int], int]:
    """The physical group of each entity, by dimension and tag; NONE or SEVERAL if not one."""
    numbers = parts.numbers("Entities")
    counts = [int(k) for k in numbers.take("u8", 4)]
    result = {}
    for dimension, count in enumerate(counts):
        for _ in range(count):
            entity = numbers.one("i4")
            numbers.take("f8", 6 if dimension else 3)
            groups = numbers.take("i4", numbers.one("u8"))
            if dimension:
                numbers.take("i4", numbers.one("u8"))
            one = int(abs(groups[0])) if len(groups) == 1 else SEVERAL if len(groups) else NONE
            result[dimension, entity] = one
    return result


def _read_22(parts: Sections) -> tuple[Ints, Array, list[_Block]]:
    numbers = parts.numbers("Nodes")
    if parts.binary:
        raise FileError("format 2.2 is read as text only: save it as text, or as 4.1", parts.path)
    count = numbers.one("i8")
    nodes = numbers.take("f8", 4 * count).reshape(count, 4)
    tags = numbers.typed(nodes[:, 0], np.dtype(np.int64))
    numbers = parts.numbers("Elements")
    count = numbers.one("i8")
    blocks = [_with_several(block) for block in _runs(numbers, count, parts)]
    return tags, nodes[:, 1:], blocks


def _runs(numbers: Numbers, count: int, parts: Sections) -> list[_Block]:
    """Elements of format 2.2, all of one type together."""
    words = numbers.rest
    found: dict[int, list[_Block]] = {}
    at = done = 0
    while done < count:
        if at + 3 > len(words):
            raise FileError("section $Elements ends too early", parts.path)
        kind, tags = int(words[at + 1]), int(words[at + 2])
        if tags < 0:
            raise FileError(f"an element has {tags} tags", parts.path)
        width = 3 + tags + _width(kind, parts)
        most = min(count - done, (len(words) - at) // width)
        if most == 0:
            raise FileError("section $Elements ends too early", parts.path)
        rows = words[at : at + most * width].reshape(most, width)
        other = np.flatnonzero((rows[:, 1] != kind) | (rows[:, 2] != tags))
        size = int(other[0]) if len(other) else most
        rows = rows[:size]
        own = rows[:, 3] if tags else np.zeros(size, dtype=np.int64)
        entities = rows[:, 4] if tags > 1 else own
        block = _Block(kind, rows[:, 3 + tags :], own, entities, rows[:, 0])
        found.setdefault(kind, []).append(block)
        at, done = at + size * width, done + size
    return [_joined(own, (kind, kind), parts.path) for kind, own in found.items()]


def _with_several(block: _Block) -> _Block:
    """Format 2.2 lists an element once for each of its groups: keep it once."""
    _, first, place, count = np.unique(
        block.nodes, axis=0, return_index=True, return_inverse=True, return_counts=True
    )
    if len(first) == len(block.nodes):
        return block
    tags = block.tags[first]
    low, high = np.full(len(first), np.iinfo(np.int64).max), np.zeros(len(first), dtype=np.int64)
    np.minimum.at(low, place.reshape(-1), block.tags)
    np.maximum.at(high, place.reshape(-1), block.tags)
    tags = np.where((count > 1) & (low != high), SEVERAL, tags)
    return _Block(block.kind, block.nodes[first], tags, block.entities[first], block.numbers[first])


def _width(kind: int, parts: Sections) -> int:
    if kind not in NODES:
        raise FileError(f"elements of Gmsh's type {kind} are not read", parts.path)
    return NODES[kind]
