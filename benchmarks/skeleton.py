"""Time and triangles of skeletons, next to what TetWild takes to mesh the same complex.

Run: python -m benchmarks.skeleton [--only NAME ...] [--limit 300]

Times are CPU seconds of one process, of all its threads together. The skeleton's is that of a
process whose kernels are compiled and loaded (it has computed another model before); it includes
the model's boundary and the certificate. TetWild (`pytetwild`) gets the boundary and the sheets in
one call, scaled to a diagonal of 1, edge length 0.05, one thread, all other settings its defaults,
in a process of its own with a time limit. `triangles` are those of boundary and sheets together;
`needed` is what design studies of the same solids found an exactly traced boundary representation
to need. A figure that misses its goal is marked with an exclamation mark.
"""

from __future__ import annotations

import argparse
import json
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np
from rich.console import Console
from rich.table import Table

import decomp
from decomp.complex.model import PatchKind
from decomp.csg.solid import Solid
from decomp.skeletons.model import Skeleton
from tests.corpus.files import FILES
from tests.solids import SOLIDS

ROOT = Path(__file__).parents[1]
SHARE, GROWTH, LEAN = 0.5, 5.0, 2.0
EDGE_LENGTH = 0.05

MODELS: dict[str, tuple[str, int | None]] = {
    "block": ("block", 34),
    "cylinder": ("cylinder", 368),
    "through hole": ("through hole", 566),
    "blind hole": ("blind hole", 1683),
    "equal tee": ("equal tee", 703),
    "unequal tee": ("unequal tee", None),
    "sculpture": ("netgen/sculpture.geo", None),
    "shaft": ("netgen/shaft.geo", None),
    "manyholes": ("netgen/manyholes.geo", None),
    "manyholes2": ("netgen/manyholes2.geo", None),
}
"""Name in the table of solids or among the files, and the triangles needed."""
MESHED = tuple(MODELS)[:-2]


def source_of(name: str) -> Solid | Path:
    """A solid or a model file."""
    return SOLIDS[name].make() if name in SOLIDS else FILES[name]


def soup_of(skeleton: Skeleton) -> tuple[Any, Any]:
    """Points and triangles of boundary and sheets, centred, with a diagonal of 1."""
    kept = [p.triangles for p in skeleton.complex.patches if p.kind is not PatchKind.TRIM]
    used, numbers = np.unique(np.concatenate(kept), return_inverse=True)
    points = skeleton.complex.points[used]
    middle = (points.min(axis=0) + points.max(axis=0)) / 2
    return (points - middle) / skeleton.diagonal, numbers.reshape(-1, 3).astype(np.int32)


def compute(name: str, output: Path) -> dict[str, float]:
    """In a process of its own: compute a skeleton, leave its complex in a file."""
    decomp.skeleton(SOLIDS["conical pit"].make())  # loads the kernels
    source = source_of(name)
    wall, start = time.perf_counter(), time.process_time()
    skeleton = decomp.skeleton(source)
    seconds, wall = time.process_time() - start, time.perf_counter() - wall
    points, triangles = soup_of(skeleton)
    np.savez(output, points=points, triangles=triangles)
    return {"seconds": seconds, "wall": wall, "triangles": len(triangles)}


def mesh(path: Path) -> dict[str, float]:
    """In a process of its own: let TetWild mesh a complex."""
    import pytetwild

    soup = np.load(path)
    start = time.process_time()
    _, tets = pytetwild.tetrahedralize(
        soup["points"],
        soup["triangles"],
        edge_length_abs=EDGE_LENGTH,
        num_threads=1,
        vtk_ordering=True,
        disable_filtering=True,
    )
    return {"seconds": time.process_time() - start, "tets": len(tets)}


def child(arguments: list[str], folder: str, limit: float) -> dict[str, Any]:
    """What a process prints, or why it printed nothing; of one stopped, the CPU time it took."""
    command = [sys.executable, str(Path(__file__).resolve()), *arguments]
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    try:
        done = subprocess.run(
            command,
            capture_output=True,
            text=True,
            timeout=limit,
            check=False,
            cwd=folder,
            env={"PATH": "/usr/bin:/bin", "PYTHONPATH": str(ROOT)},
        )
    except subprocess.TimeoutExpired:
        used = resource.getrusage(resource.RUSAGE_CHILDREN)
        seconds = used.ru_utime + used.ru_stime - before.ru_utime - before.ru_stime
        return {"error": f"over {seconds:.0f}", "at_least": seconds}
    lines = done.stdout.strip().splitlines()
    if done.returncode == 0 and lines:
        found: dict[str, Any] = json.loads(lines[-1])
        return found
    said = done.stderr.strip().splitlines()
    return {"error": said[-1] if said else f"exit code {done.returncode}"}


def measured(name: str, limit: float) -> dict[str, Any]:
    """All figures of a model."""
    with tempfile.TemporaryDirectory() as folder:
        soup = str(Path(folder) / "complex.npz")
        result = child(["--compute", MODELS[name][0], soup], folder, limit)
        if name in MESHED and "error" not in result:
            result["tetwild"] = child(["--mesh", soup], folder, limit)
        return result


def row_of(name: str, figures: dict[str, Any]) -> list[str]:
    """A model's row."""
    if "error" in figures:
        return [name, figures["error"] + (" s" if "at_least" in figures else "")]
    needed = MODELS[name][1]
    tetwild = figures.get("tetwild", {})
    count = figures["triangles"]
    return [
        name,
        f"{figures['seconds']:.2f}",
        f"{figures['wall']:.2f}",
        f"{count:,}",
        f"{needed:,}" if needed else "",
        marked(count / needed, LEAN) if needed else "",
        tetwild.get("error") or (f"{tetwild['seconds']:.1f}" if tetwild else ""),
        f"{tetwild['tets']:,}" if "tets" in tetwild else "",
        share_of(figures["seconds"], tetwild),
    ]


def share_of(seconds: float, tetwild: dict[str, Any]) -> str:
    """The skeleton's time by TetWild's, or what it is below."""
    if "seconds" in tetwild:
        return marked(seconds / tetwild["seconds"], SHARE)
    return f"< {marked(seconds / tetwild['at_least'], SHARE)}" if "at_least" in tetwild else ""


def marked(ratio: float, most: float) -> str:
    """A ratio, marked if it is above its goal."""
    return f"{ratio:.2f}{'' if ratio <= most else ' !'}"


def report(results: dict[str, dict[str, Any]]) -> None:
    """Print the table."""
    table = Table(title=f"skeletons; goals: lean {LEAN:g}, share of TetWild's time {SHARE:g}")
    for heading in (
        "model", "CPU s", "wall s", "triangles", "needed", "ratio", "TetWild CPU s", "tets",
        "share",
    ):  # fmt: skip
        table.add_column(heading, justify="left" if heading == "model" else "right")
    for name, figures in results.items():
        table.add_row(*row_of(name, figures))
    Console(width=150).print(table)
    few, many = results.get("manyholes", {}), results.get("manyholes2", {})
    if "seconds" in few and "seconds" in many:
        ratio = marked(many["seconds"] / few["seconds"], GROWTH)
        print(f"growth from 100 to 400 holes: {ratio} (goal {GROWTH:g})")


def main() -> int:
    """Measure the models one by one."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--only", nargs="+", choices=MODELS, default=list(MODELS), metavar="NAME")
    parser.add_argument("--limit", type=float, default=300.0, help="seconds for one process")
    parser.add_argument("--compute", nargs=2, help=argparse.SUPPRESS)
    parser.add_argument("--mesh", type=Path, help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.compute:
        print(json.dumps(compute(options.compute[0], Path(options.compute[1]))))
        return 0
    if options.mesh:
        print(json.dumps(mesh(options.mesh)))
        return 0
    results = {}
    for name in options.only:
        results[name] = measured(name, options.limit)
        print(f"{name}: {json.dumps(results[name])}", flush=True)
    report(results)
    return 0


if __name__ == "__main__":
    sys.exit(main())
