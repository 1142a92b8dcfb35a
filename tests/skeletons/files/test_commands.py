"""`decomp skeleton` and `decomp cells`: output, files, errors, interruption."""

from __future__ import annotations

import json
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from decomp.cli.main import main
from tests.skeleton_fixtures import HOLDS, block

TEXT = "algebraic3d\nsolid block = orthobrick (0,0,0; 4,3,2);\ntlo block;\n"


@pytest.fixture
def model(tmp_path: Path) -> Path:
    path = tmp_path / "block.geo"
    path.write_text(TEXT)
    return path


@pytest.fixture
def computing(monkeypatch: pytest.MonkeyPatch) -> Callable[[Callable[..., Any]], None]:
    """Puts a function in the place of the one that computes skeletons."""

    def put(function: Callable[..., Any]) -> None:
        module = SimpleNamespace(skeleton=function)
        monkeypatch.setitem(sys.modules, "decomp.ways.skeleton", module)

    put(lambda geometry, tolerance, progress, method: block().skeleton)
    return put


pytestmark = pytest.mark.usefixtures("computing")


def test_skeleton_for_people(model: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["skeleton", str(model)]) == 0
    text = capsys.readouterr().out
    for part in (
        "1 region\n",
        "  sheets          13  area 35.9411255\n",
        "  seams           12  length ",
        "  junctions       12\n",
        "  reflexive        0\n",
        "  cells            6  volume 24\n",
        "  Euler            1  region 1\n",
        "  certificate holds: ",
    ):
        assert part in text
    assert main(["skeleton", str(model), "--certificate"]) == 0
    assert "    chord_error             0  at most 0.0005\n" in capsys.readouterr().out


def test_failing_figures_are_marked(
    model: Path,
    capsys: pytest.CaptureFixture[str],
    computing: Callable[[Callable[..., Any]], None],
) -> None:
    region = replace(
        block().skeleton.regions[0], certificate=replace(HOLDS, euler=3, residual=float("nan"))
    )
    computing(lambda *_: replace(block().skeleton, regions=(region,)))
    assert main(["skeleton", str(model), "--certificate"]) == 0
    text = capsys.readouterr().out
    assert "certificate FAILS: residual, euler\n" in text
    assert text.count("  FAILS\n") == 2


def test_skeleton_writes_files(model: Path, capsys: pytest.CaptureFixture[str]) -> None:
    one, two = model.with_name("out.vtu"), model.with_name("out.json")
    assert main(["skeleton", str(model), "-o", str(one), "-o", str(two), "--json"]) == 0
    assert one.exists()
    assert json.loads(two.read_text()) == json.loads(capsys.readouterr().out)
    assert main(["skeleton", str(model), "--quiet"]) == 0
    assert capsys.readouterr() == ("", "")


def test_options_reach_the_computation(
    model: Path, computing: Callable[[Callable[..., Any]], None]
) -> None:
    seen = []

    def compute(
        geometry: Any, tolerance: float, progress: Callable[[str, float], None], method: str
    ) -> Any:
        progress("half", 0.5)
        seen.append((geometry.diagonal, tolerance))
        return block().skeleton

    computing(compute)
    assert main(["skeleton", str(model), "--tolerance", "1e-3", "--quiet"]) == 0
    assert seen == [(pytest.approx(29**0.5), 1e-3)]


def test_bad_outputs_are_told_before_anything_is_computed(
    model: Path,
    capsys: pytest.CaptureFixture[str],
    computing: Callable[[Callable[..., Any]], None],
) -> None:
    computing(lambda *_, **__: pytest.fail("computed"))
    for arguments, message in (
        (["skeleton", str(model), "-o", "x.step"], "use .vtu, .ply, .obj, .json"),
        (["skeleton", str(model), "-o", "no/such/x.vtu"], "directory does not exist"),
        (["cells", str(model), "-o", str(model)], "is a file"),
    ):
        assert main(arguments) == 2
        captured = capsys.readouterr()
        assert captured.out == ""
        assert captured.err.startswith("decomp: error: ")
        assert captured.err.count("\n") == 1
        assert message in captured.err


@pytest.mark.parametrize("value", ["0", "-1", "nan", "inf", "1", "x"])
def test_bad_tolerances(value: str, model: Path) -> None:
    with pytest.raises(SystemExit) as caught:
        main(["skeleton", str(model), f"--tolerance={value}"])
    assert caught.value.code == 2


def test_bad_models_leave_nothing_behind(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    bad = tmp_path / "bad.geo"
    bad.write_text("algebraic3d\nsolid")
    assert main(["cells", str(bad), "-o", str(tmp_path / "cells")]) == 2
    assert "bad.geo" in capsys.readouterr().err
    assert [p.name for p in tmp_path.iterdir()] == ["bad.geo"]


def test_cells(model: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = model.with_name("cells")
    arguments = ["cells", str(model), "-o", str(folder), "--cells", "face", "--format", "ply"]
    assert main(arguments) == 0
    text = capsys.readouterr().out
    assert text.startswith("6 cells in ")
    assert "volume 2.33333333 " in text
    index = json.loads((folder / "index.json").read_text())
    assert index["kind"] == "face"
    assert {row["file"] for row in index["cells"]} < {p.name for p in folder.iterdir()}
    assert len(list(folder.iterdir())) == 7


def test_interruption(
    model: Path,
    capsys: pytest.CaptureFixture[str],
    computing: Callable[[Callable[..., Any]], None],
) -> None:
    def interrupted(*_: Any, **__: Any) -> Any:
        raise KeyboardInterrupt

    computing(interrupted)
    out = model.with_name("out.vtu")
    assert main(["skeleton", str(model), "-o", str(out)]) == 130
    assert main(["cells", str(model), "-o", str(model.with_name("cells"))]) == 130
    assert capsys.readouterr().err == "decomp: interrupted\n" * 2
    assert [p.name for p in model.parent.iterdir()] == ["block.geo"]
