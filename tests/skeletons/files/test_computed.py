"""`decomp skeleton` and `decomp cells` from model file to output, nothing faked."""

from __future__ import annotations

import json
from pathlib import Path

import meshio
import numpy as np
import pytest
import trimesh

from decomp.cli.main import main
from decomp.errors import GeometryError

HOLE = """algebraic3d
solid plate = orthobrick (0,0,0; 4,4,2);
solid hole = cylinder (2,2,1; 2,2,3; 1) and plane (0,0,1; 0,0,-1);
solid part = plate and not hole;
tlo part;
"""


@pytest.fixture
def model(tmp_path: Path) -> Path:
    path = tmp_path / "blind.geo"
    path.write_text(HOLE)
    return path


def test_skeleton(model: Path, capsys: pytest.CaptureFixture[str]) -> None:
    outputs = [model.with_suffix(suffix) for suffix in (".vtu", ".ply", ".obj", ".json")]
    arguments = ["skeleton", str(model), "--certificate"]
    for path in outputs:
        arguments += ["-o", str(path)]
    assert main(arguments) == 0
    text = capsys.readouterr().out
    for part in ("  sheets          23", "  seams           24", "  junctions       16", "holds"):
        assert part in text
    assert "FAILS" not in text
    region = json.loads(outputs[3].read_text())["regions"][0]
    assert len(region["sheets"]) == 23
    assert len(region["seams"]) == 24
    assert len(region["junctions"]) == 16
    assert region["certificate"]["residual"] <= 1e-12
    assert region["certificate"]["euler"] == region["certificate"]["expected_euler"] == 1
    assert sum(cell["volume"] for cell in region["cells"]) == pytest.approx(32 - np.pi, rel=1e-3)
    mesh = meshio.read(outputs[0])
    assert "radius" in mesh.point_data
    triangles = mesh.cells_dict["triangle"]
    sheet = np.concatenate(
        [
            values
            for block, values in zip(mesh.cells, mesh.cell_data["sheet"], strict=True)
            if block.type == "triangle"
        ]
    )
    assert len(sheet) == len(triangles)
    assert set(sheet.tolist()) == set(range(23))
    area = sum(each["area"] for each in region["sheets"])
    for path in outputs[1:3]:
        assert trimesh.load(path, process=False).area == pytest.approx(area, rel=1e-5)


@pytest.mark.parametrize(("kind", "count"), [("skeleton", 7), ("face", 8)])
def test_cells(kind: str, count: int, model: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = model.with_name("cells")
    assert main(["cells", str(model), "-o", str(folder), "--cells", kind, "--format", "ply"]) == 0
    assert capsys.readouterr().out.startswith(f"{count} cells in ")
    rows = json.loads((folder / "index.json").read_text())["cells"]
    assert len(rows) == count
    total = 0.0
    for row in rows:
        surface = trimesh.load(folder / row["file"])
        assert surface.is_watertight
        assert surface.volume == pytest.approx(row["volume"], rel=1e-5)
        total += surface.volume
    assert total == pytest.approx(32 - np.pi, rel=1e-3)


def test_what_cannot_be_certified_is_one_clear_line(
    model: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """A limit that no figure can meet: the error tells the figure, and if asked what was tried."""
    from decomp.skeletons import compute
    from decomp.skeletons.certificate import certificate

    monkeypatch.setattr(certificate, "INTRUSION", -1.0)
    monkeypatch.setattr(compute, "SAMPLES", (2000, 3000))
    out = model.with_suffix(".vtu")
    assert main(["skeleton", str(model), "-o", str(out)]) == GeometryError.exit_code
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err.startswith("decomp: error: ")
    assert captured.err.count("\n") == 1
    for part in ("fails its certificate", "region part", "intrusion is", "allowed"):
        assert part in captured.err
    assert main(["skeleton", str(model), "-o", str(out), "--verbose"]) == GeometryError.exit_code
    first, *tried = capsys.readouterr().err.splitlines()
    assert first == captured.err.rstrip("\n")
    assert tried[0].startswith("  in certificate, region part, at ")
    for samples, line in zip((2000, 3000), tried[1:], strict=True):
        assert f"from {samples} boundary points" in line
    assert not out.exists()
