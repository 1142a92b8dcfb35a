"""However a command ends, none of its processes stays, nor a directory after the next start."""

from __future__ import annotations

import os
import random
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Sequence
from pathlib import Path

import pytest

from tests.flow.ours import processes, survivors

pytestmark = pytest.mark.skipif(
    not Path("/proc/self/environ").exists(), reason="processes are found in /proc"
)

BOX = "algebraic3d\nsolid p = orthobrick (0,0,0; 1,1,{height});\ntlo p;\n"
ONE = ("a.geo", "-o", "a.msh")
TWO = ("a.geo", "b.geo", "-o", "out", "--jobs", "2")
KILLS = (signal.SIGKILL, signal.SIGTERM, signal.SIGHUP)
LONGEST = 3.0
"""Seconds after which a command is killed, at most."""
PATIENCE = 2.5
"""Seconds within which all has ended."""


@pytest.fixture
def place(tmp_path: Path) -> Path:
    (tmp_path / "a.geo").write_text(BOX.format(height=1))
    (tmp_path / "b.geo").write_text(BOX.format(height=2))
    (tmp_path / "tmp").mkdir()
    return tmp_path


def started(place: Path, words: Sequence[str]) -> subprocess.Popen[str]:
    """`decomp` with temporary files in a directory of its own."""
    return subprocess.Popen(
        [sys.executable, "-m", "decomp", *words],
        cwd=place,
        env={**os.environ, "TMPDIR": str(place / "tmp")},
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
    )


def in_tetwild(place: Path) -> list[Path]:
    """Wait until TetWild has a directory to work in."""
    for _ in range(600):
        if found := list((place / "tmp").glob("decomp-*/in.npz")):
            return found
        time.sleep(0.05)
    return []


def left(place: Path) -> list[str]:
    return [path.name for path in (place / "tmp").glob("decomp-*")]


def swept(place: Path) -> None:
    """Start a command that has nothing to do with TetWild."""
    process = started(place, ["convert", "a.geo", "a.json"])
    _, errors = process.communicate(timeout=30)
    assert (process.returncode, errors) == (0, "")


@pytest.mark.slow
@pytest.mark.parametrize("words", [ONE, TWO], ids=["one", "batch"])
def test_killed_at_any_moment(words: Sequence[str], place: Path) -> None:
    moments = random.Random(7)
    for turn in range(20):
        killed(place, words, KILLS[turn % len(KILLS)], moments.uniform(0, LONGEST))


@pytest.mark.slow
@pytest.mark.parametrize("words", [ONE, TWO], ids=["one", "batch"])
def test_killed_as_tetwild_starts(words: Sequence[str], place: Path) -> None:
    """Its process starts just after the directory is there, and loads for a while."""
    moments = random.Random(8)
    for turn in range(6):
        killed(place, words, KILLS[turn % len(KILLS)], moments.uniform(0, 0.3), in_tetwild)


def killed(
    place: Path,
    words: Sequence[str],
    how: signal.Signals,
    after: float,
    awaited: Callable[[Path], object] = lambda place: None,
) -> None:
    """Kill a command so many seconds after something; nothing may be left."""
    process = started(place, ["mesh", *words, "--size", "0.03"])
    awaited(place)
    time.sleep(after)
    assert process.poll() is None
    process.send_signal(how)
    assert survivors(place / "tmp", PATIENCE) == [], f"{how.name} after {after:.3f} s"
    _, errors = process.communicate(timeout=5)
    # before Python runs the command, the signal itself ends it
    assert process.returncode in (-how, 128 + how), errors
    assert not list(place.glob("**/*.msh"))
    swept(place)
    assert left(place) == []


@pytest.mark.parametrize("how", [signal.SIGTERM, signal.SIGHUP])
@pytest.mark.parametrize("words", [ONE, TWO], ids=["one", "batch"])
def test_signals_are_told_of(how: signal.Signals, words: Sequence[str], place: Path) -> None:
    process = started(place, ["mesh", *words, "--size", "0.03"])
    assert in_tetwild(place)
    process.send_signal(how)
    _, errors = process.communicate(timeout=5)
    assert process.returncode == 128 + how
    assert errors == f"decomp: ended by {how.name}\n"
    assert survivors(place / "tmp", PATIENCE) == []
    # the directory is removed by the command itself
    assert left(place) == []


def test_a_second_signal_ends_at_once(place: Path) -> None:
    """Be it that what was to be cleaned up hangs; what it leaves is swept."""
    program = """
import os, signal, sys
from decomp.cli.ending import endings
from decomp.processes.workplace import workplace
with endings(), workplace("tetwild"):
    try:
        os.kill(os.getpid(), signal.SIGTERM)
    finally:
        os.kill(os.getpid(), signal.SIGTERM)
"""
    environment = {**os.environ, "TMPDIR": str(place / "tmp")}
    process = subprocess.run([sys.executable, "-c", program], env=environment, timeout=20)
    assert process.returncode == -signal.SIGTERM
    assert len(left(place)) == 1
    swept(place)
    assert left(place) == []


@pytest.mark.parametrize(
    ("body", "code"),
    [
        ("gc.callbacks.append(lambda phase, info: kill()); gc.collect(); time.sleep(60)", 143),
        ("try: kill()\n    finally: time.sleep(60)", 143),
        ("try: kill()\n    finally:\n     try: time.sleep(60)\n     finally: time.sleep(60)", -14),
        ("try: kill()\n    except BaseException: raise ImportError", 143),
        ("os.kill(os.getpid(), signal.SIGINT)", 130),
        ("try: os.kill(os.getpid(), signal.SIGINT)\n    except BaseException: 1 / 0", 130),
    ],
    ids=["lost", "hangs", "hangs twice", "turned", "interrupt", "turned interrupt"],
)
def test_it_ends_whatever_becomes_of_the_error(body: str, code: int) -> None:
    program = f"""
import gc, os, signal, sys, time
import decomp.cli.ending as ending
ending.RAISED_AGAIN = ending.AT_LAST = 1
def kill():
    gc.callbacks.clear()
    os.kill(os.getpid(), signal.SIGTERM)
try:
  with ending.endings():
    {body}
except ending.EndedError as end:
    sys.exit(end.exit_code)
except KeyboardInterrupt:
    sys.exit(130)
"""
    process = subprocess.run([sys.executable, "-c", program], stderr=subprocess.DEVNULL, timeout=20)
    assert process.returncode == code


def test_nohup_is_respected(place: Path) -> None:
    program = """
import os, signal
from decomp.cli.ending import endings
signal.signal(signal.SIGHUP, signal.SIG_IGN)
with endings():
    os.kill(os.getpid(), signal.SIGHUP)
print("alive")
"""
    process = subprocess.run(
        [sys.executable, "-c", program], stdout=subprocess.PIPE, text=True, timeout=20
    )
    assert (process.returncode, process.stdout) == (0, "alive\n")


def test_a_living_owner_keeps_its_directory(place: Path) -> None:
    process = started(place, ["mesh", *ONE, "--size", "0.03"])
    try:
        used = in_tetwild(place)
        swept(place)
        assert used
        assert all(path.exists() for path in used)
        assert len(processes(place / "tmp")) >= 2
    finally:
        process.kill()
        process.communicate()


def test_what_is_not_ours_stays(place: Path) -> None:
    """Directories of other names, files, and links."""
    kept = place / "kept"
    kept.mkdir()
    (kept / "file").write_text("")
    tmp = place / "tmp"
    (tmp / "decomp-results").mkdir()
    (tmp / "decomp-tetwild-of-mine").mkdir()
    (tmp / "decomp-tetwild-abcdefgh").write_text("")
    (tmp / "decomp-tetwild-ijklmnop").symlink_to(kept)
    (tmp / "decomp-tetwild-qrstuvwx").mkdir()
    swept(place)
    assert sorted(left(place)) == [
        *("decomp-results", "decomp-tetwild-abcdefgh"),
        *("decomp-tetwild-ijklmnop", "decomp-tetwild-of-mine"),
    ]
    assert (kept / "file").exists()


def test_a_worker_that_is_killed_fails_its_model_only(place: Path) -> None:
    process = started(place, ["mesh", *TWO, "--size", "0.4", "--timeout", "60"])
    first = []
    for _ in range(600):
        first = [each for each in processes(place / "tmp") if _is_worker(each)]
        if first:
            break
        time.sleep(0.01)
    os.kill(first[0], signal.SIGKILL)
    _, errors = process.communicate(timeout=60)
    assert process.returncode == 1
    assert "ended with code -9" in errors
    assert errors.endswith("decomp: error: 1 of 2 models failed\n")
    assert len(list((place / "out").glob("*.msh"))) == 1


def _is_worker(process: int) -> bool:
    try:
        return b"decomp.cli.batch_worker" in Path(f"/proc/{process}/cmdline").read_bytes()
    except OSError:
        return False
