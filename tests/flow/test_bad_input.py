"""Bad input gets one clear error in time, or is forgiven as the format's own program does."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import time
import warnings
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from benchmarks.fuzz import fuzz, meshes, originals, within
from decomp import Block, Cone, Cylinder, Geometry, HalfSpace, InfiniteCone, Sphere, Torus
from decomp.cli.main import main
from decomp.csg.counting import MOST_PRIMITIVES, refuse_too_many
from decomp.csg.halfspaces import half_space_form
from decomp.csg.model import Model, Region, model
from decomp.csg.solid import Labelled, Solid, Union
from decomp.errors import DecompError, EmptyRegionError, GeometryError, InputError, ParseError
from decomp.formats import load, loads, save
from decomp.magnitude import FARTHEST, LARGEST, SMALLEST

GEO = "algebraic3d\n"
IDENTITY = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]


def doubled(times: int) -> Solid:
    solid: Solid = Sphere((0, 0, 0), 0.1)
    for k in range(times):
        solid = solid | solid.translate((2.0 ** (k % 100), 0, 0))
    return solid


def native(**changes: Any) -> str:
    """A block as JSON, with some of it changed."""
    node = {"type": "block", "name": "p", "corner": [0, 0, 0], "size": [1, 1, 2]}
    region = {"name": "r", "solid": 0, "options": {}}
    text = {"format": "decomp", "version": 1, "name": "m", "regions": [region], "nodes": [node]}
    for key, value in changes.items():
        place = node if key in node and key != "name" else text
        place[key] = value
    return json.dumps(text)


BOMBS: dict[str, Callable[[], Solid]] = {
    "doublings": lambda: doubled(40),
    "a thousand doublings": lambda: doubled(1000),
    "copies of copies": lambda: (
        Sphere((0, 0, 0), 0.1)
        .linear_copies((1, 0, 0), 100)
        .linear_copies((0, 1, 0), 100)
        .polar_copies((0, 0, 1), 100)
    ),
    "copies of nothing": lambda: (
        Union(()).linear_copies((1, 0, 0), 1000).linear_copies((0, 1, 0), 1000)
    ),
}


@pytest.mark.parametrize("bomb", BOMBS)
def test_bombs_of_copies(bomb: str) -> None:
    solid = BOMBS[bomb]()
    start = time.process_time()
    with pytest.raises(InputError, match=r"(primitives|operations) when all copies are made"):
        Geometry(solid)
    assert time.process_time() - start < 2


def test_the_number_is_exact(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    lines = [f"solid s{k + 1} = translate ({2**k},0,0; s{k}) or s{k};" for k in range(30)]
    path = tmp_path / "bomb.geo"
    path.write_text(f"{GEO}solid s0 = sphere (0,0,0; 0.1);\n" + "\n".join(lines) + "\ntlo s30;\n")
    assert main(["info", str(path)]) == 2
    assert f"has {2**30:,} primitives" in capsys.readouterr().err


def test_copies_in_many_statements() -> None:
    copies = "".join(f"solid c{k} = multitranslate (1,0,0; 60000; a);\n" for k in range(9))
    with pytest.raises(ParseError, match="3:12: here the file has made 120,000 copies"):
        loads(f"{GEO}solid a = sphere (0,0,0; 0.1); {copies}tlo a;", "geo")


def test_counts_are_those_of_the_expansion() -> None:
    ball = Sphere((0, 0, 0), 1)
    shared = ball | ball.translate((3, 0, 0))
    for solid in (
        shared & shared,
        (shared & ball) | (shared - ball),
        shared.linear_copies((9, 0, 0), 3) | shared,
        Labelled(shared, "a") | Labelled(shared, "b") | shared.scale(2),
        doubled(9),
    ):
        form = half_space_form(model(solid))
        for most, fits in ((len(form.placed), True), (len(form.placed) - 1, False)):
            with pytest.MonkeyPatch.context() as patch:
                patch.setattr("decomp.csg.counting.MOST_PRIMITIVES", most)
                if fits:
                    refuse_too_many(model(solid))
                else:
                    with pytest.raises(InputError, match=f"has {most + 1:,} primitives"):
                        refuse_too_many(model(solid))


def test_regions_that_share_a_solid_count_it_once() -> None:
    part = doubled(16)
    regions = tuple(Region(f"r{k}", part - Sphere((k, 0, 0), 0.1)) for k in range(5))
    assert 5 * 2**16 > MOST_PRIMITIVES > 2**16
    refuse_too_many(Model(regions))


def test_plain_sharing_is_no_bomb() -> None:
    solid: Solid = Block((0, 0, 0), (1, 1, 1), "b")
    for k in range(60):
        solid = (solid & Sphere((0, 0, 0), 9 + k)) | (solid & Sphere((1, 0, 0), 9 + k))
    refuse_too_many(model(solid))
    assert len(half_space_form(model(solid)).placed) == 121


def test_endless_names() -> None:
    solid: Solid = Sphere((0, 0, 0), 1)
    for _ in range(2000):
        solid = solid.linear_copies((9, 0, 0), 1)
    with pytest.raises(InputError, match="nested so deep"):
        Geometry(solid)
    with pytest.raises(ParseError, match=r"2:7: a name has 5,000 characters"):
        loads(f"{GEO}solid {'a' * 5000} = sphere (0,0,0; 1);\n", "geo")


FAR = 1e308
BALL = f"{GEO}solid b = sphere (0,0,0;1);\n"
PRIMITIVES: dict[str, Callable[[float], object]] = {
    "block corner": lambda x: Block((x, 0, 0), (1, 1, 1)),
    "block size": lambda x: Block((0, 0, 0), (1, x, 1)),
    "sphere centre": lambda x: Sphere((0, x, 0), 1),
    "sphere radius": lambda x: Sphere((0, 0, 0), x),
    "cylinder base": lambda x: Cylinder((x, 0, 0), (0, 0, 1), 1),
    "cylinder radius": lambda x: Cylinder((0, 0, 0), (0, 0, 1), x),
    "cone base radius": lambda x: Cone((0, 0, 0), x, (0, 0, 1), 0.5),
    "cone top": lambda x: Cone((0, 0, 0), 1, (0, 0, x), 0.5),
    "torus centre": lambda x: Torus((0, 0, x), (1, 0, 0), 2, 1),
    "torus major radius": lambda x: Torus((0, 0, 0), (1, 0, 0), x, 1e-60),
    "plane point": lambda x: HalfSpace((0, 0, x), (0, 0, 1)),
    "cone apex": lambda x: InfiniteCone((x, 0, 0), (0, 0, 1), 30),
    "translation": lambda x: Sphere((0, 0, 0), 1).translate((x, 0, 0)),
    "scale factor": lambda x: Sphere((0, 0, 0), 1).scale(x),
    "mirror point": lambda x: Sphere((0, 0, 0), 1).mirror((1, 0, 0), (x, 0, 0)),
    "transform": lambda x: Sphere((0, 0, 0), 1).transform(np.diag([x, x, x, 1])),
}


@pytest.mark.parametrize(
    "value", [FAR, -FAR, 2 * LARGEST, 10**400, np.nan, np.inf], ids=lambda value: str(value)[:6]
)
@pytest.mark.parametrize("what", PRIMITIVES)
def test_numbers_too_large(what: str, value: float) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with pytest.raises(InputError, match=r"too large|finite|positive|negative|three numbers"):
            PRIMITIVES[what](value)


@pytest.mark.parametrize(
    "what", [name for name in PRIMITIVES if "radius" in name or "size" in name or "scale" in name]
)
def test_lengths_too_small(what: str) -> None:
    with pytest.raises(InputError, match="too small to compute with"):
        PRIMITIVES[what](SMALLEST / 2)


@pytest.mark.parametrize("number", ["1e308", "-1e308", "1e400", "9" * 400], ids=lambda n: n[:6])
@pytest.mark.parametrize(
    ("form", "text"),
    [
        ("geo", "algebraic3d\nsolid a = torus (0,0,{}; 1,0,0; 2; 1); tlo a;"),
        ("geo", "algebraic3d\nsolid a = cylinder (0,0,{}; 0,0,-{}; 2); tlo a;"),
        ("geo", f"{BALL}solid a = rotate (0,0,0; {{}},0,0; b);tlo a;"),
        ("geo", f"{BALL}solid a = multitranslate ({{}},0,0; 9; b);"),
        ("csg", "multmatrix([[1,0,0,{}],[0,1,0,0],[0,0,1,0],[0,0,0,1]]) {{ cube(1); }}"),
        ("csg", "cylinder(h = {}, r = 1);"),
        ("json", native(corner=[0, 0, "X"])),
        ("json", native(size=[1, "X", 1])),
    ],
)
def test_numbers_too_large_in_files(form: Any, text: str, number: str) -> None:
    text = text.replace("--", "") if form == "json" else text.format(number, number)
    text = text.replace("--", "").replace('"X"', number)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with pytest.raises(ParseError, match=r"too large to compute with|finite|positive|negative"):
            loads(text, form)


@pytest.mark.parametrize("power", [-40, -20, 20, 40])
def test_within_the_limits_nothing_is_lost(power: int) -> None:
    unit = 10.0**power
    solid = (Torus((0, 0, 0), (0, 0, 1), 3, 1) - Block((-9, -9, 0.3), (18, 18, 9))).scale(unit)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        volume = Geometry(solid).regions[0].volume / unit / unit / unit
    # of the tube's section, a unit disc, what is below 0.3
    section = np.pi / 2 + np.arcsin(0.3) + 0.3 * np.sqrt(1 - 0.3**2)
    assert volume == pytest.approx(6 * np.pi * section, rel=1e-12)


@pytest.mark.parametrize(
    ("solid", "message"),
    [
        (Sphere((0, 0, 0), 1).scale(1e30).scale(1e30), "too large to compute with"),
        (Sphere((0, 0, 0), 1).scale(1e-30).scale(1e-30), "too small to compute with"),
        (Sphere((0, 0, 10 * FARTHEST), 1), "away from the origin"),
        (Block((0, 0, 0), (9, 9, 9)) - Sphere((5, 5, 5), 1e-20), "lost in the digits"),
    ],
)
def test_what_moves_and_scales_add_up_to(solid: Solid, message: str) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with pytest.raises(InputError, match=message):
            Geometry(solid)


@pytest.mark.parametrize(
    ("text", "place"),
    [
        (native(name="\ud800"), "the file.name"),
        (native(regions=[{"name": "\udfff", "solid": 0}]), r"regions\[0\].name"),
        (native(regions=[{"name": "a", "solid": 0, "options": {"\ud800": 1}}]), "options"),
        (native(regions=[{"name": "a", "solid": 0, "options": {"a": ["\ud800"]}}]), "options"),
        (
            native(regions=[{"name": "a", "solid": 0, "options": {"material": "\ud800"}}]),
            "material",
        ),
        (native(ignored=[{"statement": "\ud800", "line": 1}]), r"ignored\[0\].statement"),
        (native(nodes=[{"type": "sphere", "name": "\ud800"}]), r"nodes\[0\]"),
        (native(version="\ud800"), "version"),
    ],
)
def test_halves_of_surrogate_pairs(text: str, place: str, tmp_path: Path) -> None:
    path = tmp_path / "half.json"
    path.write_text(text)
    with pytest.raises(ParseError, match=place) as caught:
        load(path)
    assert str(caught.value).isprintable()


NASTY = "\x1b[2J\x07\x9b31m\u202e"


def said(arguments: list[str], capsys: pytest.CaptureFixture[str]) -> tuple[int, str]:
    code = main(arguments)
    captured = capsys.readouterr()
    return code, captured.out + captured.err


@pytest.mark.slow
def test_names_steer_no_terminal(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    block = Block((0, 0, 0), (1, 1, 2), NASTY)
    good, bad = tmp_path / "good.json", tmp_path / "bad.json"
    save(Model((Region(NASTY, block),), NASTY), good)
    save(Model((Region(NASTY, block), Region("other", block)), NASTY), bad)
    folder = str(tmp_path / "cells")
    for command, code in (
        (["info", str(good)], 0),
        (["info", str(good), "--json"], 0),
        (["describe", str(good)], 0),
        (["skeleton", str(good), "-o", str(tmp_path / "s.json"), "--certificate"], 0),
        (["cells", str(good), "-o", folder], 0),
        (["info", str(bad)], 3),
        (["info", str(tmp_path / f"{NASTY}.json")], 2),
    ):
        found, text = said(command, capsys)
        assert found == code, text
        assert all(line.isprintable() for line in text.split("\n")), command
        assert "\\x1b[2J" in text or "\\u001b" in text


def test_file_names_that_are_no_text(tmp_path: Path) -> None:
    path = os.fsencode(tmp_path) + b"/\xff\xfe.geo"
    Path(os.fsdecode(path)).write_text(f"{GEO}solid a = sphere (0,0,0; 1);\ntlo a;\n")
    assert load(os.fsdecode(path)).name == "\ufffd\ufffd"
    for command, code in (("info", 0), ("convert", 2)):
        run = subprocess.run(
            [sys.executable, "-m", "decomp", command, path, *([path] if code else [])],
            capture_output=True,
            check=False,
        )
        assert b"Traceback" not in run.stderr
        if command == "info":
            assert run.returncode == code, run.stderr


EMPTY = f"""{GEO}solid film = orthobrick (0, -2, -1; 10, 2, 1);
solid contact = sphere (2, 0, 0; 1) and not film;
tlo contact;
tlo film -maxh=2;
"""


def test_empty_regions_are_left_out(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "film.geo"
    path.write_text(EMPTY)
    geometry = Geometry(path)
    assert [(r.name, round(r.volume, 9)) for r in geometry.regions] == [("film", 80)]
    assert [region.name for region in geometry.model.regions] == ["film"]
    told = "region contact (empty: its Boolean expression leaves no interior)"
    code, text = said(["info", str(path)], capsys)
    assert code == 0
    assert f"line 4: {told}" in text
    code, text = said(["info", str(path), "--json"], capsys)
    assert json.loads(text)["ignored"] == [{"statement": told, "line": 4}]
    save(geometry.model, tmp_path / "kept.json")
    assert load(tmp_path / "kept.json").ignored == geometry.model.ignored


@pytest.mark.slow
def test_empty_regions_in_the_report_of_a_mesh(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path, mesh, report = (tmp_path / name for name in ("film.geo", "film.msh", "film.json"))
    path.write_text(EMPTY)
    code, text = said(["mesh", str(path), "-o", str(mesh), "--report", str(report)], capsys)
    assert code == 0
    assert "ignored: line 4: region contact (empty" in text
    assert json.loads(report.read_text())["ignored"][0]["line"] == 4
    assert said(["check", str(path), str(mesh)], capsys)[0] == 0


def test_all_regions_empty() -> None:
    nothing = Sphere((0, 0, 0), 1) & Sphere((5, 0, 0), 1)
    with pytest.raises(EmptyRegionError, match="region 'a' is empty"):
        Geometry({"a": nothing, "b": nothing})
    kept = Geometry({"a": nothing, "b": Sphere((0, 0, 0), 1)})
    assert [str(each) for each in kept.model.ignored] == [
        "region a (empty: its Boolean expression leaves no interior)"
    ]


def test_no_warning_of_numpy_reaches_the_user(tmp_path: Path) -> None:
    for name, corner in (("a.json", [1e49, 0, 0]), ("b.json", [0, 0, 1e308])):
        (tmp_path / name).write_text(native(corner=corner))
        run = subprocess.run(
            [sys.executable, "-m", "decomp", "info", str(tmp_path / name)],
            capture_output=True,
            text=True,
            check=False,
        )
        assert run.returncode == 2
        assert run.stderr.startswith("decomp: error: ")
        assert run.stderr.count("\n") == 1


def test_edges_are_not_followed_for_ever() -> None:
    """A cone almost as flat as a plane, whose edges at one vertex go on along one and the same."""
    text = """
difference() {
  multmatrix([[0, -1, 0, 10], [1, 0, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]) {
    cylinder(h = 4, r1 = 1e5, r2 = 6);
  }
  cube(size = [2, 30, 1], center = true);
}
intersection() { sphere(d = 5); cube([3, 3, 3]); }
rotate_extrude() { multmatrix([[1, 0, 0, 30], [0, 1, 0, 2], [0, 0, 1, 0]]) { circle(r = 4); } }
"""
    with within(60), suppress(GeometryError):
        Geometry(loads(text, "csg"))


@pytest.mark.slow
def test_fuzzing_finds_nothing() -> None:
    for sources, count in ((originals(None), 120), (meshes(), 60)):
        rows, failures = fuzz(range(count), 7, sources)
        assert not failures
        assert sum(row.cases for row in rows.values()) == count
        assert all(row.refused for row in rows.values())
    assert sum(row.read for row in rows.values())


def test_the_fuzzer_finds_what_is_wrong(monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(path: Path) -> Model:
        raise KeyError(path)

    monkeypatch.setattr("benchmarks.fuzz.load", broken)
    _, failures = fuzz(range(3), 7, {".geo": [GEO.encode()]})
    assert list(failures) == [0, 1, 2]
    assert all("KeyError" in wrong for wrong in failures.values())


def test_errors_are_short_lines() -> None:
    error = DecompError("\x1b\n" + "x" * 10_000 + "\ud800")
    assert str(error).isprintable()
    assert len(str(error)) < 1100
