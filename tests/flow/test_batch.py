"""`decomp mesh` of several models: a failure stops no other, and the exit code tells of it."""

from __future__ import annotations

import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from decomp.checking.check import check
from decomp.cli.main import INTERRUPTED, main

BOX = "algebraic3d\nsolid p = orthobrick (0,0,0; 1,1,{height});\ntlo p;\n"
BAD = "algebraic3d\nsolid p = ellipsoid (0,0,0; 1,0,0; 0,1,0; 0,0,2);\ntlo p;\n"


@pytest.fixture
def models(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "a.geo").write_text(BOX.format(height=1))
    (tmp_path / "bad.geo").write_text(BAD)
    (tmp_path / "c.geo").write_text(BOX.format(height=2))
    return tmp_path


def test_one_failure_of_three(models: Path, capsys: pytest.CaptureFixture[str]) -> None:
    names = ["a.geo", "bad.geo", "c.geo"]
    assert main(["mesh", *names, "-o", "out", "--jobs", "2", "--size", "0.4"]) == 1
    captured = capsys.readouterr()
    rows = [line.split() for line in captured.out.splitlines()]
    assert [row[0] for row in rows] == ["model", *names]
    assert rows[2][1] == "failed"
    assert int(rows[1][1]) > 50
    assert "decomp: bad.geo:2:" in captured.err
    assert "ellipsoid" in captured.err
    assert captured.err.endswith("decomp: error: 1 of 3 models failed\n")
    assert sorted(path.name for path in (models / "out").iterdir()) == ["a.msh", "c.msh"]
    for name in ("a", "c"):
        assert check(models / f"{name}.geo", models / "out" / f"{name}.msh").shortcomings == ()


def test_one_model_into_a_directory(models: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (models / "out").mkdir()
    words = ["a.geo", "-o", "out", "--format", "vtu", "--size", "0.5", "--quiet"]
    assert main(["mesh", *words]) == 0
    assert capsys.readouterr().out == ""
    assert [path.name for path in (models / "out").iterdir()] == ["a.vtu"]


@pytest.mark.parametrize("words", [["--jobs", "2"], ["--format", "vtu"]])
def test_a_pattern_may_name_one_model(words: list[str], models: Path) -> None:
    """Options of batches make one: the directory need not be there yet."""
    assert main(["mesh", "a.geo", "-o", "new", "--size", "0.4", "--quiet", *words]) == 0
    (file,) = (models / "new").iterdir()
    assert file.name == f"a.{words[1] if words[0] == '--format' else 'msh'}"


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["a.geo", "c.geo", "-o", "x", "-o", "y"], "give -o once"),
        (["a.geo", "./a.geo", "-o", "x"], "would both be written to x/a.msh"),
        (["a.geo", "c.geo", "-o", "bad.geo"], "are written into a directory, and this is none"),
        (["a.geo", "c.geo", "--report", "r.json"], "--report is for one model"),
        (["a.geo", "c.geo", "--jobs", "0"], "must be 1 or more"),
    ],
)
def test_what_cannot_be(
    words: list[str], message: str, models: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    try:
        code = main(["mesh", *words])
    except SystemExit as end:
        code = int(str(end.code))
    assert code == 2
    assert message in capsys.readouterr().err
    assert not list(models.glob("**/*.msh"))


@pytest.mark.skipif(not Path("/proc").is_dir(), reason="children are found in /proc")
def test_an_interrupt_stops_all(models: Path) -> None:
    words = ["a.geo", "c.geo", "-o", "out", "--jobs", "2", "--size", "0.02"]
    process = subprocess.Popen(
        [sys.executable, "-m", "decomp", "mesh", *words],
        cwd=models,
        stderr=subprocess.PIPE,
        text=True,
    )
    try:
        workers = _awaited_children(process, 2)
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate(timeout=20)
    finally:
        process.kill()
    assert process.returncode == INTERRUPTED
    assert errors == "decomp: interrupted\n"
    assert not list((models / "out").iterdir())
    assert len(workers) == 2
    assert not any(Path(f"/proc/{worker}").exists() for worker in workers)


def _awaited_children(process: subprocess.Popen[str], count: int) -> list[int]:
    """The processes that a process has started, as soon as there are so many."""
    for _ in range(600):
        found = _children(process.pid)
        if len(found) == count or process.poll() is not None:
            return found
        time.sleep(0.1)
    return found


def _children(parent: int) -> list[int]:
    """Processes that a process has started."""
    found = []
    for entry in Path("/proc").glob("[0-9]*/stat"):
        try:
            words = entry.read_text().rpartition(")")[2].split()
        except OSError:
            continue
        if int(words[1]) == parent:
            found.append(int(entry.parent.name))
    return found
