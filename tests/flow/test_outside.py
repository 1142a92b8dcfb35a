"""The space around a model as a region: exact volumes, names, files, errors."""

from __future__ import annotations

import json
from math import pi, sqrt
from pathlib import Path

import pytest

import decomp
from decomp.cli.main import main
from decomp.errors import InputError

BLOCK = decomp.Block((1, 2, 3), (4, 3, 2), name="block")
DIAGONAL = sqrt(29)


@pytest.fixture
def part(tmp_path: Path) -> Path:
    path = tmp_path / "part.json"
    decomp.save(decomp.model(BLOCK, "part"), path)
    return path


@pytest.mark.parametrize("factor", [0.51, 2, 3.5])
def test_a_ball_around_a_block(factor: float) -> None:
    around = decomp.Geometry(decomp.with_outside(BLOCK, "ball", factor))
    inner, outer = around.regions
    assert (inner.name, outer.name) == ("solid", "outside")
    radius = factor * DIAGONAL
    assert outer.volume == pytest.approx(4 / 3 * pi * radius**3 - 24, rel=1e-9)
    assert outer.area == pytest.approx(4 * pi * radius**2 + 52, rel=1e-9)
    assert outer.euler == 2
    assert outer.bounds.mean(axis=0) == pytest.approx([3, 3.5, 4])
    names = {face.name for face in outer.faces}
    assert names == {"far.surface", *(f"block.{a}{end}" for a in "xyz" for end in ("min", "max"))}
    assert around.boundaries.touching == ((0, 1),)


def test_a_box_without_the_model() -> None:
    (only,) = decomp.Geometry(decomp.with_outside({"part": BLOCK}, "box", 1, only=True)).regions
    assert only.volume == pytest.approx((2 * DIAGONAL) ** 3 - 24, rel=1e-12)
    assert {face.name for face in only.faces if face.name.startswith("far.")} == {
        f"far.{axis}{end}" for axis in "xyz" for end in ("min", "max")
    }


def test_far_from_the_origin() -> None:
    moved = BLOCK.translate((1e7, -1e7, 1e7))
    outer = decomp.Geometry(decomp.with_outside(moved, "ball", 1)).regions[1]
    assert outer.volume == pytest.approx(4 / 3 * pi * DIAGONAL**3 - 24, rel=1e-9)


def test_the_exterior_skeleton_of_a_ball() -> None:
    """Between concentric spheres it is the sphere of the mean radius."""
    ball = decomp.Sphere((1, 0, 0), 1)
    found = decomp.skeleton(decomp.with_outside(ball, "ball", 1, only=True), 2e-3)
    (sheet,) = found.regions[0].sheets
    radius = (1 + 2 * sqrt(3)) / 2
    assert sheet.area == pytest.approx(4 * pi * radius**2, rel=5e-3)


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"shape": "cube"}, "shape must be"),
        ({"factor": 0.5}, "factor must be from 0.51"),
        ({"factor": "2"}, "factor must be a"),
        ({"only": 1}, "only must be"),
    ],
)
def test_bad_options(options: dict[str, object], said: str) -> None:
    with pytest.raises(InputError, match=said):
        decomp.with_outside(BLOCK, **options)  # type: ignore[arg-type]


def test_the_name_is_taken() -> None:
    with pytest.raises(InputError, match="has a region 'outside' already"):
        decomp.with_outside({"outside": BLOCK})


def test_info(part: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["info", str(part), "--outside", "ball:1", "--json"]) == 0
    inner, outer = json.loads(capsys.readouterr().out)["regions"]
    assert (inner["name"], outer["name"]) == ("solid", "outside")
    assert outer["volume"] == pytest.approx(4 / 3 * pi * DIAGONAL**3 - 24, rel=1e-9)
    assert main(["info", str(part), "--outside", "box", "--outside-only"]) == 0
    assert "region solid" not in capsys.readouterr().out


def test_a_mesh_that_is_checked(part: Path, capsys: pytest.CaptureFixture[str]) -> None:
    mesh = part.with_suffix(".msh")
    around = ["--outside", "ball:1"]
    assert main(["mesh", str(part), *around, "--cells", "none", "-o", str(mesh)]) == 0
    assert "region outside" in capsys.readouterr().out
    assert main(["check", str(part), str(mesh), *around]) == 0
    assert "nothing falls short" in capsys.readouterr().out
    assert main(["check", str(part), str(mesh)]) == 1


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--outside", "cube"], "must be ball or box, got 'cube'"),
        (["--outside", "ball:x"], "'x' is no number"),
        (["--outside-only"], "--outside-only needs --outside"),
        (["--outside", "ball:0.1"], "factor must be from 0.51"),
    ],
)
def test_wrong_commands(
    part: Path, words: list[str], said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    try:
        code = main(["info", str(part), *words])
    except SystemExit as end:
        code = end.code
    assert code == 2
    assert said in capsys.readouterr().err
