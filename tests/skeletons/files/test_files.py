"""Skeletons and cells written to files, read back by other programs' readers."""

from __future__ import annotations

import json
from pathlib import Path

import meshio
import numpy as np
import pytest
import trimesh

from decomp.errors import FileError, InputError
from decomp.sites.site import Site, SiteKind
from decomp.skeletons.files import SUFFIXES, write
from decomp.skeletons.files.cells import file_stems, write_cells
from decomp.skeletons.files.elements import KINDS
from decomp.skeletons.files.labels import site_labels
from decomp.voronoi import Kind
from tests.skeleton_fixtures import block, capsule


def test_vtu(tmp_path: Path) -> None:
    skeleton = block().skeleton
    write(skeleton, tmp_path / "b.vtu")
    mesh = meshio.read(tmp_path / "b.vtu")
    assert np.array_equal(mesh.points, skeleton.complex.points)
    assert np.array_equal(mesh.point_data["radius"], skeleton.radius)
    assert {cells.type: len(cells.data) for cells in mesh.cells} == {"triangle": 22, "line": 12}
    sheet, seams = mesh.cell_data["sheet"]
    assert sorted(np.unique(sheet)) == list(range(13))
    assert (seams == -1).all()
    sites = mesh.cell_data["sites"][0]
    for number, made in enumerate(skeleton.regions[0].sheets):
        rows = sites[sheet == number]
        assert (rows[:, :2] == made.sites).all()
        assert (rows[:, 2:] == -1).all()
    assert (mesh.cell_data["parity"][0] == 0).all()
    assert (mesh.cell_data["surface"][0] == list(Kind).index(Kind.PLANE)).all()
    assert (mesh.cell_data["degree"][0] == 1).all()
    assert (mesh.cell_data["surface"][1] == -1).all()
    assert (mesh.cell_data["kind"][1] == KINDS.index("seam")).all()
    assert list(mesh.cell_data["seam"][1]) == list(range(12))


def test_vtu_with_boundary_trims_and_points(tmp_path: Path) -> None:
    skeleton = capsule().skeleton
    write(skeleton, tmp_path / "c.vtu")
    few = meshio.read(tmp_path / "c.vtu")
    assert {cells.type: len(cells.data) for cells in few.cells} == {"line": 1, "vertex": 2}
    write(skeleton, tmp_path / "c.vtu", boundary=True, trims=True)
    all_of_it = meshio.read(tmp_path / "c.vtu")
    assert len(all_of_it.points) == len(skeleton.complex.points)
    kinds = np.concatenate(all_of_it.cell_data["kind"])
    counts = {KINDS[k]: int(n) for k, n in zip(*np.unique(kinds, return_counts=True), strict=True)}
    assert counts == {"reflexive": 3, "face": 2304, "edge": 96, "trim surface": 96}


@pytest.mark.parametrize("suffix", [".ply", ".obj"])
def test_polygons(suffix: str, tmp_path: Path) -> None:
    path = tmp_path / f"b{suffix}"
    write(block().skeleton, path)
    sheets = trimesh.load(path, process=False, force="mesh")
    assert len(sheets.faces) == 22
    exact = sum(sheet.area for sheet in block().skeleton.regions[0].sheets)
    assert sheets.area == pytest.approx(exact, rel=1e-14)
    write(block().skeleton, path, boundary=True)
    assert len(trimesh.load(path, process=False, force="mesh").faces) == 34


def test_ply_tells_sheets_and_radii(tmp_path: Path) -> None:
    write(block().skeleton, tmp_path / "b.ply")
    raw = trimesh.load(tmp_path / "b.ply", process=False).metadata["_ply_raw"]
    assert sorted(np.unique(raw["face"]["data"]["sheet"])) == list(range(13))
    assert raw["vertex"]["data"]["radius"].max() == 1.0


def test_obj_groups_sheets(tmp_path: Path) -> None:
    write(block().skeleton, tmp_path / "b.obj")
    lines = (tmp_path / "b.obj").read_text().splitlines()
    assert [x for x in lines if x[0] == "g"] == [f"g solid/sheet-{k}" for k in range(13)]
    write(capsule().skeleton, tmp_path / "c.obj")
    assert (tmp_path / "c.obj").read_text().splitlines()[-4:] == [
        "g reflexive",
        "l 1 2",
        "p 1",
        "p 2",
    ]


def test_json(tmp_path: Path) -> None:
    write(block().skeleton, tmp_path / "b.json")
    data = json.loads((tmp_path / "b.json").read_text())
    assert list(data) == ["model", "diagonal", "regions"]
    region = data["regions"][0]
    assert list(region) == [
        "name", "method", "cause", "sheets", "seams", "junctions", "reflexive", "cells",
        "certificate",
    ]  # fmt: skip
    counts = {key: len(region[key]) for key in list(region)[3:8]}
    assert counts == {"sheets": 13, "seams": 12, "junctions": 12, "reflexive": 0, "cells": 6}
    assert region["sheets"][0] == {
        "id": 0,
        "sites": ["block.zmin", "block.zmax"],
        "parity": "even",
        "area": 2.0,
        "radius": [1.0, 1.0],
        "surface": {
            "kind": "plane",
            "degree": 1,
            "equation": "z - 1 = 0",
            "origin": region["sheets"][0]["surface"]["origin"],
            "axes": region["sheets"][0]["surface"]["axes"],
            "parameters": {},
        },
    }
    assert region["sheets"][0]["surface"]["origin"][2] == 1.0
    for seam in region["seams"]:
        assert list(seam) == ["id", "sites", "sheets", "length", "closed"]
        assert len(seam["sheets"]) == 3
    assert list(region["junctions"][0]) == ["point", "radius", "sites"]
    assert list(region["cells"][0]) == ["name", "faces", "volume"]
    assert list(region["certificate"]) == [
        "residual", "chord_error", "flipped", "open_cells", "volume_error", "euler",
        "expected_euler", "intrusion", "coverage",
    ]  # fmt: skip
    write(capsule().skeleton, tmp_path / "c.json")
    loci = json.loads((tmp_path / "c.json").read_text())["regions"][0]["reflexive"]
    assert loci[0] == {"site": "rod.side", "dimension": 1, "length": 3.0}
    assert loci[2] == {"site": "high.surface", "dimension": 0, "point": [0, 0, 3]}


def test_unknown_suffixes_are_told(tmp_path: Path) -> None:
    for name in ("b.stl", "b"):
        with pytest.raises(InputError, match=r"use .vtu, .ply, .obj, .json"):
            write(block().skeleton, tmp_path / name)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_a_file_is_written_whole_or_not_at_all(
    suffix: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / f"b{suffix}"
    path.write_text("old")

    def interrupted(self: Path, data: bytes) -> int:
        with self.open("wb") as file:
            file.write(data[:10])
        raise KeyboardInterrupt

    monkeypatch.setattr(Path, "write_bytes", interrupted)
    with pytest.raises(KeyboardInterrupt):
        write(block().skeleton, path)
    assert path.read_text() == "old"
    assert [p.name for p in tmp_path.iterdir()] == [path.name]


def test_targets_that_cannot_be_written(tmp_path: Path) -> None:
    with pytest.raises(FileError, match="directory does not exist"):
        write(block().skeleton, tmp_path / "no" / "b.vtu")
    (tmp_path / "d.vtu").mkdir()
    with pytest.raises(FileError, match="this is a directory"):
        write(block().skeleton, tmp_path / "d.vtu")
    (tmp_path / "file").write_text("")
    with pytest.raises(FileError, match="is a file"):
        write_cells(block().skeleton, tmp_path / "file" / "cells")


@pytest.mark.parametrize("form", ["stl", "obj", "ply"])
@pytest.mark.parametrize("kind", ["skeleton", "face"])
def test_cells(kind: str, form: str, tmp_path: Path) -> None:
    for made, count in ((block(), 6), (capsule(), 1 if kind == "skeleton" else 3)):
        folder = tmp_path / str(count) / "cells"
        files = write_cells(made.skeleton, folder, kind, form)  # type: ignore[arg-type]
        assert sorted(folder.iterdir()) == sorted(files)
        index = json.loads((folder / "index.json").read_text())
        assert index["kind"] == kind
        assert len(index["cells"]) == count
        for row in index["cells"]:
            mesh = trimesh.load(folder / row["file"], force="mesh")
            assert mesh.is_watertight
            assert mesh.volume == pytest.approx(row["volume"], rel=1e-6)
            assert len(mesh.faces) == row["triangles"]


def test_file_names_are_safe_and_different() -> None:
    names = ["a/b.x", "a_b.x", "A/B.X", "../x", "index", "a/" + "ö" * 300, "r:1/f+g@2", "-o/x"]
    stems = file_stems(names)
    assert stems[:5] == ["a_b.x", "a_b.x~2", "A_B.X~3", "_._x", "index~2"]
    assert len(stems[5].encode()) <= 200
    assert stems[6:] == ["r_1_f+g@2", "_o_x"]


def test_site_labels_are_unique_within_a_region() -> None:
    sites = [Site(r, SiteKind.EDGE, k, "a|b") for r in (0, 1) for k in (0, 1)]
    assert site_labels(sites) == ("a|b", "a|b@2", "a|b", "a|b@2")
