"""Scenes of tetrahedral meshes: of a file (.msh), and of one that was made."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from decomp.drawing.scene import Body, Field, Part, Scene
from decomp.meshes.files import read_file
from decomp.meshes.files.finest import finest
from decomp.meshes.incidence import faces_of, row_keys
from decomp.meshes.model import GroupKind, TetMesh
from decomp.meshes.quality import dihedral_angles, radius_ratios
from decomp.plain import plain
from decomp.skeletons.cells.surface import used_points
from decomp.vectors import Array, Bools, Ints

QUALITY, ANGLE = "quality (3 r / R)", "least dihedral angle"


@dataclass(frozen=True, eq=False)
class _Given:
    """What a scene is made of.

    Args:
        points: (n, 3) nodes.
        tets: (m, 4 or 10).
        tags: (m,) of the part that each tetrahedron is in.
        solids: names of these parts by tag.
        surfaces: names and triangles (k, 3) of each.
        point_data, cell_data: fields by name.
    """

    points: Array
    tets: Ints
    tags: Ints
    solids: Mapping[int, str]
    surfaces: Sequence[tuple[str, Ints]]
    point_data: Mapping[str, Array]
    cell_data: Mapping[str, Array]


def read(path: Path) -> Scene:
    """The scene of a file by cells, where it tells of them, with its quality and all its fields.

    Raises:
        FileError: it cannot be read, or has no tetrahedra.
    """
    read = read_file(path)
    fine = finest(read)
    count = len(read.triangles)
    surfaces = _named(read.triangles, read.triangle_tags, _of_dimension(read.names, 2))
    inner = _named(fine.triangles[count:], fine.triangle_tags[count:], _of_dimension(fine.names, 2))
    given = _Given(
        fine.points,
        fine.tets,
        fine.tet_tags,
        _of_dimension(fine.names, 3),
        [*surfaces, *inner],
        fine.point_data,
        fine.cell_data,
    )
    return _scene(plain(path.name), given)


def scene_of(mesh: TetMesh) -> Scene:
    """The scene of a mesh that was made, by cells, with its groups of triangles and all sheets."""
    parts = mesh.all_parts
    names = {group.tag: group.name for group in mesh.groups if group.dimension == 2}
    inner = {
        part.tag: part.name
        for part in parts.surfaces
        if part.kind is GroupKind.SHEET and part.name not in names.values()
    }
    rows = np.isin(parts.of_triangles, list(inner))
    given = _Given(
        mesh.points,
        mesh.tets,
        parts.of_tets,
        {part.tag: part.name for part in parts.solids},
        [
            *_named(mesh.triangles, mesh.triangle_tags, names),
            *_named(parts.triangles[rows], parts.of_triangles[rows], inner),
        ],
        mesh.point_data,
        {name: each.astype(np.float64) for name, each in mesh.cell_data.items()},
    )
    return _scene(plain(mesh.name), given)


def _of_dimension(names: Mapping[tuple[int, int], str], dimension: int) -> dict[int, str]:
    return {tag: name for (own, tag), name in names.items() if own == dimension}


def _named(triangles: Ints, tags: Ints, names: Mapping[int, str]) -> list[tuple[str, Ints]]:
    """The triangles of each tag, with its name."""
    return [
        (names.get(tag, "") or f"surface {tag}", triangles[tags == tag, :3])
        for tag in np.unique(tags).tolist()
    ]


def _scene(title: str, given: _Given) -> Scene:
    rows = [given.tets[:, :4]]
    rows += [np.pad(triangles, ((0, 0), (0, 1)), mode="edge") for _, triangles in given.surfaces]
    points, numbers, used = used_points(given.points, np.concatenate(rows))
    tets, *flat = np.split(numbers, np.cumsum([len(each) for each in rows])[:-1])
    tags, part = np.unique(given.tags, return_inverse=True)
    body = Body(tets, part.reshape(-1).astype(np.int64), neighbours_of(tets))
    names = [given.solids.get(tag, "") or f"volume {tag}" for tag in tags.tolist()]
    parts = list(_solids(body, names))
    for (name, _), triangles in zip(given.surfaces, flat, strict=True):
        group, region = _kind_of(name)
        parts.append(Part(group, region, name, group, triangles[:, :3]))
    return Scene(title, points, tuple(parts), tuple(_fields(given, points, tets, used)), body)


def neighbours_of(tets: Ints) -> Ints:
    """The tetrahedron (m, 4) behind each face of each tetrahedron (m, 4), -1 for none."""
    keys = row_keys(faces_of(tets))
    order = np.argsort(keys, kind="stable")
    one, two = order[:-1], order[1:]
    same = keys[one] == keys[two]
    result = np.full(len(keys), -1, dtype=np.int64)
    result[one[same]], result[two[same]] = two[same] // 4, one[same] // 4
    return result.reshape(-1, 4)


def hull(body: Body, kept: Ints) -> tuple[Ints, Ints]:
    """Faces (k, 3) of some tetrahedra behind which is no other of these in their part.

    Args:
        body: with the tetrahedra.
        kept: numbers of some of them.

    Returns:
        the faces, and the tetrahedra (k,) that they are of.
    """
    inside = np.full(len(body.tets) + 1, -1, dtype=np.int64)  # the last one is none
    inside[kept] = body.part[kept]
    outer = inside[body.neighbours[kept]] != body.part[kept][:, None]
    rows = np.flatnonzero(outer.reshape(-1))
    return faces_of(body.tets[kept])[rows], kept[rows // 4]


def _solids(body: Body, names: Sequence[str]) -> Iterator[Part]:
    faces, owner = hull(body, np.arange(len(body.tets)))
    for number, name in enumerate(names):
        own = faces[body.part[owner] == number]
        yield Part("cell", name.partition("/")[0], name, "cell", own)


def _kind_of(name: str) -> tuple[str, str]:
    """What a surface is and the regions it is of, by its name as docs/mesh.md tells of names."""
    if "|" not in name:
        return "face", name.partition("/")[0] if "/" in name else ""
    if name.count("/") == 1:
        return "sheet", name.partition("/")[0]
    return "interface", "|".join(side.partition("/")[0] for side in name.split("|"))


def _fields(given: _Given, points: Array, tets: Ints, used: Bools) -> Iterator[Field]:
    yield Field(QUALITY, False, radius_ratios(points, tets))
    yield Field(ANGLE, False, dihedral_angles(points, tets).min(axis=1))
    for name, values in given.point_data.items():
        yield Field(name, True, np.asarray(values, dtype=np.float64)[used])
    for name, values in given.cell_data.items():
        yield Field(name, False, np.asarray(values, dtype=np.float64))
