"""fTetWild in its child process: what it is given, and what becomes of it when it fails."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import textwrap
import time
from pathlib import Path

import numpy as np
import pytest

from decomp.errors import DecompError, GeometryError, InputError
from decomp.meshes.faces import faces_of, volumes
from decomp.meshing.backends.base import MeshingError, TimeLimit
from decomp.meshing.backends.tetwild import child
from decomp.meshing.backends.tetwild.child import Settings, tetrahedralized
from decomp.meshing.sizing.size_field import SizeField

CORNERS = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=np.float64)
CUBE = np.array(
    [
        *([0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5]),
        *([0, 4, 5], [0, 5, 1], [2, 3, 7], [2, 7, 6]),
        *([0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]),
    ]
)
COARSE = Settings(edge_length=0.4, epsilon=0.01)


def fake(monkeypatch: pytest.MonkeyPatch, directory: Path, body: str) -> Path:
    """Put a script in the worker's place; it notes its process and directory, then runs `body`."""
    script, log = directory / "fake.py", directory / "log"
    script.write_text(
        "import os, pathlib, sys, time\n"
        "import numpy as np\n"
        f"log = open({str(log)!r}, 'a')\n"
        "print(os.getpid(), os.getcwd(), file=log, flush=True)\n" + textwrap.dedent(body)
    )
    monkeypatch.setattr(child, "WORKER", script)
    return log


def processes(log: Path) -> list[int]:
    return [int(line.split()[0]) for line in log.read_text().splitlines()]


def running(process: int) -> bool:
    """Whether a process runs: not ended, and not waiting to be buried."""
    try:
        state = Path(f"/proc/{process}/stat").read_text().rsplit(")", 1)[1].split()[0]
    except OSError:
        return False
    return state not in "ZX"


def gone(process: int) -> bool:
    for _ in range(100):
        if not running(process):
            return True
        time.sleep(0.05)
    return False


def test_a_cube_is_filled() -> None:
    made = tetrahedralized(CORNERS, CUBE, COARSE)
    assert (volumes(made.points, made.tets) > 0).all()
    middle = made.points[made.tets].mean(axis=1)
    inside = ((middle > 0) & (middle < 1)).all(axis=1)
    assert inside.any()
    assert not inside.all()
    assert volumes(made.points, made.tets[inside]).sum() == pytest.approx(1, abs=0.02)
    assert (faces_of(made.tets[inside]).tets[:, 1] == -1).any()
    assert made.notes == ()


@pytest.mark.parametrize(("scale", "offset"), [(1e-9, 0.0), (1.0, 1e9), (1e6, -1e8)])
def test_any_place_and_scale(scale: float, offset: float) -> None:
    settings = Settings(0.4 * scale, 0.01 * scale)
    made = tetrahedralized(scale * CORNERS + offset, CUBE, settings, limit=TimeLimit(60))
    assert np.ptp(made.points, axis=0).min() > 0.98 * scale
    assert abs(made.points.mean(axis=0) - offset).max() < scale


def test_a_size_field_is_followed() -> None:
    ends = np.array([[-1, -1, -0.05], [10, -1, -0.05], [-1, 10, -0.05], [-1, -1, 2]])
    field = SizeField(ends, np.array([[0, 1, 2, 3]]), np.array([0.05, 0.05, 0.05, 0.45]))
    made = tetrahedralized(CORNERS, CUBE, COARSE, field)
    corners = made.points[made.tets]
    middle = corners.mean(axis=1)
    inside = ((middle > 0) & (middle < 1)).all(axis=1)
    length = np.linalg.norm(corners[:, 1] - corners[:, 0], axis=1)
    low, high = inside & (middle[:, 2] < 0.2), inside & (middle[:, 2] > 0.8)
    assert np.median(length[low]) < 0.12
    assert np.median(length[high]) > 1.3 * np.median(length[low])


def test_interfaces_inside_are_kept() -> None:
    """With TetWild's filter a sheet inside upsets the winding number and most of it is lost."""
    corners = np.array([[0.5, y, z] for y in (0, 1) for z in (0, 1)])
    points = np.concatenate([CORNERS, corners])
    wall = np.array([[8, 9, 11], [8, 11, 10]])
    made = tetrahedralized(points, np.concatenate([CUBE, wall]), COARSE)
    x = made.points[made.tets][:, :, 0]
    inside = ((made.points[made.tets] > -0.02) & (made.points[made.tets] < 1.02)).all(axis=(1, 2))
    across = (x.min(axis=1) < 0.5 - 0.02) & (x.max(axis=1) > 0.5 + 0.02)
    assert not (across & inside).any()


@pytest.mark.parametrize(
    ("points", "triangles", "settings", "said"),
    [
        (CORNERS, CUBE[:0], COARSE, "no triangles"),
        (np.full((8, 3), np.nan), CUBE, COARSE, "not finite"),
        (CORNERS, CUBE + 1, COARSE, "does not exist"),
        (np.ones((8, 3)), CUBE, COARSE, "equal"),
        (CORNERS, CUBE, Settings(0.4, 0.0), "epsilon"),
        (CORNERS, CUBE, Settings(0.4, 1e-7), "epsilon"),
        (CORNERS, CUBE, Settings(0.4, 0.1), "edge length"),
        (CORNERS, CUBE, Settings(2.0, 0.01), "edge length"),
        (CORNERS, CUBE, Settings(0.4, 0.01, stop_energy=3.0), "stop energy"),
        (CORNERS, CUBE, Settings(0.4, 0.01, stop_energy=50.0), "stop energy"),
        (CORNERS, CUBE, Settings(0.4, 0.01, threads=-1), "thread"),
    ],
)
def test_what_crashes_or_hangs_it_is_refused(
    points: np.ndarray, triangles: np.ndarray, settings: Settings, said: str
) -> None:
    with pytest.raises((InputError, GeometryError), match=said):
        tetrahedralized(points, triangles, settings)


@pytest.mark.parametrize(
    ("body", "said"),
    [
        ("os.kill(os.getpid(), 11)", "SIGSEGV"),
        ("sys.exit(0)", "without a result"),
        ("sys.exit(7)", "exit code 7"),
        ("raise RuntimeError('no such luck')", "no such luck"),
        ("pathlib.Path(sys.argv[2]).write_bytes(b'PK half a file')", "without a result"),
        ("np.savez(sys.argv[2], points=np.ones((4, 3)), tets=np.empty((0, 4), int))", "empty"),
        ("np.savez(sys.argv[2], points=np.ones((4, 3)), tets=np.full((1, 4), 9))", "broken"),
        ("np.savez(sys.argv[2], points=np.full((4, 3), np.nan), tets=[[0, 1, 2, 3]])", "broken"),
    ],
)
def test_failures_are_tried_again_and_told(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, body: str, said: str
) -> None:
    log = fake(monkeypatch, tmp_path, body)
    told: list[str] = []
    with pytest.raises(MeshingError, match=said) as caught:
        tetrahedralized(CORNERS, CUBE, COARSE, tell=told.append)
    assert len(processes(log)) == 2
    assert "stop energy 10" in str(caught.value)
    assert "stop energy 20" in str(caught.value)
    assert isinstance(caught.value, DecompError)
    assert len(told) == 2


def test_a_second_try_that_works_is_noted(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    fake(
        monkeypatch,
        tmp_path,
        """
        if np.load(sys.argv[1])["stop_energy"] < 15:
            sys.exit(1)
        np.savez(sys.argv[2], points=np.eye(4, 3), tets=[[0, 1, 3, 2]])
        """,
    )
    made = tetrahedralized(CORNERS, CUBE, COARSE)
    assert made.settings.stop_energy == 20
    assert len(made.notes) == 1
    assert "exit code 1" in made.notes[0]


def test_a_hanging_child_is_killed_with_its_children(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    log = fake(
        monkeypatch,
        tmp_path,
        """
        if os.fork() == 0:
            print(os.getpid(), "grandchild", file=log, flush=True)
        time.sleep(60)
        """,
    )
    start = time.monotonic()
    with pytest.raises(MeshingError, match="did not end within 2 s"):
        tetrahedralized(CORNERS, CUBE, COARSE, limit=TimeLimit(2))
    assert time.monotonic() - start < 20
    assert len(processes(log)) == 4
    assert all(gone(process) for process in processes(log))


@pytest.mark.skipif(sys.platform == "win32", reason="no limit of computing there")
def test_too_much_work_is_ended() -> None:
    """By the seconds that it computes: on a busy machine the clock says little."""
    fine = Settings(edge_length=0.012, epsilon=0.002)
    with pytest.raises(MeshingError, match=r"within 1 s of computing .*within 1 s of computing"):
        tetrahedralized(CORNERS, CUBE, fine, limit=TimeLimit(clock=100, busy=1))


def test_every_child_has_a_directory_of_its_own_that_is_removed(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    log = fake(monkeypatch, tmp_path, "open('__tracked_surface.stl', 'w').close(); sys.exit(1)")
    with pytest.raises(MeshingError):
        tetrahedralized(CORNERS, CUBE, COARSE)
    directories = {line.split()[1] for line in log.read_text().splitlines()}
    assert len(directories) == 2
    assert str(Path.cwd()) not in directories
    assert not any(Path(name).exists() for name in directories)


@pytest.mark.parametrize("how", [signal.SIGINT, signal.SIGKILL])
def test_no_orphan_is_left(tmp_path: Path, how: signal.Signals) -> None:
    """Neither on Ctrl-C nor when the parent is killed; fTetWild holds the lock while it runs."""
    if sys.platform != "linux" and how is signal.SIGKILL:
        pytest.skip("only Linux ends children with their parent")
    log = tmp_path / "log"
    program = f"""
import subprocess, sys
import decomp.meshing.backends.tetwild.child as child
from tests.meshing.test_child import CORNERS, CUBE, Settings, TimeLimit
old = subprocess.Popen
def noted(*args, **options):
    made = old(*args, **options)
    print(made.pid, file=open({str(log)!r}, "a"), flush=True)
    return made
child.subprocess.Popen = noted
child.tetrahedralized(CORNERS, CUBE, Settings(0.01, 0.0016), limit=TimeLimit(100))
"""
    parent = subprocess.Popen([sys.executable, "-c", program], stderr=subprocess.PIPE)
    for _ in range(400):
        if log.exists() and log.read_text().strip():
            break
        time.sleep(0.05)
    time.sleep(0.5)
    inner = processes(log)[0]
    assert running(inner)
    os.kill(parent.pid, how)
    parent.communicate(timeout=20)
    assert gone(inner)
    assert parent.returncode != 0


def test_a_batch_systems_limit_of_computing_is_kept(tmp_path: Path) -> None:
    """The child's own limit would be higher, which the system refuses."""
    program = f"""
import resource
resource.setrlimit(resource.RLIMIT_CPU, (200, 200))
import decomp
mesh = decomp.mesh(decomp.Block((0, 0, 0), (2, 1, 1)), size=0.5, cells="none")
open({str(tmp_path / "made")!r}, "w").write(str(len(mesh.tets)))
"""
    subprocess.run([sys.executable, "-c", program], check=True, timeout=300)
    assert int((tmp_path / "made").read_text()) > 10
