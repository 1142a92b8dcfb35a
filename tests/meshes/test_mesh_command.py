"""`decomp mesh` from model file to mesh file, nothing faked, and stopped at every stage."""

from __future__ import annotations

import json
import os
import resource
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

import decomp.cli.stages
from decomp.checking.check import check
from decomp.cli.main import INTERRUPTED, main
from decomp.errors import FileError
from decomp.meshes.files.msh_reader import read_msh
from tests.meshes.opened import named_sizes, opened
from tests.meshes.shapes import bar

MODEL = """algebraic3d
solid box = orthobrick (0,0,0; 2,1,1);
solid left = plane (1,0,0; 1,0,0);
solid a = box and left -bc=4;
solid b = box and not left;
tlo a -maxh=0.5;
tlo b;
"""


@pytest.fixture
def model(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    path = tmp_path / "two.geo"
    path.write_text(MODEL)
    return path


def test_mesh(model: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["mesh", "two.geo", "--size", "0.4", "--report", "two.json"]) == 0
    text = capsys.readouterr().out
    figures = json.loads((tmp_path / "two.json").read_text())
    assert text.startswith(f"model two: {figures['tets']} tetrahedra of order 1, ")
    assert text.endswith("  written: two.msh\n")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["two.geo", "two.json", "two.msh"]
    assert [region["name"] for region in figures["regions"]] == ["a", "b"]
    assert [region["exact"] for region in figures["regions"]] == pytest.approx([1.0, 1.0])
    assert [region["maxh"] for region in figures["regions"]] == [0.5, None]
    assert sum(cell["tets"] for cell in figures["cells"]) == figures["tets"]
    assert figures["quality"]["inverted"] == 0
    assert {"reading", "tracing", "TetWild"} <= {each["stage"] for each in figures["stages"]}
    numbers = {surface["name"]: surface["bc"] for surface in figures["surfaces"]}
    assert numbers["a/box.xmin"] == 4
    assert numbers["b/box.xmax"] is None
    assert check(model, "two.msh").shortcomings == ()
    with opened(tmp_path / "two.msh") as gmsh:
        sizes = named_sizes(gmsh)
    assert sizes == {
        (each["dimension"], each["name"]): each["elements"] for each in figures["groups"]
    }
    assert {(d, name) for d, name in sizes if d == 3} == {(3, "a"), (3, "b")}
    assert not any(name.count("/") == 1 and "|" in name for _, name in sizes)
    assert "  groups: 2 volumes, 10 faces, 1 interface\n" in text


def test_all_formats(model: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    files = [f"out/two{suffix}" for suffix in (".msh", ".vtu", ".xdmf", ".inp", ".mesh", ".png")]
    (tmp_path / "out").mkdir()
    arguments = ["mesh", str(model), "--quiet", "--msh2"]
    assert main([*arguments, *(word for name in files for word in ("-o", name))]) == 0
    assert capsys.readouterr().out == ""
    assert sorted(f"out/{path.name}" for path in (tmp_path / "out").iterdir()) == sorted(files)
    read = read_msh("out/two.msh")
    assert Path("out/two.msh").read_text().startswith("$MeshFormat\n2.2 0 8\n")
    assert {name for (d, _), name in read.names.items() if d == 3} == {"a", "b"}
    assert not any("|" in name and name.count("/") == 1 for name in read.names.values())


@pytest.mark.parametrize(
    ("arguments", "code", "message"),
    [
        (["none.geo"], 2, "none.geo"),
        (["two.geo", "-o", "two.stl"], 2, "'.stl' is unknown as a suffix for meshes"),
        (["two.geo", "-o", "none/two.msh"], 2, "its directory does not exist"),
        (["two.geo", "--report", "none/two.json"], 2, "its directory does not exist"),
        (["two.geo", "--size", "-1"], 2, "argument --size: must be above 0, not -1"),
        (["two.geo", "--layers", "1.5"], 2, "argument --layers: '1.5' is no whole number"),
        (["two.geo", "--ascii", "--msh2"], 2, "not allowed with argument"),
    ],
)
def test_what_cannot_be(
    arguments: list[str],
    code: int,
    message: str,
    model: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    try:
        found = main(["mesh", *arguments])
    except SystemExit as end:
        found = int(str(end.code))
    assert found == code
    assert message in capsys.readouterr().err
    assert [path.name for path in model.parent.iterdir()] == ["two.geo"]


def test_help(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        main(["mesh", "--help"])
    text = capsys.readouterr().out
    for part in ("examples:", "--layers N", "--report FILE.json", "(default: 600"):
        assert part in text


@pytest.mark.parametrize("stage", ["reading", "boundary", "tracing", "TetWild", "naming"])
def test_interrupted_at_a_stage(
    stage: str,
    model: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    """The signal comes when the stage begins; `signal.raise_signal` acts at once."""
    told = decomp.cli.stages.Stages.__call__

    def struck(self: decomp.cli.stages.Stages, what: str, done: float) -> None:
        told(self, what, done)
        if what.startswith(stage):
            signal.raise_signal(signal.SIGINT)

    monkeypatch.setattr(decomp.cli.stages.Stages, "__call__", struck)
    assert main(["mesh", "two.geo"]) == INTERRUPTED
    assert capsys.readouterr().err == "decomp: interrupted\n"
    assert [path.name for path in model.parent.iterdir()] == ["two.geo"]


@pytest.mark.skipif(not Path("/proc").is_dir(), reason="children are found in /proc")
@pytest.mark.parametrize("group", [False, True], ids=["kill", "ctrl-c"])
def test_interrupted_while_tetwild_runs(group: bool, model: Path) -> None:
    """Whether the signal goes to the process alone or, as a terminal's does, to its group."""
    process = subprocess.Popen(
        [sys.executable, "-m", "decomp.cli.main", "mesh", "two.geo", "--size", "0.05"],
        cwd=model.parent,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )
    try:
        child = next(_children(process.pid, 60.0))
        time.sleep(0.5)
        start = time.monotonic()
        if group:
            os.killpg(process.pid, signal.SIGINT)
        else:
            process.send_signal(signal.SIGINT)
        _, errors = process.communicate(timeout=20)
        assert time.monotonic() - start < 5
    finally:
        process.kill()
    assert process.returncode == INTERRUPTED
    assert errors == "decomp: interrupted\n"
    assert not Path(f"/proc/{child}").exists()
    assert [path.name for path in model.parent.iterdir()] == ["two.geo"]


def _children(parent: int, patience: float) -> Iterator[int]:
    """Processes that a process has started."""
    end = time.monotonic() + patience
    while time.monotonic() < end:
        for entry in Path("/proc").glob("[0-9]*/stat"):
            try:
                words = entry.read_text().rpartition(")")[2].split()
            except OSError:
                continue
            if int(words[1]) == parent:
                yield int(entry.parent.name)
        time.sleep(0.05)
    raise AssertionError("no child was started")


WORKERS = {
    "hangs": ("import time; time.sleep(60)", "did not end within 0.5 s"),
    "is killed": ("import os; os.kill(os.getpid(), 9)", "was ended by SIGKILL"),
    "gives nothing": ("", "ended without a result"),
    "fails": ("raise ValueError('no')", "failed with exit code 1: ValueError: no"),
}


@pytest.mark.parametrize("fault", WORKERS)
def test_tetwild_fails_twice(
    fault: str,
    model: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    """The message tells both failures, and with which settings; nothing is left behind."""
    text, message = WORKERS[fault]
    (model.parent / "two").mkdir()
    worker = model.parent / "two" / "worker.py"
    worker.write_text(text)
    monkeypatch.setattr("decomp.meshing.backends.tetwild.child.WORKER", worker)
    assert main(["mesh", "two.geo", "--timeout", "0.5"]) == 4
    errors = capsys.readouterr().err
    assert errors.count("\n") == 1
    assert errors.startswith("decomp: error: ")
    assert errors.count(message) == 2
    assert errors.count("epsilon") == 2
    assert sorted(path.name for path in model.parent.iterdir()) == ["two", "two.geo"]


def test_tetwild_fails_once(
    model: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """A second try with other settings succeeds, and is told of."""
    from decomp.meshing.backends.tetwild.child import WORKER

    (model.parent / "two").mkdir()
    worker = model.parent / "two" / "worker.py"
    worker.write_text(
        "import pathlib, runpy, sys\n"
        "mark = pathlib.Path(__file__).with_name('mark')\n"
        "if not mark.exists():\n"
        "    mark.touch()\n"
        "    sys.exit(7)\n"
        f"runpy.run_path({str(WORKER)!r}, run_name='__main__')\n"
    )
    monkeypatch.setattr("decomp.meshing.backends.tetwild.child.WORKER", worker)
    assert main(["mesh", "two.geo", "--size", "0.5"]) == 0
    assert "failed with exit code 7" in capsys.readouterr().out
    assert check(model, "two.msh").shortcomings == ()


def test_a_full_disk(tmp_path: Path) -> None:
    """A limit on the size of files fails a write half-way, as a full disk does."""
    path = tmp_path / "bar.msh"
    path.write_text("old")
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (1000, limits[1]))
    try:
        with pytest.raises(FileError, match=r"bar\.msh: cannot be written: File too large"):
            bar().write(path)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
    assert [each.name for each in tmp_path.iterdir()] == ["bar.msh"]
    assert path.read_text() == "old"


def test_layout_of_the_mesh(model: Path) -> None:
    """What the contract says of a mesh (`decomp.meshes.model`) holds for a real one."""
    from decomp.ways.mesh import mesh

    made = mesh(model, size=0.4)
    assert np.array_equal(np.unique(made.tets), np.arange(len(made.points)))
    for dimension, tags in ((3, made.tet_tags), (2, made.triangle_tags)):
        own = [group.tag for group in made.groups if group.dimension == dimension]
        assert len(set(own)) == len(own)
        assert set(np.unique(tags)) <= set(own)
        names = [group.name for group in made.groups if group.dimension == dimension]
        assert len(set(names)) == len(names)
