"""How many parts get a skeleton, and how many a mesh: `python -m benchmarks.success [FOLDER ...]`.

Parts of `benchmarks/parts.py`, as drawn or turned, with round sizes or not, designs at random, or
all models in some folders. Each runs in a process of its own with a limit of computing. Printed is
what became of them: certified (traced or sampled), meshed, meshed with what falls short in its
check, refused (by stage and error), wrong, out of time, crashed; and how long it took. A volume is
wrong if it is not that of points asked of the primitives one by one, and so are cells that do not
fill their region.
"""

from __future__ import annotations

import argparse
import json
import os
import resource
import sys
import time
from collections import Counter
from collections.abc import Callable, Iterator
from pathlib import Path
from statistics import median
from typing import Any

import numpy as np

import decomp
from benchmarks.designs import design
from benchmarks.membership import volume
from benchmarks.parts import FAMILIES, drawn
from decomp.checking.check import check
from decomp.csg.solid import Solid
from decomp.errors import GeometryError
from decomp.files.format import suffixes
from decomp.formats import FORMATS
from decomp.geometry import Geometry
from decomp.skeletons.model import Method

TRACED, SAMPLED, MESHED = "certified traced", "certified sampled", "meshed"
REFUSED, WRONG, STOPPED, CRASHED = "refused", "wrong", "out of time", "crashed"
SHORT = "falls short"
GOOD = (TRACED, SAMPLED, MESHED)
DEVIATIONS = 5.0
"""Standard errors that a volume may be off."""
CELLS = 2e-3
"""The cells' chords may leave so much of a volume."""

Make = Callable[[], Solid | Path]


def designs(count: int, first: int, oblique: bool) -> Iterator[tuple[str, Make]]:
    """Designs at random, one for each seed."""
    for seed in range(first, first + count):
        yield f"design {seed}", lambda seed=seed: design(seed, oblique)


def files(folders: list[Path]) -> Iterator[tuple[str, Make]]:
    """All models below some folders."""
    for folder in folders:
        for path in sorted(folder.rglob("*")):
            if path.suffix in suffixes(FORMATS):
                yield str(path), lambda path=path: path


def computed(source: Solid | Path, meshes: str | None, method: Any) -> dict[str, str]:
    """What becomes of a part."""
    try:
        geometry = Geometry(source)
        if meshes is not None:
            mesh = decomp.mesh(geometry, cells=meshes)  # type: ignore[arg-type]
            short = check(geometry, mesh).shortcomings
            what, odd = MESHED, wrong(geometry, {})
            if short and not odd:
                return {"what": SHORT, "why": f"{len(mesh.tets)} tets: {'; '.join(short)}"}
        else:
            found = decomp.skeleton(geometry, method=method)
            traced = all(region.method is Method.TRACED for region in found.regions)
            what = TRACED if traced else SAMPLED
            cells = {r.name: sum(cell.volume for cell in r.cells) for r in found.regions}
            odd = wrong(geometry, cells)
    except GeometryError as error:
        return {"what": REFUSED, "why": f"{error.stage} {type(error).__name__}: {error}"}
    except decomp.DecompError as error:
        return {"what": REFUSED, "why": f"{type(error).__name__}: {error}"}
    except Exception as error:
        return {"what": CRASHED, "why": repr(error)}
    return {"what": WRONG, "why": odd} if odd else {"what": what, "why": ""}


def wrong(geometry: Geometry, cells: dict[str, float]) -> str:
    """What is wrong with a region's volume, or with what its cells hold; empty if nothing is."""
    solids = {region.name: region.solid for region in geometry.model.regions}
    for region in geometry.regions:
        low, high = region.bounds
        room = 1e-3 * (high - low)
        about, error = volume(solids[region.name], np.array([low - room, high + room]))
        if abs(about - region.volume) > DEVIATIONS * error:
            return f"volume: {region.name} holds {region.volume:.6g}, points {about:.6g}"
        held = cells.get(region.name, region.volume)
        if abs(held - region.volume) > CELLS * region.volume:
            return f"cells: of {region.name} hold {held:.6g} of {region.volume:.6g}"
    return ""


def outcome(make: Make, meshes: str | None, method: str, limit: int) -> dict[str, Any]:
    """What becomes of a part in a process of its own, and its seconds."""
    reader, writer = os.pipe()
    start = time.perf_counter()
    pid = os.fork()
    if pid == 0:
        os.close(reader)
        resource.setrlimit(resource.RLIMIT_CPU, (limit, limit + 5))
        os.write(writer, json.dumps(computed(make(), meshes, method)).encode()[:60_000])
        os._exit(0)
    os.close(writer)
    with os.fdopen(reader, "rb") as pipe:
        said = pipe.read()
    _, _, used = os.wait4(pid, 0)
    found = json.loads(said) if said else {"what": STOPPED, "why": ""}
    seconds = used.ru_utime + used.ru_stime
    return {**found, "seconds": seconds, "clock": time.perf_counter() - start}


def counted(parts: Iterator[tuple[str, Make]], meshes: str | None, method: str, limit: int) -> None:
    """Compute all parts, tell of those that fail, and print the table."""
    found: list[dict[str, Any]] = []
    for name, make in parts:
        each = outcome(make, meshes, method, limit)
        found.append(each)
        if each["what"] not in GOOD:
            print(f"{name}: {each['what']} {each['why'][:200]}", flush=True)
    if not found:
        sys.exit("there are no models")
    counts = Counter(each["what"] for each in found)
    for what, count in counts.most_common():
        print(f"{what:<18} {count:>5} of {len(found)}  {100 * count / len(found):.1f} %")
    good = [each["seconds"] for each in found if each["what"] in GOOD]
    if good:
        print(f"seconds of computing: median {median(good):.2f}, most {max(good):.2f}")
    for reason, count in Counter(
        f"{each['what']}: {each['why'].split(':')[0]}" for each in found if each["why"]
    ).most_common():
        print(f"{count:>5}  {reason}")


def main() -> None:
    """Run all parts and print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folders", nargs="*", type=Path, help="of models; by default own parts")
    parser.add_argument("--families", nargs="*", choices=FAMILIES, default=list(FAMILIES))
    parser.add_argument("--designs", choices=("parallel", "oblique"), help="designs at random")
    parser.add_argument("--count", type=int, default=20, help="of own parts in each family")
    parser.add_argument("--first", type=int, default=0, help="seed")
    parser.add_argument("--digits", type=int, help="that sizes of own parts are rounded to")
    parser.add_argument("--turned", action="store_true", help="turn own parts at random")
    parser.add_argument("--method", choices=("traced", "sampled", "auto"), default="traced")
    parser.add_argument("--mesh", choices=("skeleton", "none"), help="mesh, with such cells")
    parser.add_argument("--limit", type=int, default=120, help="seconds of computing for each")
    options = parser.parse_args()
    parts: Iterator[tuple[str, Make]]
    if options.folders:
        parts = files(options.folders)
    elif options.designs:
        parts = designs(options.count, options.first, options.designs == "oblique")
    else:
        own = options.families, options.count, options.first, options.digits, options.turned
        parts = iter(drawn(*own))
    counted(parts, options.mesh, options.method, options.limit)


if __name__ == "__main__":
    main()
