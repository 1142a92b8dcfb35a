"""Scenes of tetrahedral meshes: of a file (.msh), and of one that was made."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from decomp.cells.surface import used_points
from decomp.drawing.scene import Body, Field, Part, Scene
from decomp.plain import plain
from decomp.tetra.incidence import faces_of, row_keys
from decomp.tetra.mesh import TetMesh
from decomp.tetra.msh_reader import ReadMesh, read_msh
from decomp.tetra.quality import dihedral_angles, radius_ratios
from decomp.vectors import Array, Bools, Ints

QUALITY, ANGLE = "quality (3 r / R)", "least dihedral angle"


def read(path: Path) -> Scene:
    """The scene of a file, with its quality and all its fields.

    Raises:
        FileError: it cannot be read, or has no tetrahedra.
    """
    return _scene(plain(path.name), read_msh(path))


def scene_of(mesh: TetMesh) -> Scene:
    """The scene of a mesh that was made."""
    names = {(group.dimension, group.tag): group.name for group in mesh.groups}
    as_read = ReadMesh(
        mesh.points,
        mesh.tets,
        mesh.tet_tags,
        mesh.triangles,
        mesh.triangle_tags,
        names,
        point_data=mesh.point_data,
        cell_data={name: each.astype(np.float64) for name, each in mesh.cell_data.items()},
    )
    return _scene(plain(mesh.name), as_read)


def _scene(title: str, mesh: ReadMesh) -> Scene:
    corners, triangles = mesh.tets[:, :4], mesh.triangles[:, :3]
    both = np.concatenate([np.pad(triangles, ((0, 0), (0, 1)), mode="edge"), corners])
    points, both, used = used_points(mesh.points, both)
    triangles, tets = both[: len(triangles), :3], both[len(triangles) :]
    neighbours = neighbours_of(tets)
    tags, part = np.unique(mesh.tet_tags, return_inverse=True)
    body = Body(tets, part.reshape(-1).astype(np.int64), neighbours)
    parts = [*_solids(mesh, body, tags), *_surfaces(mesh, triangles)]
    return Scene(title, points, tuple(parts), tuple(_fields(mesh, points, tets, used)), body)


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


def _solids(mesh: ReadMesh, body: Body, tags: Ints) -> Iterator[Part]:
    faces, owner = hull(body, np.arange(len(body.tets)))
    for number, tag in enumerate(tags.tolist()):
        name = mesh.names.get((3, tag), "") or f"volume {tag}"
        own = faces[body.part[owner] == number]
        yield Part("cell", name.partition("/")[0], name, "cell", own)


def _surfaces(mesh: ReadMesh, triangles: Ints) -> Iterator[Part]:
    for tag in np.unique(mesh.triangle_tags).tolist():
        name = mesh.names.get((2, tag), "") or f"surface {tag}"
        group, region = _kind_of(name)
        yield Part(group, region, name, group, triangles[mesh.triangle_tags == tag])


def _kind_of(name: str) -> tuple[str, str]:
    """What a surface is and the regions it is of, by its name as docs/mesh.md tells of names."""
    if "|" not in name:
        return "face", name.partition("/")[0] if "/" in name else ""
    if name.count("/") == 1:
        return "sheet", name.partition("/")[0]
    return "interface", "|".join(side.partition("/")[0] for side in name.split("|"))


def _fields(mesh: ReadMesh, points: Array, tets: Ints, used: Bools) -> Iterator[Field]:
    yield Field(QUALITY, False, radius_ratios(points, tets))
    yield Field(ANGLE, False, dihedral_angles(points, tets).min(axis=1))
    for name, values in mesh.point_data.items():
        yield Field(name, True, np.asarray(values, dtype=np.float64)[used])
    for name, values in mesh.cell_data.items():
        yield Field(name, False, np.asarray(values, dtype=np.float64))
