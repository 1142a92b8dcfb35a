"""Cells put together from oriented patches."""

from __future__ import annotations

import numpy as np
import pytest

from decomp.skeletons.cells.partition import face_cells, skeleton_cells
from decomp.skeletons.cells.surface import cell_surface, is_closed, open_edges, volume
from decomp.skeletons.model import Cell, TrimSurface
from tests.skeleton_fixtures import BLOCK_FACES, Made, block, capsule

VOLUMES = (7 / 3, 7 / 3, 10 / 3, 10 / 3, 19 / 3, 19 / 3)


def joined(made: Made, pairs: list[tuple[str, str]]) -> tuple[Cell, ...]:
    """Skeleton cells of the block as if the sheets between some faces were trim surfaces."""
    region = made.skeleton.regions[0]
    names = [face.name.removeprefix("block.") for face in region.boundary.faces]
    sites = made.skeleton.sites

    def faces(sheet: int) -> tuple[int, int]:
        a, b = (sites[k].index for k in region.sheets[sheet].sites)
        return a, b

    wanted = [{names.index(a), names.index(b)} for a, b in pairs]
    trims = [
        TrimSurface(sheet.patch, faces(k))
        for k, sheet in enumerate(region.sheets)
        if set(faces(k)) in wanted
    ]
    dropped = {trim.patch for trim in trims}
    sheets = [sheet for sheet in region.sheets if sheet.patch not in dropped]
    owner = {k: s.index for k, s in enumerate(sites) if s.region == 0}
    mesh = made.skeleton.complex
    cells = face_cells(mesh, region.boundary, region.face_sides, sheets, trims, owner)
    return skeleton_cells(mesh, region.boundary, cells, trims)


def test_the_cells_of_a_block() -> None:
    region = block().skeleton.regions[0]
    assert [cell.name for cell in region.cells] == [f"solid/block.{f}" for f in BLOCK_FACES]
    assert [cell.volume for cell in region.cells] == pytest.approx(VOLUMES, rel=1e-14)
    for cell, same in zip(region.cells, region.face_cells, strict=True):
        assert (cell.name, cell.faces, cell.sides) == (same.name, same.faces, same.sides)
        assert is_closed(block().skeleton.complex, cell.sides)
    assert all(len(cell.sides) == {"x": 5, "y": 5, "z": 6}[cell.name[-4]] for cell in region.cells)


def test_trim_surfaces_bound_face_cells_alone() -> None:
    made = capsule()
    region = made.skeleton.regions[0]
    assert [cell.name for cell in region.cells] == ["solid/rod.side+low.surface+high.surface"]
    assert [cell.name for cell in region.face_cells] == [
        f"solid/{f.name}" for f in region.boundary.faces
    ]
    assert sum(cell.volume for cell in region.face_cells) == pytest.approx(region.cells[0].volume)
    assert {patch for patch, _ in region.cells[0].sides} == {0, 1, 2}
    for cell in (*region.cells, *region.face_cells):
        assert is_closed(made.skeleton.complex, cell.sides)


def test_cells_joined_across_a_trim() -> None:
    cells = joined(block(), [("zmin", "zmax")])
    assert [cell.name for cell in cells][-1] == "solid/block.zmin+block.zmax"
    assert cells[-1].volume == pytest.approx(38 / 3)
    assert is_closed(block().skeleton.complex, cells[-1].sides)


def test_a_sheet_with_one_cell_on_both_sides_stands_twice() -> None:
    made = block()
    cells = joined(made, [("xmin", "zmin"), ("zmin", "zmax")])
    whole = next(cell for cell in cells if len(cell.faces) == 3)
    patches = [patch for patch, _ in whole.sides]
    twice = {patch for patch in patches if patches.count(patch) == 2}
    assert len(twice) == 1
    assert {sign for patch, sign in whole.sides if patch in twice} == {1, -1}
    assert whole.volume == pytest.approx(15)
    assert is_closed(made.skeleton.complex, whole.sides)


def test_cells_of_many_faces_are_numbered() -> None:
    cells = joined(block(), [("zmin", side) for side in BLOCK_FACES[:4]] + [("zmin", "zmax")])
    assert [cell.name for cell in cells] == ["solid/cell-1"]
    assert cells[0].volume == pytest.approx(24)


def test_edges_and_vertices_belong_to_their_owner() -> None:
    """A sheet of an edge with itself, or with its own face, has the owner's cell on both sides."""
    made = block()
    region = made.skeleton.regions[0]
    sheet = region.sheets[0]
    owner = {k: s.index for k, s in enumerate(made.skeleton.sites) if s.region == 0}
    sides = [list(own) for own in region.face_sides]
    mesh, both = made.skeleton.complex, dict.fromkeys(sheet.sites, 2)
    one = face_cells(mesh, region.boundary, sides, [sheet], [], both)
    assert one[2].sides[-2:] == ((sheet.patch, 1), (sheet.patch, -1))
    within = TrimSurface(sheet.patch, (2, 2))
    none = face_cells(mesh, region.boundary, sides, [], [within], owner)
    assert all(len(cell.sides) == 1 for cell in none)


def test_a_missing_side_leaves_a_cell_open() -> None:
    mesh = block().skeleton.complex
    cell = block().skeleton.regions[0].cells[0]
    assert not is_closed(mesh, cell.sides[1:])
    triangles = mesh.patches[cell.sides[0][0]].triangles
    assert len(open_edges(triangles)) == 4
    assert len(open_edges(np.concatenate([triangles, triangles[:, ::-1]]))) == 0


def test_turned_round_a_cell_has_negative_volume() -> None:
    mesh = block().skeleton.complex
    cell = block().skeleton.regions[0].cells[0]
    turned = [(patch, -sign) for patch, sign in cell.sides]
    assert volume(mesh, turned, np.array([1e3, 0, 0])) == pytest.approx(-7 / 3)


def test_a_surface_holds_only_the_points_that_it_uses() -> None:
    mesh = block().skeleton.complex
    points, triangles = cell_surface(mesh, block().skeleton.regions[0].cells[0].sides)
    assert len(points) == 6
    assert sorted(np.unique(triangles)) == list(range(6))
    assert points[:, 0].max() == 1.0
