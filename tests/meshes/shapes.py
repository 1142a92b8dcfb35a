"""Meshes made by hand: a bar of two regions, one of them cut by a sheet, and the same bent."""

from __future__ import annotations

from dataclasses import replace
from itertools import permutations

import numpy as np

from decomp.meshes.incidence import faces_of, row_keys
from decomp.meshes.model import Group, GroupKind, TetMesh
from decomp.vectors import Array, Ints

TET_EDGES = np.array([[0, 1], [1, 2], [2, 0], [3, 0], [3, 2], [3, 1]])
TRIANGLE_EDGES = np.array([[0, 1], [1, 2], [2, 0]])

GROUPS = (
    Group(GroupKind.CELL, 1, "left/front", ("left",), ("left.front",), 0.5, 0.4),
    Group(GroupKind.CELL, 2, "left/cell-1", ("left",), ("left.back", "a", "b", "c"), 0.5, 0.4),
    Group(GroupKind.CELL, 3, "right/side", ("right",), ("right.side",), 1.0),
    Group(GroupKind.FACE, 1, "left/left.xmin", ("left",), bc=7),
    Group(GroupKind.FACE, 2, "left/left.rest", ("left",)),
    Group(GroupKind.FACE, 3, "right/side", ("right",)),
    Group(GroupKind.FACE, 4, "right/right.xmax", ("right",)),
    Group(GroupKind.INTERFACE, 5, "left|right", ("left", "right")),
    Group(GroupKind.SHEET, 9, "left:front|back", ("left",)),
)


def bar(parts: int = 2) -> TetMesh:
    """The bar [0, 2] x [0, 1] x [0, 1]: left of x = 1 one region, cut by the sheet y = 1/2."""
    shape = np.array([2 * parts, parts, parts]) * 2
    points = np.stack(
        np.meshgrid(*(np.arange(k + 1) / (2 * parts) for k in shape), indexing="ij"), axis=-1
    ).reshape(-1, 3)
    strides = np.array([(shape[1] + 1) * (shape[2] + 1), shape[2] + 1, 1])
    base = np.stack(np.meshgrid(*(np.arange(k) for k in shape), indexing="ij"), axis=-1)
    first = base.reshape(-1, 3) @ strides
    tets = np.concatenate([_path(first, strides[list(order)]) for order in permutations(range(3))])
    tets = _positive(points, tets)
    centre = points[tets].mean(axis=1)
    tags = np.where(centre[:, 0] > 1, 3, np.where(centre[:, 1] < 0.5, 1, 2))
    order = np.argsort(tags, kind="stable")
    tets, tags = tets[order], tags[order]
    triangles, triangle_tags = _tagged(points, tets)
    return TetMesh(
        "bar",
        points,
        tets.astype(np.int64),
        tags.astype(np.int64),
        triangles,
        triangle_tags,
        GROUPS,
        np.array([], dtype=np.int64),
    )


def quadratic(mesh: TetMesh, bend: float = 0.0) -> TetMesh:
    """The same with nodes in the middles of edges, all bent by y += bend x^2."""
    edges = mesh.tets[:, TET_EDGES].reshape(-1, 2)
    flat = mesh.triangles[:, TRIANGLE_EDGES].reshape(-1, 2)
    _, first, number = np.unique(
        row_keys(np.concatenate([edges, flat])), return_index=True, return_inverse=True
    )
    middles = mesh.points[np.concatenate([edges, flat])[first]].mean(axis=1)
    number = number + len(mesh.points)
    points = np.concatenate([mesh.points, middles])
    points[:, 1] += bend * points[:, 0] ** 2
    return replace(
        mesh,
        points=points,
        tets=np.concatenate([mesh.tets, number[: len(edges)].reshape(-1, 6)], axis=1),
        triangles=np.concatenate([mesh.triangles, number[len(edges) :].reshape(-1, 3)], axis=1),
    )


def _path(first: Ints, steps: Ints) -> Ints:
    return np.stack([first, first + steps[0], first + steps[:2].sum(), first + steps.sum()], axis=1)


def _positive(points: Array, tets: Ints) -> Ints:
    corner = points[tets]
    turned = np.linalg.det(corner[:, 1:] - corner[:, :1]) < 0
    tets[turned] = tets[turned][:, [1, 0, 2, 3]]
    return tets


def _tagged(points: Array, tets: Ints) -> tuple[Ints, Ints]:
    """All faces with a group, each once, pointing out of the first tetrahedron that has it."""
    faces = faces_of(tets)
    _, first, count = np.unique(row_keys(faces), return_index=True, return_counts=True)
    x, y, _ = points[faces[first]].transpose(2, 0, 1)
    outer = count == 1
    tag = np.zeros(len(first), dtype=np.int64)
    tag[outer & (x < 1.01).all(axis=1)] = 2
    tag[outer & ~(x < 1.01).all(axis=1)] = 3
    tag[outer & (x == 0).all(axis=1)] = 1
    tag[outer & (x == 2).all(axis=1)] = 4
    tag[~outer & (x == 1).all(axis=1)] = 5
    tag[~outer & (y == 0.5).all(axis=1) & (x < 1.01).all(axis=1)] = 9
    return faces[first][tag > 0], tag[tag > 0]


def cube() -> TetMesh:
    """The exact mesh of a unit cube with its skeleton: a pyramid of two tetrahedra on each face."""
    sides = ("xmin", "xmax", "ymin", "ymax", "zmin", "zmax")
    corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=float)
    points = np.concatenate([corners, [[0.5, 0.5, 0.5]]])
    tets, tags, outer = [], [], []
    for axis in range(3):
        for end in (0, 1):
            ring = [k for k in range(8) if corners[k, axis] == end]
            first, *_, last = ring
            for other in ring[1:3]:
                tets.append([first, last, other, 8])
                tags.append(2 * axis + end + 1)
                outer.append([first, last, other])
    filled = _positive(points, np.array(tets, dtype=np.int64))
    faces = faces_of(filled)
    owner = np.repeat(np.array(tags), 4)
    keys = row_keys(faces)
    _, first_row, count = np.unique(keys, return_index=True, return_counts=True)
    triangles, triangle_tags = [], []
    pairs: dict[tuple[int, int], int] = {}
    for row, number in zip(first_row, count, strict=True):
        around = sorted(set(owner[keys == keys[row]].tolist()))
        if number == 1:
            triangles.append(faces[row])
            triangle_tags.append(around[0])
        elif len(around) == 2:
            triangles.append(faces[row])
            triangle_tags.append(pairs.setdefault((around[0], around[1]), 7 + len(pairs)))
    names = [f"cube.{side}" for side in sides]
    groups = [
        Group(GroupKind.CELL, k + 1, f"cube/{name}", ("cube",), (name,), 1 / 6)
        for k, name in enumerate(names)
    ]
    groups += [
        Group(GroupKind.FACE, k + 1, f"cube/{name}", ("cube",)) for k, name in enumerate(names)
    ]
    groups += [
        Group(GroupKind.SHEET, tag, f"cube/{names[a - 1]}|{names[b - 1]}", ("cube",))
        for (a, b), tag in pairs.items()
    ]
    return TetMesh(
        "cube",
        points,
        filled,
        np.array(tags),
        np.array(triangles),
        np.array(triangle_tags),
        tuple(groups),
        np.array([], dtype=np.int64),
    )
