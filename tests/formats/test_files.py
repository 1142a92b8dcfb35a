"""Files: which reader, which encoding, and errors that say what to do."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from decomp.csg.model import model
from decomp.csg.primitives import Sphere
from decomp.errors import FileError, InputError, ParseError
from decomp.formats import load, loads, save

GEO = "algebraic3d\nsolid ball = sphere (0, 0, 0; 1);\ntlo ball;\n"
CSG = "sphere(r = 1);\n"


def write(folder: Path, name: str, content: str | bytes) -> Path:
    path = folder / name
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    return path


@pytest.mark.parametrize(
    ("name", "content"),
    [
        ("ball.geo", GEO),
        ("ball.GEO", GEO),
        ("ball.csg", CSG),
        ("ball.txt", "# a comment\n" + GEO),
        ("ball", "// a comment\n" + CSG),
        ("ball.scad", "/* ( */ #" + CSG),
        ("ball.geo", b"\xef\xbb\xbf" + GEO.encode()),
        ("ball.csg", b"\xef\xbb\xbf" + CSG.encode()),
        ("ball.geo", GEO.replace("\n", "\r\n")),
        ("ball.geo", GEO.replace("\n", "\r")),
        ("ball.geo", b"# fl\xe4che\n" + GEO.encode()),
        ("ball", b"# fl\xe4che\n" + GEO.encode()),
    ],
)
def test_load(tmp_path: Path, name: str, content: str | bytes) -> None:
    found = load(write(tmp_path, name, content))
    assert found.name == "ball"
    (region,) = found.regions
    assert isinstance(region.solid, Sphere)


def test_save_and_load(tmp_path: Path) -> None:
    path = tmp_path / "x.json"
    path.write_text("old")
    save(model({"a": Sphere((0, 0, 0), 1)}, "ball"), str(path))
    assert load(path).name == "ball"
    save(load(path), tmp_path / "again.json")
    assert (tmp_path / "again.json").read_bytes() == path.read_bytes()
    assert sorted(p.name for p in tmp_path.iterdir()) == ["again.json", "x.json"]


def test_save_solids(tmp_path: Path) -> None:
    ball = Sphere((0, 0, 0), 1)
    save(ball, tmp_path / "one.json")
    save({"a": ball, "b": Sphere((3, 0, 0), 1)}, tmp_path / "two.json")
    assert [len(load(tmp_path / name).regions) for name in ("one.json", "two.json")] == [1, 2]


def test_save_replaces_nothing_when_it_fails(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = write(tmp_path, "x.json", "old")

    def fail(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(Path, "replace", fail)
    with pytest.raises(FileError, match=r"x\.json: cannot be written: No space left"):
        save(model(Sphere((0, 0, 0), 1)), path)
    assert [p.read_text() for p in tmp_path.iterdir()] == ["old"]


def test_save_to_a_wrong_place(tmp_path: Path) -> None:
    ball = model(Sphere((0, 0, 0), 1))
    (tmp_path / "folder.json").mkdir()
    with pytest.raises(FileError, match="this is a directory"):
        save(ball, tmp_path / "folder.json")
    with pytest.raises(FileError, match="cannot be written: its directory does not exist"):
        save(ball, tmp_path / "missing" / "x.json")
    with pytest.raises(InputError, match="bcname of solid 'a' must be a text"):
        Sphere((0, 0, 0), 1).named("a", bcname="\ud800")
    with pytest.raises(InputError, match="no form in UTF-8"):
        model(Sphere((0, 0, 0), 1), "\ud800")
    for name in ("x", "x.geo", "-"):
        with pytest.raises(InputError, match=r"as a suffix for models; use \.json"):
            save(ball, tmp_path / name)
    assert [path.name for path in tmp_path.iterdir()] == ["folder.json"]


def test_missing_file(tmp_path: Path) -> None:
    with pytest.raises(FileError, match=r"gone\.geo: no such file"):
        load(tmp_path / "gone.geo")
    with pytest.raises(FileError, match="no such file"):
        load(tmp_path / "gone" / "x.csg")


def test_names_that_no_file_has() -> None:
    with pytest.raises(FileError):
        load("x\0.geo")
    with pytest.raises(FileError):
        load("x" * 10_000 + ".geo")


def test_directory(tmp_path: Path) -> None:
    with pytest.raises(FileError, match="this is a directory"):
        load(tmp_path)


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no named pipes here")
def test_pipe(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe.geo")
    with pytest.raises(FileError, match="no regular file"):
        load(tmp_path / "pipe.geo")


def test_unreadable(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = write(tmp_path, "x.geo", GEO)

    def refuse(self: Path, mode: str) -> None:
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(Path, "open", refuse)
    with pytest.raises(FileError, match=r"x\.geo: cannot be read: Permission denied"):
        load(path)


@pytest.mark.parametrize("name", ["x.geo", "x.csg", "x.json", "x"])
@pytest.mark.parametrize("content", ["", " \n\t\n", "\ufeff"])
def test_empty(tmp_path: Path, name: str, content: str) -> None:
    with pytest.raises(ParseError, match="the file is empty; expected Netgen"):
        load(write(tmp_path, name, content))


@pytest.mark.parametrize("name", ["x.csg", "x.json", "x"])
def test_wrong_encoding(tmp_path: Path, name: str) -> None:
    path = write(tmp_path, name, b"cube(1);\n// \xc3\xa9 sf\xe6re\n")
    with pytest.raises(ParseError, match=f"{name}:2:8: byte 0xe6 is not UTF-8; save the file"):
        load(path)


def test_latin_1_outside_comments_is_no_name(tmp_path: Path) -> None:
    path = write(tmp_path, "x.geo", b"algebraic3d\nsolid fl\xe4che = sphere (0,0,0; 1);")
    with pytest.raises(ParseError, match="2:9: 'ä' does not belong here"):
        load(path)


@pytest.mark.parametrize("name", ["x.geo", "x.csg", "x.json", "x"])
@pytest.mark.parametrize("codec", ["utf-16", "utf-16-be"])
def test_utf_16(tmp_path: Path, name: str, codec: str) -> None:
    with pytest.raises(ParseError):
        load(write(tmp_path, name, GEO.encode(codec)))


def test_unknown_format(tmp_path: Path) -> None:
    with pytest.raises(ParseError, match="format is unknown; expected Netgen"):
        load(write(tmp_path, "x.stl", "solid cube\nfacet normal 0 0 1\n"))
    with pytest.raises(InputError, match="'stl' is no format for models; use geo, csg"):
        loads("", "stl")


def test_path_is_in_the_error(tmp_path: Path) -> None:
    path = write(tmp_path, "x.geo", "algebraic3d\ntlo a;\n")
    with pytest.raises(ParseError) as caught:
        load(path)
    assert str(caught.value).startswith(f"{path}:2:5: the solid 'a' is not defined: the file")
    assert caught.value.exit_code == 2


def test_nothing_heavy_is_imported_before_it_is_used() -> None:
    code = "import sys, decomp.formats; print('lark' in sys.modules, 'numpy' in sys.modules)"
    found = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert found.stdout.split() == ["False", "False"]
