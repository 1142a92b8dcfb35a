"""`decomp mesh` of several models: each in a process of its own, so that none stops the others."""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import CancelledError, ThreadPoolExecutor
from contextlib import contextmanager, suppress
from dataclasses import dataclass, replace
from pathlib import Path
from threading import Lock
from typing import Any

from decomp.cli.arguments import are_streams
from decomp.cli.mesh_job import MeshJob
from decomp.cli.said import say
from decomp.errors import DecompError, FileError, InputError
from decomp.files.targets import check_outputs, reason
from decomp.meshes.files.table import FORMATS
from decomp.plain import plain

SECONDS_TO_END = 1.5
"""Seconds that a process is given to end when it is asked to."""

Tell = Callable[[str, float], None]


@dataclass(frozen=True, eq=False)
class Outcome:
    """What has become of a model.

    Args:
        model: its file.
        seconds: taken.
        figures: the report's, None if it failed.
        error: why it failed, else "".
    """

    model: Path
    seconds: float
    figures: dict[str, Any] | None
    error: str


def run(options: argparse.Namespace, first: MeshJob) -> None:
    """Mesh all models into a directory, tell of each, fail if any did.

    Args:
        options: of the command.
        first: what they ask for, of the first model.

    Raises:
        InputError: two would be written to one file.
        FileError: the directory cannot be made, or a file cannot be written.
        DecompError: a model failed; the others are written.
    """
    for name in ("report", "html"):
        if getattr(options, name) is not None:
            raise InputError(f"--{name} is for one model; a batch prints a table")
    if are_streams([*options.models, *options.output]):
        raise InputError("- is one model or one file; of several each has a name")
    pairs = zip(options.models, _targets(options), strict=True)
    jobs = [replace(first, model=model, outputs=(target,)) for model, target in pairs]
    outcomes = _meshed(jobs, options.jobs or 1, options.quiet)
    if not options.quiet:
        say(table(outcomes))
    failed = [outcome for outcome in outcomes if outcome.error]
    for outcome in failed:
        # errors of files begin with the file's name already
        named = outcome.error.startswith(str(outcome.model))
        where = "" if named else f"{outcome.model}: "
        say([f"decomp: {where}{outcome.error}"], to_errors=True)
    if failed:
        raise DecompError(f"{len(failed)} of {len(outcomes)} models failed")


def table(outcomes: Sequence[Outcome]) -> list[str]:
    """A line for each model."""
    width = max([5, *(len(str(outcome.model)) for outcome in outcomes)])
    lines = [f"{'model':<{width}}  {'tets':>9}  {'volume error':>12}  {'least angle':>11}  seconds"]
    for each in outcomes:
        start = f"{each.model!s:<{width}}"
        if each.figures is None:
            lines.append(f"{start}  {'failed':>9}  {'':>12}  {'':>11}  {each.seconds:7.1f}")
            continue
        regions = each.figures["regions"]
        off = max(abs(r["volume"] / r["exact"] - 1) for r in regions)
        angle = each.figures["quality"]["least_dihedral"]
        lines.append(
            f"{start}  {each.figures['tets']:>9}  {off:>12.1e}  {angle:>11.1f}  {each.seconds:7.1f}"
        )
    return lines


def _targets(options: argparse.Namespace) -> list[Path]:
    """The file for each model, in a directory that is there."""
    if len(options.output) > 1:
        raise InputError("several models are written into one directory; give -o once")
    folder = options.output[0] if options.output else Path()
    names = [f"{model.stem}.{options.format or FORMATS[0].name}" for model in options.models]
    for k, name in enumerate(names):
        if name in names[:k]:
            first = options.models[names.index(name)]
            raise InputError(
                f"{first} and {options.models[k]} would both be written to {folder / name}"
            )
    _make(folder)
    targets = [folder / name for name in names]
    check_outputs(targets, options.models)
    return targets


def _make(folder: Path) -> None:
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise FileError(
            f"several models are written into a directory, and this is none: {reason(error)}",
            folder,
        ) from None


def _meshed(jobs: Sequence[MeshJob], at_a_time: int, quiet: bool) -> list[Outcome]:
    """All models, some at a time; when interrupted, all are stopped."""
    running = _Workers()
    with (
        _bars([job.model for job in jobs], quiet) as tells,
        ThreadPoolExecutor(at_a_time) as pool,
    ):
        try:
            waiting = [pool.submit(_one, *each, running) for each in zip(jobs, tells, strict=True)]
            return [future.result() for future in waiting]
        except BaseException:
            # those that wait are not begun any more
            running.stop()
            raise


def _one(job: MeshJob, tell: Tell, running: _Workers) -> Outcome:
    start = time.perf_counter()
    process = running.started()
    assert process.stdin is not None
    assert process.stdout is not None
    assert process.stderr is not None
    figures, error = None, ""
    # one that has died already is told of below; the pipe stays open, as its end tells the
    # process that this one has died
    with suppress(BrokenPipeError):
        process.stdin.write(json.dumps(job.as_json()) + "\n")
        process.stdin.flush()
    for line in process.stdout:
        if not line.endswith("\n"):
            break
        said = json.loads(line)
        if "what" in said:
            tell(said["what"], said["done"])
        figures, error = said.get("figures", figures), said.get("error", error)
    noise = process.stderr.read().strip().splitlines()
    code = process.wait()
    with suppress(BrokenPipeError):
        process.stdin.close()
    if figures is None and not error:
        error = f"ended with code {code}" + (f": {noise[-1]}" if noise else "")
    tell("failed" if error else "done", 1.0)
    return Outcome(job.model, time.perf_counter() - start, figures, error)


class _Workers:
    """The processes that mesh, which are all stopped when one is."""

    def __init__(self) -> None:
        self._lock = Lock()
        self._stopped = False
        self._all: list[subprocess.Popen[str]] = []

    def started(self) -> subprocess.Popen[str]:
        """A new process, known before it can be missed."""
        with self._lock:
            if self._stopped:
                raise CancelledError
            process = subprocess.Popen(
                [sys.executable, "-m", "decomp.cli.batch_worker"],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=subprocess.PIPE,
                text=True,
                start_new_session=True,
            )
            self._all.append(process)
            return process

    def stop(self) -> None:
        """Ask all to end, and kill those that do not soon."""
        with self._lock:
            self._stopped = True
        for process in self._all:
            if process.poll() is None:
                process.terminate()
        end = time.monotonic() + SECONDS_TO_END
        for process in self._all:
            try:
                process.wait(max(0.0, end - time.monotonic()))
            except subprocess.TimeoutExpired:
                process.kill()


@contextmanager
def _bars(models: Sequence[Path], quiet: bool) -> Iterator[list[Tell]]:
    """A bar on stderr for each model; silence where stderr is no terminal."""
    if quiet or not sys.stderr.isatty():
        yield [lambda what, done: None for _ in models]
        return
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

    columns = (
        TextColumn("{task.fields[model]}", markup=False),
        BarColumn(),
        TextColumn("{task.description}", markup=False),
        TimeElapsedColumn(),
    )
    with Progress(*columns, console=Console(stderr=True)) as progress:
        tasks = [
            progress.add_task("waiting", total=1.0, start=False, model=plain(str(model)))
            for model in models
        ]

        def teller(task: Any) -> Tell:
            def tell(what: str, done: float) -> None:
                progress.start_task(task)
                progress.update(task, description=plain(what), completed=done)

            return tell

        yield [teller(task) for task in tasks]
