"""Every command on a model that stands far from the origin: places are where it stands."""

from __future__ import annotations

import json
import pickle
import re
from pathlib import Path

import meshio
import numpy as np
import pytest
import pyvista
import trimesh

import decomp
from decomp.cli.main import main
from decomp.errors import InputError
from decomp.meshes.files.msh_reader import read_msh
from decomp.skeletons.files import stl
from decomp.view.reading import scene_of

MOVE = np.array([-1e6, 2e6, 0.1])
TEXT = """algebraic3d
solid block = orthobrick (0,0,0; 4,3,2);
solid part = translate (-1000000, 2000000, 0.1; block);
tlo part;
"""
KISS = """algebraic3d
solid one = sphere (1000000, 0, 0; 1);
solid two = sphere (1000002, 0, 0; 1);
solid kiss = one or two;
tlo kiss;
"""


@pytest.fixture
def model(tmp_path: Path) -> Path:
    path = tmp_path / "far.geo"
    path.write_text(TEXT)
    return path


def test_info(model: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["info", str(model)]) == 0
    assert "  box     -1000000 2000000 0.1  to  -999996 2000003 2.1\n" in capsys.readouterr().out
    assert main(["info", str(model), "--json"]) == 0
    region = json.loads(capsys.readouterr().out)["regions"][0]
    assert region["bbox"] == [[-1000000, 2000000, 0.1], [-999996, 2000003, 2.1]]
    corners = np.array([vertex["point"] for vertex in region["vertices"]])
    expected = [(x, y, z) for x in (0, 4) for y in (0, 3) for z in (0, 2)]
    assert sorted(map(tuple, (corners - MOVE).round(9) + 0.0)) == expected
    # fewer digits are enough for what is near
    near = model.with_name("near.geo")
    near.write_text(TEXT.replace("2000000", "1").replace("1000000", "1"))
    assert main(["info", str(near)]) == 0
    assert "  box     -1 1 0.1  to  3 4 2.1\n" in capsys.readouterr().out


def test_skeletons_and_their_files(model: Path, capsys: pytest.CaptureFixture[str]) -> None:
    files = [model.with_suffix(suffix) for suffix in (".json", ".vtu", ".ply", ".obj")]
    outputs = [word for file in files for word in ("-o", str(file))]
    assert main(["skeleton", str(model), *outputs]) == 0
    assert "  sheets          13  area 35.9411255\n" in capsys.readouterr().out
    found = json.loads(files[0].read_text())
    (start,) = {tuple(found["equations_from"])}
    points = np.array([junction["point"] for junction in found["regions"][0]["junctions"]])
    assert points.min(axis=0) == pytest.approx(MOVE, abs=1e-9)
    for held in (pyvista.read(files[1]).points, trimesh.load(files[2], process=False).vertices):
        assert held.min(axis=0) == pytest.approx(MOVE, abs=1e-9)
        assert held.max(axis=0) == pytest.approx(np.add(MOVE, (4, 3, 2)), abs=1e-9)
    field = pyvista.read(files[1]).field_data
    assert field["equation_origin"].tolist() == [list(start)]
    lines = [line for line in files[3].read_text().splitlines() if line.startswith("v ")]
    assert np.array([line.split()[1:] for line in lines], dtype=float).min(axis=0) == pytest.approx(
        MOVE, abs=1e-9
    )
    assert main(["describe", str(model)]) == 0
    text = capsys.readouterr().out
    place = re.search(r"x, y, z of equations are counted from \((\S+), (\S+), (\S+)\)", text)
    assert place is not None
    assert tuple(map(float, place.groups())) == start


def test_meshes(model: Path, capsys: pytest.CaptureFixture[str]) -> None:
    mesh, report, page = (model.with_suffix(s) for s in (".msh", ".report.json", ".html"))
    command = ["mesh", str(model), "-o", str(mesh), "--size", "1", "--report", str(report)]
    assert main([*command, "--cells", "none"]) == 0
    capsys.readouterr()
    held = meshio.read(mesh).points
    assert held.min(axis=0) == pytest.approx(MOVE, abs=1e-9)
    assert held.max(axis=0) == pytest.approx(np.add(MOVE, (4, 3, 2)), abs=1e-9)
    assert json.loads(report.read_text())["regions"][0]["volume"] == pytest.approx(24, rel=1e-8)
    assert main(["check", str(model), str(mesh)]) == 0
    assert "nothing falls short" in capsys.readouterr().out
    assert main(["view", str(mesh), "-o", str(page)]) == 0
    # pages hold single precision, in which these coordinates are 0.1 apart
    scene = scene_of(mesh)
    assert scene.points + scene.origin == pytest.approx(read_msh(mesh).points, abs=1e-8)
    assert scene.points.min(axis=0) == pytest.approx([-2, -1.5, -1], abs=1e-8)
    beside = model.with_name("beside.geo")
    beside.write_text(TEXT.replace("1000000", "1000001"))
    assert main(["check", str(beside), str(mesh)]) == 1
    assert "exact surfaces, by up to" in capsys.readouterr().out


def test_models_in_the_own_form(model: Path) -> None:
    own = model.with_suffix(".json")
    assert main(["convert", str(model), str(own)]) == 0
    one, other = decomp.Geometry(model), decomp.Geometry(own)
    assert one.offset.tolist() == other.offset.tolist()
    assert one.regions[0].bounds.tolist() == other.regions[0].bounds.tolist()


def test_turns_about_a_far_centre_are_kept(tmp_path: Path) -> None:
    """A file tells the centre, from which the place follows exactly; the offset is rounded."""
    file = tmp_path / "turned.json"
    block = decomp.Block((1e9 - 1, 1e9, 0), (2, 2, 1)).rotate((1, 2, 3), 30, centre=(1e9, 1e9, 1))
    decomp.save(block, file)
    one, other = (decomp.Geometry(source).local.boundaries for source in (block, str(file)))
    for a, b in zip(one.form.carriers, other.form.carriers, strict=True):
        assert a.packed().tolist() == b.packed().tolist()
    text = file.read_text()
    assert '"fixed": [1000000000.0, 1000000000.0, 1.0]' in text
    file.write_text(text.replace('"fixed": [1000000000.0', '"fixed": [1000000007.0'))
    with pytest.raises(InputError, match=r"fixed must be a point that the transform leaves where"):
        decomp.load(file)


def test_messages_tell_places_in_the_model(tmp_path: Path) -> None:
    file = tmp_path / "kiss.geo"
    file.write_text(KISS)
    geometry = decomp.Geometry(file)
    assert geometry.offset.any()
    where = re.escape("(1000001, 0, 0)")
    assert re.search(where, geometry.regions[0].touches[0])
    with pytest.raises(decomp.DecompError, match=where):
        decomp.skeleton(geometry)
    with pytest.raises(decomp.DecompError, match=r"hold the point \(100000[01]\.?\d*, "):
        decomp.Geometry(
            {"a": decomp.Sphere((1e6, 0, 0), 1), "b": decomp.Sphere((1e6 + 1, 0, 0), 1)}
        )
    with pytest.raises(InputError, match=r"got \[nan, 1\.0, 2\.0\] at index 0"):
        geometry.nearest([(np.nan, 1, 2)])


def test_stl_files_that_would_be_spoiled_are_refused() -> None:
    points = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]])
    triangle = np.arange(3)[None]
    assert len(stl.surface(points + 100, triangle)) == 134
    with pytest.raises(InputError, match=r"single precision.* write \.ply or \.obj"):
        stl.surface(points + 1e6, triangle)


def test_geometries_are_pickled(model: Path) -> None:
    geometry = decomp.Geometry(model)
    again = pickle.loads(pickle.dumps(geometry))
    points = np.add(MOVE, [(1, 1, 1), (5, 1, 1), (2, 1.5, 0.25)])
    for one in (geometry, again):
        assert one.contains(points).tolist() == [True, False, True]
        assert one.region_of(points).tolist() == [0, -1, 0]
        assert one.distance(points) == pytest.approx([-1, 1, -0.25], abs=1e-9)
        assert one.nearest(points).foot[2] == pytest.approx(np.add(MOVE, (2, 1.5, 0)), abs=1e-9)
