"""The command line: output, errors as one line, exit codes."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from decomp.cli.main import main

MESHES = Path(__file__).parents[2] / "meshes"

BLOCK = "algebraic3d\nsolid b = orthobrick (0,0,0; 4,3,2);\ntlo b -maxh=0.5;\npoint (1,1,1);\n"

BAD_MODELS = {
    "empty region": ("solid e = sphere (0,0,0; 1) and sphere (5,0,0; 1);\ntlo e;", "is empty", 3),
    "unbounded region": (
        "solid u = plane (0,0,0; 0,0,1) and cylinder (0,0,0; 0,0,1; 1);\ntlo u;",
        "unbounded: it reaches infinity in direction (",
        3,
    ),
    "overlap": (
        "solid a = sphere (0,0,0; 1);\nsolid b = sphere (1,0,0; 1);\ntlo a;\ntlo b;",
        "regions 'a' and 'b' overlap: both hold the point (",
        3,
    ),
    "negative radius": ("solid s = sphere (0,0,0; -1);\ntlo s;", "radius must be positive", 2),
    "zero axis": ("solid s = plane (0,0,0; 0,0,0);\ntlo s;", "zero vector", 2),
    "undefined solid": ("solid s = t;\ntlo s;", "'t'", 2),
    "outside the primitives": (
        "solid s = ellipsoid (0,0,0; 1,0,0; 0,2,0; 0,0,3);\ntlo s;",
        "ellipsoid",
        2,
    ),
}


@pytest.fixture
def block(tmp_path: Path) -> Path:
    path = tmp_path / "block.geo"
    path.write_text(BLOCK)
    return path


def test_info_for_people(block: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["info", str(block)]) == 0
    text = capsys.readouterr().out
    for part in ("region b", "volume  24 ", "area    52 ", "6 faces", "12 convex line", "point"):
        assert part in text


def test_info_as_json(block: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["info", str(block), "--json"]) == 0
    data = json.loads(capsys.readouterr().out)
    assert list(data) == ["model", "diagonal", "regions", "touching", "ignored"]
    region = data["regions"][0]
    assert region["name"] == "b"
    assert region["volume"] == pytest.approx(24)
    assert region["bbox"] == [[0, 0, 0], [4, 3, 2]]
    assert region["euler"] == 1
    assert {"name": "b.xmin", "carrier": "plane", "area": pytest.approx(6)} in region["faces"]
    assert len(region["edges"]) == 12
    assert set(region["edges"][0]) == {"faces", "curve", "convexity", "length"}
    assert len(region["vertices"]) == 8
    assert set(region["vertices"][0]) == {"point", "faces", "convexity"}
    assert data["ignored"] == [{"statement": "point (1,1,1)", "line": 4}]


@pytest.mark.parametrize("name", BAD_MODELS)
def test_bad_models_give_one_clear_line(
    name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    text, message, code = BAD_MODELS[name]
    path = tmp_path / "bad.geo"
    path.write_text("algebraic3d\n" + text)
    assert main(["info", str(path)]) == code
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err.startswith("decomp: error: ")
    assert captured.err.count("\n") == 1
    assert message in captured.err


def test_missing_file(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["info", "no/such/file.geo"]) == 2
    assert "no/such/file.geo" in capsys.readouterr().err


def test_convert_round_trips(block: Path, capsys: pytest.CaptureFixture[str]) -> None:
    output = block.with_name("out.json")
    assert main(["convert", str(block), str(output)]) == 0
    main(["info", str(block), "--json"])
    direct = json.loads(capsys.readouterr().out)
    main(["info", str(output), "--json"])
    converted = json.loads(capsys.readouterr().out)
    assert _rounded(converted) == _rounded(direct)


def _rounded(value: Any) -> Any:
    """JSON values with numbers to 12 digits: sums depend on how memory is aligned."""
    if isinstance(value, float):
        return float(f"{value:.12g}")
    if isinstance(value, list):
        return [_rounded(item) for item in value]
    if isinstance(value, dict):
        return {k: _rounded(v) for k, v in value.items() if not k.endswith("_error")}
    return value


def test_convert_leaves_no_half_written_file(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    bad = tmp_path / "bad.geo"
    bad.write_text("algebraic3d\nsolid")
    assert main(["convert", str(bad), str(tmp_path / "out.json")]) == 2
    assert sorted(p.name for p in tmp_path.iterdir()) == ["bad.geo"]


def test_no_command_shows_help(capsys: pytest.CaptureFixture[str]) -> None:
    assert main([]) == 2
    assert "examples:" in capsys.readouterr().out


def test_as_a_module() -> None:
    command = [sys.executable, "-m", "decomp", "info", str(MESHES / "flange.geo")]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    assert done.stdout.startswith("model flange: 1 region")


def test_help_loads_nothing_heavy() -> None:
    """`decomp --help` must start fast, so it must not import numerical packages."""
    code = (
        "import sys; from decomp.cli.main import parser; parser().format_help();"
        "print(sorted({'numpy','scipy','numba','lark','rich'} & set(sys.modules)))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


def test_info_loads_neither_numba_nor_scipy() -> None:
    code = (
        "import sys; from decomp.cli.main import main;"
        f"main(['info', {str(MESHES / 'flange.geo')!r}]);"
        "print(sorted({'scipy','numba'} & set(sys.modules)), file=sys.stderr)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stderr.strip() == "[]"
