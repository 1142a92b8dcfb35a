"""A mesh that is written and read again is the same mesh, and can be grouped anew."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import decomp
from decomp.errors import FileError
from decomp.meshes.model import TetMesh
from tests.meshes.opened import opened
from tests.meshes.shapes import bar, cube
from tests.meshes.test_groups import mesh, quadratic_sink, sink
from tests.meshes.test_reading import KINDS


def rows(mesh: TetMesh, elements: np.ndarray, *tags: np.ndarray) -> set[tuple[float, ...]]:
    """Elements with their tags, whatever their order."""
    return {tuple(row) for row in np.column_stack([elements, *tags]).tolist()}


def same(one: TetMesh, two: TetMesh) -> None:
    assert one.groups == two.groups
    assert one.name == two.name
    assert np.array_equal(one.points, two.points)
    assert rows(one, one.tets, one.tet_tags) == rows(two, two.tets, two.tet_tags)
    assert rows(one, one.triangles, one.triangle_tags) == rows(
        two, two.triangles, two.triangle_tags
    )
    assert rows(one, one.lines, one.line_tags) == rows(two, two.lines, two.line_tags)
    assert rows(one, one.nodes, one.node_tags) == rows(two, two.nodes, two.node_tags)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("order", [1, 2])
def test_read_again(kind: str, order: int, tmp_path: Path) -> None:
    given = mesh() if order == 1 else quadratic_sink()
    made = given.grouped(groups={"tips": "fin*.zmax"}, edges=True, volumes="materials")
    made.write(tmp_path / "sink.msh", **KINDS[kind])
    again = decomp.read(tmp_path / "sink.msh")
    same(again, made)
    assert again.unprojected.tolist() == made.unprojected.tolist()
    assert again.source == tmp_path / "sink.msh"
    for options in ({}, {"split_faces": True}, {"volumes": "cells"}):
        same(again.grouped(**options), given.grouped(**options))  # type: ignore[arg-type]
    cells = rows(made, made.tets, made.cell_data["cell"])
    assert rows(again, again.tets, again.cell_data["cell"]) == cells
    # sheets are where cells meet, but for those that end inside a cell
    sheets, told = (each.grouped(sheets=True) for each in (again, given))
    assert {g.name for g in sheets.groups} <= {g.name for g in told.groups}
    assert len(sheets.triangles) > len(given.triangles)
    for group in sheets.groups[len(given.groups) :]:
        own = [
            each.triangles[each.triangle_tags == each.group(group.name).tag]
            for each in (sheets, told)
        ]
        turned = [{tuple(np.roll(t[:3], -int(t[:3].argmin())).tolist()) for t in x} for x in own]
        assert turned[0] == turned[1]
    assert decomp.check(sink(), again).shortcomings == ()


def test_fields_are_read(tmp_path: Path) -> None:
    part = decomp.Block((0, 0, 0), (2, 1, 1), name="part")
    made = decomp.mesh(part, size=0.7, fields=["distance", "nearest", "region"])
    made.write(tmp_path / "part.msh", text=True)
    again = decomp.read(tmp_path / "part.msh")
    assert np.array_equal(again.point_data["distance"], made.point_data["distance"])
    order = np.lexsort(made.tets.T), np.lexsort(again.tets.T)
    for name in ("cell", "nearest", "region"):
        assert np.array_equal(again.cell_data[name][order[1]], made.cell_data[name][order[0]])
        assert again.cell_data[name].dtype == np.int64


def test_a_mesh_without_parts(tmp_path: Path) -> None:
    """Of names alone kinds are told."""
    cube().write(tmp_path / "cube.msh")
    again = decomp.read(tmp_path / "cube.msh")
    assert again.parts is None
    given = cube().groups
    assert [(g.kind, g.tag, g.name) for g in again.groups] == [
        (g.kind, g.tag, g.name) for g in given
    ]
    with opened(tmp_path / "cube.msh") as gmsh:
        gmsh.model.addPhysicalGroup(3, [1, 2], 20, "both")
        gmsh.option.setNumber("Mesh.SaveAll", 1)
        gmsh.write(str(tmp_path / "both.msh"))
        gmsh.model.removePhysicalGroups()
        gmsh.write(str(tmp_path / "none.msh"))
    with pytest.raises(FileError, match=r"both\.msh: 4 tetrahedra are in several physical groups"):
        decomp.read(tmp_path / "both.msh")
    with pytest.raises(FileError, match=r"none\.msh: 12 tetrahedra are in no physical group"):
        decomp.read(tmp_path / "none.msh")


def test_what_gmsh_saves(tmp_path: Path) -> None:
    """It keeps comments and entities, and drops fields: cells are not known any more."""
    mesh().write(tmp_path / "sink.msh")
    with opened(tmp_path / "sink.msh") as gmsh:
        gmsh.write(str(tmp_path / "again.msh"))
    again = decomp.read(tmp_path / "again.msh")
    assert again.groups == mesh().groups
    assert again.parts is not None
    assert again.parts.cells == ()
    split = again.grouped(split_faces=True)
    assert split.group("sink/base.zmax@3").kind is decomp.GroupKind.FACE


@pytest.mark.parametrize("change", ["", "x", "{"])
def test_comments_that_were_changed(change: str, tmp_path: Path) -> None:
    path = tmp_path / "sink.msh"
    mesh().write(path, version="2.2")
    text = path.read_text().replace('decomp: {"model"', f'decomp: {change}"modal"', 1)
    path.write_text(text)
    again = decomp.read(path)
    assert again.parts is None
    assert {g.name for g in again.groups} == {g.name for g in mesh().groups}
    assert decomp.check(sink(), path).shortcomings == ()


def test_only_meshes_are_read(tmp_path: Path) -> None:
    bar().write(tmp_path / "bar.vtu")
    with pytest.raises(FileError, match=r"this is no .msh file"):
        decomp.read(tmp_path / "bar.vtu")
