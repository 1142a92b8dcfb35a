"""fTetWild in a child process with a working directory, a time limit and a kill.

It holds the interpreter's lock, replaces the handler of SIGINT, writes files where it is, crashes
on bad input, and may exit with 0 without any result. So only a readable, sound result counts.
"""

from __future__ import annotations

import contextlib
import io
import os
import signal
import subprocess
import sys
import zipfile
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from decomp.errors import FileError, GeometryError, InputError
from decomp.files.targets import reason
from decomp.meshing.backends.base import MeshingError, TimeLimit
from decomp.meshing.backends.tetwild.worker import FULL, MISSING, SPENT
from decomp.meshing.sizing.size_field import SizeField
from decomp.processes.workplace import ROOM, swept, workplace
from decomp.vectors import Array, Ints

NAME = "tetwild"
"""Of the directories that it works in."""
WORKER = Path(__file__).with_name("worker.py")
EDGE_IN_EPSILONS = 6.0
"""Edges are at least so many epsilons long."""
ADVICE = "A larger size gives fewer elements and needs less time; the time limit can be raised too"
UNHURRIED = TimeLimit(600.0)
RETRY_ENERGY = 2.0
RETRY_EPSILON = 0.7
"""What a second try multiplies the stop energy and epsilon by."""
RUNNABLE_EPSILON = 1e-6
"""Epsilon below this part of the model's size has TetWild run without end."""


@dataclass(frozen=True)
class Settings:
    """What fTetWild is told.

    Args:
        edge_length: wanted where the size field says nothing, in model units.
        epsilon: how far it may leave the triangles, in model units.
        stop_energy: the AMIPS energy at which it stops improving; 3 and less never end, 50 and
            more leave angles of 1 degree.
        iterations: the most passes over the mesh.
        simplify: whether the triangles are simplified first.
        coarsen: whether it ends with as few tetrahedra as it can.
        threads: at least 1.
    """

    edge_length: float
    epsilon: float
    stop_energy: float = 10.0
    iterations: int = 80
    simplify: bool = False
    coarsen: bool = False
    threads: int = 1

    def other(self) -> Settings:
        """The settings of a second try."""
        return replace(
            self,
            epsilon=RETRY_EPSILON * self.epsilon,
            stop_energy=RETRY_ENERGY * self.stop_energy,
            simplify=True,
        )

    def __str__(self) -> str:
        return (
            f"edge length {self.edge_length:.4g}, epsilon {self.epsilon:.4g}, "
            f"stop energy {self.stop_energy:.4g}{', simplify' if self.simplify else ''}"
        )


@dataclass(frozen=True, eq=False)
class Filling:
    """What fTetWild made.

    Args:
        points: (n, 3) in model units.
        tets: (m, 4) positively oriented; outside the model too.
        settings: it was made with.
        notes: what went wrong before.
    """

    points: Array
    tets: Ints
    settings: Settings
    notes: tuple[str, ...]


def tetrahedralized(
    points: Array,
    triangles: Ints,
    settings: Settings,
    field: SizeField | None = None,
    limit: TimeLimit = UNHURRIED,
    tell: Callable[[str], None] = lambda note: None,
) -> Filling:
    """Fill the box around triangles with tetrahedra that conform to them.

    Args:
        points: (n, 3).
        triangles: (m, 3) indices of points.
        settings: of the first try.
        field: sizes.
        limit: after which a try is given up.
        tell: is told of a failed first try.

    Raises:
        InputError: the triangles or settings would crash or hang it; pytetwild is missing.
        FileError: there is no room for its files in the directory for temporary ones.
        MeshingError: both tries failed.
    """
    _check(points, triangles, settings)
    centre = (points.max(axis=0) + points.min(axis=0)) / 2
    scale = float(np.linalg.norm(np.ptp(points, axis=0)))
    notes: list[str] = []
    for attempt in (settings, settings.other()):
        arrays = _scaled(points, triangles, attempt, field, centre, scale)
        try:
            found, tets = _run(arrays, limit)
        except MeshingError as error:
            notes.append(f"TetWild {error} ({attempt})")
            tell(f"{notes[-1]}, trying again with other settings")
            continue
        return Filling(found * scale + centre, tets, attempt, tuple(notes))
    raise MeshingError("; then ".join(notes) + f". {ADVICE}")


def _check(points: Array, triangles: Ints, settings: Settings) -> None:
    """Refuse what is known to crash or hang fTetWild."""
    if len(triangles) == 0:
        raise InputError("there are no triangles to mesh")
    if not np.isfinite(points).all():
        raise GeometryError("a point of the complex is not finite")
    if triangles.min() < 0 or triangles.max() >= len(points):
        raise InputError("a triangle refers to a point that does not exist")
    scale = float(np.linalg.norm(np.ptp(points, axis=0)))
    if scale == 0.0:
        raise GeometryError("all points of the complex are equal")
    if not settings.epsilon / scale > RUNNABLE_EPSILON:
        raise InputError(
            f"epsilon {settings.epsilon:.3g} is below a millionth of the model's size "
            f"{scale:.3g}: TetWild would not end"
        )
    if not EDGE_IN_EPSILONS * settings.epsilon <= 1.001 * settings.edge_length < scale:
        raise InputError(
            f"edge length {settings.edge_length:.3g} must be at least {EDGE_IN_EPSILONS:g} times "
            f"epsilon {settings.epsilon:.3g} and below the model's size {scale:.3g}"
        )
    if not 4.0 <= settings.stop_energy < 50.0 or settings.threads < 1:
        raise InputError("stop energy must be from 4 to 50, and there must be a thread")


def _scaled(
    points: Array,
    triangles: Ints,
    settings: Settings,
    field: SizeField | None,
    centre: Array,
    scale: float,
) -> dict[str, object]:
    """The worker's input: the model moved to the origin and scaled to a diagonal of 1."""
    if field is None:
        field = SizeField(np.empty((0, 3)), np.empty((0, 4), dtype=np.int64), np.empty(0))
    return {
        "points": (points - centre) / scale,
        "triangles": triangles,
        "edge_length": settings.edge_length / scale,
        "epsilon": settings.epsilon / scale,
        "stop_energy": settings.stop_energy,
        "iterations": settings.iterations,
        "simplify": settings.simplify,
        "coarsen": settings.coarsen,
        "threads": settings.threads,
        "field_points": (field.points - centre) / scale,
        "field_tets": field.tets,
        "field_sizes": field.sizes / scale,
    }


def _run(arrays: dict[str, object], limit: TimeLimit) -> tuple[Array, Ints]:
    """Run the worker once.

    Raises:
        MeshingError: it crashed, hung, or gave nothing.
        InputError: pytetwild is missing.
        FileError: its files cannot be written.
    """
    packed = io.BytesIO()
    np.savez(packed, **arrays)  # type: ignore[arg-type]
    swept(NAME)
    with workplace(NAME) as directory:
        source, target = directory / "in.npz", directory / "out.npz"
        try:
            source.write_bytes(packed.getvalue())
        except OSError as error:
            raise _no_room(directory, reason(error)) from None
        process = subprocess.Popen(
            [sys.executable, "-P", str(WORKER), str(source), str(target), str(limit.busy)],
            cwd=directory,
            stdin=subprocess.PIPE,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            start_new_session=True,
        )
        # it ends when this pipe does; `communicate` would close it at once
        lifeline, process.stdin = process.stdin, None
        try:
            _, errors = process.communicate(timeout=limit.clock)
        except subprocess.TimeoutExpired:
            raise MeshingError(f"did not end within {limit.clock:g} s") from None
        finally:
            _kill(process)
            if lifeline is not None:
                lifeline.close()
        if process.returncode == MISSING:
            raise InputError(
                f"{errors.decode(errors='replace').strip()}: pip install pytetwild==0.4.2"
            )
        if process.returncode == FULL:
            raise _no_room(directory, errors.decode(errors="replace").strip())
        if process.returncode == -SPENT:
            raise MeshingError(f"did not end within {limit.busy:g} s of computing")
        if process.returncode:
            raise MeshingError(_failure(process.returncode, errors))
        return _result(target)


def _no_room(directory: Path, why: str) -> FileError:
    return FileError(f"TetWild's files cannot be written: {why}; {ROOM}", directory.parent)


def _kill(process: subprocess.Popen[bytes]) -> None:
    """End the child with all that it started, if it still runs."""
    if process.poll() is None:
        with contextlib.suppress(ProcessLookupError):
            if os.name == "posix":
                os.killpg(process.pid, signal.SIGKILL)
            else:
                process.kill()
        process.wait()
    if process.stderr is not None:
        process.stderr.close()


def _failure(code: int, errors: bytes) -> str:
    if code < 0:
        with contextlib.suppress(ValueError):
            return f"was ended by {signal.Signals(-code).name}"
    last = errors.decode(errors="replace").strip().splitlines()[-1:]
    return f"failed with exit code {code}" + (f": {last[0]}" if last else "")


def _result(target: Path) -> tuple[Array, Ints]:
    """Read the worker's output and check that it is a mesh."""
    try:
        with np.load(target) as made:
            points, tets = made["points"], made["tets"].astype(np.int64)
    except (OSError, ValueError, KeyError, EOFError, zipfile.BadZipFile):
        raise MeshingError("ended without a result") from None
    if len(tets) == 0 or len(points) == 0:
        raise MeshingError("gave an empty mesh")
    if not np.isfinite(points).all() or tets.min() < 0 or tets.max() >= len(points):
        raise MeshingError("gave a broken mesh")
    return points, tets
