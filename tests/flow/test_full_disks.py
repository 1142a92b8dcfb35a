"""Disks that are full, wherever decomp writes: one line, no traceback, an exit code that tells."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from decomp.cli.main import main
from decomp.errors import FileError
from decomp.meshing.backends.tetwild.child import Settings, tetrahedralized
from tests.files.small_disk import small_disk

MODEL = str(Path(__file__).parent.parent.parent / "meshes" / "flange.geo")
FULL = Path("/dev/full")
NO_ROOM = "decomp: error: standard output: cannot be written: No space left on device\n"


def run(*words: str, unbuffered: bool = False) -> subprocess.CompletedProcess[str]:
    """Into a full stdout, which Python writes to at once or at last."""
    with FULL.open("w") as out:
        return subprocess.run(
            [sys.executable, "-m", "decomp", *words],
            env={**os.environ, "PYTHONUNBUFFERED": "1" if unbuffered else ""},
            stdout=out,
            stderr=subprocess.PIPE,
            text=True,
            check=False,
        )


@pytest.mark.skipif(not FULL.exists(), reason="no such device")
@pytest.mark.parametrize(
    "words", [["info", MODEL], ["info", MODEL, "--json"], ["--help"], ["mesh", "-h"], ["--version"]]
)
@pytest.mark.parametrize("unbuffered", [False, True], ids=["buffered", "unbuffered"])
def test_a_full_standard_output(unbuffered: bool, words: list[str]) -> None:
    done = run(*words, unbuffered=unbuffered)
    assert done.returncode == 2
    assert done.stderr == NO_ROOM


@pytest.mark.skipif(not FULL.exists(), reason="no such device")
def test_who_prints_nothing_needs_no_room(tmp_path: Path) -> None:
    done = run("convert", MODEL, str(tmp_path / "x.json"))
    assert (done.returncode, done.stderr) == (0, "")
    done = run("info", "none.geo")
    assert (done.returncode, done.stderr) == (2, "decomp: error: none.geo: no such file\n")


def test_a_reader_that_has_gone() -> None:
    """As `head` goes."""
    with subprocess.Popen(
        [sys.executable, "-m", "decomp", "info", MODEL, "--json"],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
    ) as process:
        assert process.stdout is not None
        assert process.stderr is not None
        process.stdout.close()
        assert process.stderr.read() == b""
    assert process.returncode == 0


def test_an_encoding_without_the_names_letters(tmp_path: Path) -> None:
    """They are escaped."""
    (tmp_path / "ü.csg").write_text("cube(1);")
    code = "import sys; from decomp.cli.main import main; sys.exit(main(['info', sys.argv[1]]))"
    done = subprocess.run(
        [sys.executable, "-c", code, str(tmp_path / "ü.csg")],
        env={"PYTHONIOENCODING": "ascii", "PYTHONPATH": ":".join(sys.path), "PYTHONUTF8": "0"},
        capture_output=True,
        text=True,
        check=False,
    )
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.startswith("model \\xfc: 1 region")


CORNERS = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=np.float64)
CUBE = np.array(
    [
        *([0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5]),
        *([0, 4, 5], [0, 5, 1], [2, 3, 7], [2, 7, 6]),
        *([0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]),
    ]
)


@pytest.mark.parametrize("ballast", [20, 16], ids=["input", "result"])
def test_no_room_for_temporary_files(
    ballast: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Neither for what TetWild is given nor for what it makes; it is not tried again."""
    with small_disk(tmp_path / "disk", 20) as disk:
        monkeypatch.setenv("TMPDIR", str(disk))
        (disk / "ballast").write_bytes(bytes(1024 * ballast))
        with pytest.raises(FileError, match=r"disk: TetWild's files .* space .* set TMPDIR to a"):
            tetrahedralized(CORNERS, CUBE, Settings(0.1, 0.01))
        assert [path.name for path in disk.iterdir()] == ["ballast"]


def test_no_directory_for_temporary_files(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("part.geo").write_text("algebraic3d\nsolid p = orthobrick (0,0,0; 1,1,1);\ntlo p;\n")
    monkeypatch.setenv("TMPDIR", str(tmp_path / "none"))
    assert main(["mesh", "part.geo", "--size", "0.6"]) == 2
    errors = capsys.readouterr().err
    assert "none: no temporary directory can be made here: No such file or directory; " in errors
    assert errors.count("\n") == 1
    assert [path.name for path in tmp_path.iterdir()] == ["part.geo"]
