"""Thousands of spoiled files, each read: nothing may come of it but a model or one clear error.

Run: python -m benchmarks.fuzz [--models 3000] [--meshes 500] [--seed 1] [--folder DIR]

Models are those in meshes/, those of the tests' shared tables, examples of each format, and files
of a folder if one is given; meshes are written for it. Each is spoiled in one to three ways
(benchmarks/mutations.py) and read; of every fourth model that can be read and is small the
boundary is computed too. Allowed is a DecompError of one line, within five seconds of computing
and MEMORY more bytes; a warning of NumPy's is a failure. A table is printed, then what failed;
`--case model:17` writes one case to stdout. The exit code is 1 if any failed.
"""

from __future__ import annotations

import argparse
import random
import resource
import signal
import sys
import tempfile
import time
import traceback
import warnings
from collections import Counter, defaultdict
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from types import FrameType

from benchmarks.mutations import mutated
from decomp.csg.model import Model, model
from decomp.csg.primitives import Primitive
from decomp.csg.solid import Copies, walk
from decomp.errors import DecompError
from decomp.formats import load
from decomp.formats.native import dumps
from decomp.geometry import Geometry
from decomp.meshes.files.msh_reader import read_msh
from decomp.plain import plain
from tests.meshes.shapes import bar, cube, quadratic
from tests.solids import SOLIDS

ROOT = Path(__file__).parents[1]
LIMIT = 5.0
"""Seconds of computing that a file may take."""
MEMORY = 2**31
"""Bytes that reading may take beyond what the process has."""
SMALL = 12
"""Primitives of models whose boundary is computed: theirs takes well below a second."""

GEO = """algebraic3d
# a plate with holes, in oil
define constant a = 3
solid hole = cylinder (5, 15, 0; 5, 15, 1; 3) -bc=2;
solid holes = multitranslate (15, 0, 0; 2; hole);
solid slab = orthobrick (0, 0, 0; 40, 30, 5) -bc=1;
solid knob = cone (20, 25, 5; 3; 20, 25, 9; 1) and plane (20, 25, 4; 0, 0, -1)
  and plane (20, 25, 8; 0, 0, 1);
solid plate = slab and not holes or knob;
solid ring = rotate (0, 0, 0; 0, 0.5, 0; torus (20, 15, -20; 0, 0, 1; 6; 2));
boundingbox (-10, -10, -10; 50, 40, 15);
tlo plate -maxh=3 -material=steel;
tlo ring -col=[1, 0, 0.5] -transparent;
"""
CSG = """group() {
  difference() {
    multmatrix([[0, -1, 0, 10], [1, 0, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]) {
      cylinder($fn = 64, $fa = 12, $fs = 2, h = 4, r1 = 8, r2 = 6, center = false);
    }
    color([1, 0, 0, 0.5]) { cube(size = [2, 30, 1], center = true); }
    *sphere(r = 3);
  }
  intersection() { sphere(d = 5); cube([3, 3, 3]); }
  rotate_extrude(angle = 360, $fn = 0) {
    multmatrix([[1, 0, 0, 30], [0, 1, 0, 2], [0, 0, 1, 0], [0, 0, 0, 1]]) { circle(r = 4); }
  }
}
"""


@dataclass
class Row:
    """What became of the files of one kind."""

    cases: int = 0
    read: int = 0
    refused: int = 0
    computed: int = 0
    slowest: float = 0.0
    failed: int = 0
    kinds: Counter[str] = field(default_factory=Counter)


class TooSlowError(Exception):
    """A file took longer than it may."""


def originals(folder: Path | None) -> dict[str, list[bytes]]:
    """Whole files of models, by suffix."""
    found: dict[str, list[bytes]] = {".geo": [GEO.encode()], ".csg": [CSG.encode()], ".json": []}
    for case in SOLIDS.values():
        found[".json"].append(dumps(model(case.make())).encode())
    for place in (ROOT / "meshes", *([folder] if folder else [])):
        for path in sorted(place.rglob("*")):
            if path.suffix in found and path.stat().st_size < 100_000:
                found[path.suffix].append(path.read_bytes())
                if place == ROOT / "meshes":
                    found[".json"].append(dumps(load(path)).encode())
    return found


def meshes() -> dict[str, list[bytes]]:
    """Whole files of meshes, by how they are written."""
    found: dict[str, list[bytes]] = {}
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "mesh.msh")
        for what, text, version in (
            ("binary", False, "4.1"),
            ("text", True, "4.1"),
            ("2.2", False, "2.2"),
        ):
            for mesh in (cube(), bar(), quadratic(cube())):
                mesh.write(path, text=text, version=version)
                found.setdefault(f".msh {what}", []).append(path.read_bytes())
    return found


def case(number: int, seed: int, sources: Mapping[str, Sequence[bytes]]) -> tuple[str, bytes]:
    """The kind and the bytes of a spoiled file; the same for the same number and seed."""
    chance = random.Random(f"{seed}/{number}")
    kinds = list(sources)
    kind = kinds[number % len(kinds)]
    return kind, mutated(chance, chance.choice(sources[kind]), sources[kind])


def tried(kind: str, data: bytes, folder: Path, compute: bool, row: Row) -> str:
    """Read a file, note what came of it; returns what is wrong with that, else ""."""
    path = folder / f"case{kind.split()[0]}"
    path.write_bytes(data)
    row.cases += 1
    start = time.process_time()
    wrong = ""
    try:
        with within(LIMIT):
            if path.suffix == ".msh":
                read_msh(path)
                row.read += 1
            else:
                found = load(path)
                row.read += 1
                if compute and _small(found):
                    row.computed += 1
                    Geometry(found)
    except DecompError as error:
        row.refused += 1
        row.kinds[type(error).__name__] += 1
        if str(error) != plain(str(error)) or len(str(error)) > 2000:
            wrong = f"an error of {len(str(error))} characters, or with some that do not print"
    except Exception as error:  # whatever it is, it is what is looked for
        at = traceback.extract_tb(error.__traceback__)[-1]
        wrong = f"{type(error).__name__} in {Path(at.filename).name}:{at.lineno}: {error}"
    spent = time.process_time() - start
    row.slowest = max(row.slowest, spent)
    if not wrong and spent > LIMIT:
        wrong = f"took {spent:.1f} s"
    row.failed += bool(wrong)
    return wrong


def _small(found: Model) -> bool:
    nodes = list(walk([region.solid for region in found.regions]))
    copies = sum(len(node.by) for node in nodes if isinstance(node, Copies))
    return copies + sum(isinstance(node, Primitive) for node in nodes) <= SMALL


@contextmanager
def within(seconds: float) -> Iterator[None]:
    """End what takes longer, and refuse it more memory than it may have."""

    def stop(number: int, frame: FrameType | None) -> None:
        raise TooSlowError(f"still running after {seconds:g} s")

    before = signal.signal(signal.SIGPROF, stop)
    limits = resource.getrlimit(resource.RLIMIT_AS)
    have = int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
    resource.setrlimit(resource.RLIMIT_AS, (have + MEMORY, limits[1]))
    signal.setitimer(signal.ITIMER_PROF, seconds)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.signal(signal.SIGPROF, before)
        resource.setrlimit(resource.RLIMIT_AS, limits)


def fuzz(
    numbers: Sequence[int], seed: int, sources: Mapping[str, Sequence[bytes]]
) -> tuple[dict[str, Row], dict[int, str]]:
    """Try some cases; returns rows by kind, and what failed by number."""
    rows: dict[str, Row] = defaultdict(Row)
    failures = {}
    with tempfile.TemporaryDirectory() as folder:
        for number in numbers:
            kind, data = case(number, seed, sources)
            wrong = tried(kind, data, Path(folder), number // len(sources) % 4 == 0, rows[kind])
            if wrong:
                failures[number] = wrong
    return rows, failures


def table(rows: Mapping[str, Row]) -> list[str]:
    """A line for each kind."""
    lines = ["kind          files    read  refused  computed  slowest s  failed"]
    lines += [
        f"{kind:<12} {row.cases:>6} {row.read:>7} {row.refused:>8} {row.computed:>9} "
        f"{row.slowest:>10.2f} {row.failed:>7}"
        for kind, row in rows.items()
    ]
    kinds = sum((row.kinds for row in rows.values()), Counter[str]())
    return [*lines, "", ", ".join(f"{count} {name}" for name, count in kinds.most_common())]


def main() -> int:
    """Try all, print what came of it."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--models", type=int, default=3000, help="files of models (default 3000)")
    parser.add_argument("--meshes", type=int, default=500, help="files of meshes (default 500)")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--folder", type=Path, help="more models to spoil")
    parser.add_argument("--case", metavar="WHAT:N", help="write one case to stdout, as model:17")
    options = parser.parse_args()
    of = {"model": originals(options.folder), "mesh": meshes()}
    if options.case:
        what, _, number = options.case.partition(":")
        sys.stdout.buffer.write(case(int(number), options.seed, of[what])[1])
        return 0
    for data in of["model"][".json"]:  # compiles what is compiled, which takes its time once
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder, "whole.json")
            path.write_bytes(data)
            if _small(load(path)):
                Geometry(path)
    failed = False
    for what, count in (("model", options.models), ("mesh", options.meshes)):
        rows, failures = fuzz(range(count), options.seed, of[what])
        print("\n".join(table(rows)), flush=True)
        for number, wrong in failures.items():
            print(f"FAILED {what}:{number} (seed {options.seed}): {plain(wrong)[:300]}")
        failed = failed or bool(failures)
        print()
    return int(failed)


if __name__ == "__main__":
    sys.exit(main())
