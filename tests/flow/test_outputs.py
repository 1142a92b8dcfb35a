"""No command harms what it finds: no output is an input, and what cannot be is told first."""

from __future__ import annotations

import json
import os
import re
from pathlib import Path
from typing import Any

import pytest

import decomp
import decomp.geometry
from decomp.cli.main import main
from decomp.errors import FileError, InputError
from tests.meshes.shapes import bar
from tests.skeleton_fixtures import block

TEXT = "algebraic3d\nsolid p = orthobrick (0,0,0; 1,1,1);\ntlo p;\n"
COPIES = ("index.json", "part.msh", "part.stl", "other.geo")
"""Models whose names do not tell what they are: their first words do."""


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Models under many names; nothing is computed."""
    monkeypatch.chdir(tmp_path)
    Path("part.geo").write_text(TEXT)
    for name in COPIES:
        Path(name).write_text(TEXT)
    for suffix in ("json", "html", "vtu", "msh", "obj"):
        Path(f"soft.{suffix}").symlink_to("part.geo")
        os.link("part.geo", f"hard.{suffix}")
    Path("closed.json").write_text("{}")
    Path("closed.json").chmod(0o444)
    (tmp_path / "empty").mkdir()

    def computed(*_: Any, **__: Any) -> Any:
        pytest.fail("something is read or computed")

    for name in ("decomp.formats.load", "decomp.view.reading.scene_of"):
        monkeypatch.setattr(name, computed)
    return tmp_path


def contents(folder: Path) -> dict[str, tuple[int, bytes]]:
    return {
        path.name: (path.stat().st_mode, path.read_bytes())
        for path in folder.iterdir()
        if path.is_file()
    }


LOST, TWICE, CLOSED = "this file is read", "two outputs would be", "it is read-only"
REFUSED = [
    ("convert part.geo part.geo", r"'\.geo' is unknown as a suffix for models; use \.json"),
    ("convert part.geo geo:-", r"'\.geo' is unknown as a suffix for models; use \.json"),
    ("convert part.geo new", "there is none as a suffix"),
    ("convert index.json index.json", LOST),
    ("convert index.json ./empty/../index.json", LOST),
    ("convert part.geo soft.json", f"soft.json: {LOST} as part.geo"),
    ("convert part.geo hard.json", f"hard.json: {LOST} as part.geo"),
    ("convert soft.json hard.json", LOST),
    ("convert part.geo closed.json", CLOSED),
    ("mesh part.geo --report part.geo", r"unknown as a suffix for reports; use \.json"),
    ("mesh part.geo --report new.txt", r"use \.json"),
    ("mesh part.geo --html part.geo", r"unknown as a suffix for pages; use \.html"),
    ("mesh part.geo --html new.json", r"use \.html"),
    ("mesh part.geo --report hard.json", LOST),
    ("mesh part.geo --report closed.json", CLOSED),
    ("mesh part.geo --html soft.html", LOST),
    ("mesh part.geo -o new.vtu -o hard.msh", LOST),
    ("mesh other.geo -o new.msh -o ./new.msh", TWICE),
    ("mesh other.geo -o soft.msh -o hard.msh", TWICE),
    ("mesh other.geo --report soft.json --html hard.html", TWICE),
    ("skeleton index.json -o index.json", LOST),
    ("skeleton part.geo -o new.ply -o hard.vtu", LOST),
    ("skeleton part.geo --facing 120 -o soft.vtu", LOST),
    ("skeleton other.geo -o hard.vtu -o soft.obj", TWICE),
    ("skeleton other.geo -o closed.json", CLOSED),
    ("cells index.json -o .", LOST),
    ("cells part.stl -o .", "a cell could be written over it"),
    ("cells part.geo -o . --format obj", "a cell could be written over it"),
    ("view part.geo -o soft.html", LOST),
    ("view part.msh -o part.msh", r"use \.html, \.png"),
    ("view hard.msh -o hard.html", LOST),
    ("view other.geo -o soft.html -o hard.html", TWICE),
    ("mesh part.msh other.geo", LOST),
    ("mesh part.msh other.geo -o empty/..", LOST),
    ("mesh other.geo part.msh -o empty --format vtu -o x", "give -o once"),
    ("mesh soft.geo hard.geo other.geo", LOST),
]


@pytest.mark.parametrize(("words", "message"), REFUSED, ids=[words for words, _ in REFUSED])
def test_what_would_be_lost_is_kept(
    words: str, message: str, folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    if "soft.geo" in words:  # part.geo's mesh would be its own link
        Path("soft.geo").symlink_to("part.geo")
        os.link("part.geo", "hard.geo")
    before = contents(folder)
    assert main(["--", *words.split()] if words.startswith("-") else words.split()) == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err.startswith("decomp: error: ")
    assert captured.err.count("\n") == 1
    assert re.search(message, captured.err), captured.err
    assert contents(folder) == before
    assert not list((folder / "empty").iterdir())


def test_the_default_output_may_be_the_model(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Which is refused; a mesh in the place of a model is told to be one."""
    monkeypatch.chdir(tmp_path)
    for text, message in ((TEXT, LOST), ("$MeshFormat\n", "This is a mesh, not a model")):
        Path("part.msh").write_text(text)
        assert main(["mesh", "part.msh"]) == 2
        assert message in capsys.readouterr().err
        assert Path("part.msh").read_text() == text


def test_a_batch_of_links_to_one_place(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    Path("other.msh").write_text("old")
    os.link("other.msh", "empty/index.msh")
    Path("empty/other.msh").symlink_to("../other.msh")
    assert main(["mesh", "index.json", "other.geo", "-o", "empty"]) == 2
    assert "empty/other.msh: two outputs would be written" in capsys.readouterr().err
    assert Path("other.msh").read_text() == "old"


def test_models_remember_their_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """By its place, wherever the program goes afterwards."""
    monkeypatch.chdir(tmp_path)
    Path("part.geo").write_text(TEXT)
    decomp.save(decomp.load("part.geo"), "part.json")
    before = Path("part.json").read_bytes()
    os.link("part.json", "hard.json")
    model = decomp.load("part.json")
    monkeypatch.chdir("/")
    assert model.source == tmp_path / "part.json"
    for name in ("part.json", "hard.json"):
        with pytest.raises(FileError, match=LOST):
            decomp.save(model, tmp_path / name)
    assert (tmp_path / "part.json").read_bytes() == before
    decomp.save(model, tmp_path / "new.json")
    decomp.save(model.regions[0].solid, tmp_path / "part.json")
    assert decomp.model(model.regions[0].solid).source is None


def test_what_is_made_of_models_remembers_it_too(tmp_path: Path) -> None:
    path = tmp_path / "part.geo"
    path.write_text(TEXT)
    geometry = decomp.Geometry(path)
    skeleton = decomp.skeleton(geometry)
    surface = decomp.mid_surface(skeleton)
    mesh = decomp.mesh(geometry, size=0.5)
    assert {each.source for each in (skeleton, surface, mesh)} == {path}
    for suffix in (".vtu", ".msh", ".png"):
        os.link(path, path.with_suffix(suffix))
    from decomp.skeletons.files import write

    for refused in (
        lambda: write(skeleton, path.with_suffix(".vtu")),
        lambda: surface.write(path.with_suffix(".vtu")),
        lambda: mesh.write(path.with_suffix(".msh")),
        lambda: mesh.write(path.with_suffix(".png")),
    ):
        with pytest.raises(FileError, match=LOST):
            refused()
    assert path.read_text() == TEXT
    mesh.write(tmp_path / "new.msh")


def test_cells_are_written_all_or_none(tmp_path: Path) -> None:
    """One that is the model's file, or read-only, is told before the first is written."""
    from dataclasses import replace

    from decomp.skeletons.files.cells import write_cells

    names = [path.name for path in write_cells(block().skeleton, tmp_path / "first")]
    model = tmp_path / "model.geo"
    model.write_text(TEXT)
    skeleton = replace(block().skeleton, source=model)
    for number, name in enumerate((names[3], "index.json")):
        folder = tmp_path / str(number)
        folder.mkdir()
        (folder / name).symlink_to(model)
        with pytest.raises(FileError, match=LOST):
            write_cells(skeleton, folder)
        (folder / name).unlink()
        (folder / name).write_text("old")
        (folder / name).chmod(0o444)
        with pytest.raises(FileError, match=CLOSED):
            write_cells(skeleton, folder)
        assert [path.name for path in folder.iterdir()] == [name]
    assert model.read_text() == TEXT


def test_one_format_needs_no_suffix_on_a_device(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("part.geo").write_text(TEXT)
    assert main(["convert", "part.geo", "/dev/stdout"]) == 0
    assert json.loads(capfd.readouterr().out)["format"] == "decomp"
    bar().write("/dev/stdout", text=True)
    assert capfd.readouterr().out.startswith("$MeshFormat\n4.1 0 8\n")
    with pytest.raises(InputError, match="there is none as a suffix for meshes"):
        bar().write("new")
