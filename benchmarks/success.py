"""How many parts get a skeleton, and how many a mesh: `python -m benchmarks.success [FOLDER ...]`.

Parts of this file's own making (plates, angles and housings with one bore, of random sizes, as
drawn or turned), or all models in some folders. Each runs in a process of its own with a limit of
computing; printed is what became of them, why some were refused, and how long it took.
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
from decomp.csg.solid import Solid
from decomp.formats import FORMATS

CERTIFIED, REFUSED, STOPPED, CRASHED = "certified", "refused", "out of time", "crashed"

Make = Callable[[], Solid | Path]


def plate(rng: np.random.Generator) -> Solid:
    """A plate with a bore along it."""
    length, width, height = rng.uniform([30, 20, 5], [80, 50, 12])
    radius = rng.uniform(0.1, 0.4) * height
    y = rng.uniform(radius + 0.5, width - radius - 0.5)
    z = rng.uniform(1.05 * radius, height - 1.05 * radius)
    bore = decomp.Cylinder((-1, y, z), (length + 1, y, z), radius, name="bore")
    return decomp.Block((0, 0, 0), (length, width, height), name="plate") - bore


def angle(rng: np.random.Generator) -> Solid:
    """An L profile with a bore across one of its legs."""
    length, leg, other, thick = rng.uniform([30, 20, 20, 3], [80, 40, 40, 8])
    radius = rng.uniform(1, 0.35 * (leg - thick))
    x = rng.uniform(radius + 1, length - radius - 1)
    y = rng.uniform(thick + radius + 0.5, leg - radius - 0.5)
    body = decomp.Block((0, 0, 0), (length, leg, thick), name="foot")
    body = body | decomp.Block((0, 0, 0), (length, thick, other), name="wall")
    return body - decomp.Cylinder((x, y, -1), (x, y, thick + 1), radius, name="bore")


def housing(rng: np.random.Generator) -> Solid:
    """An open box with a bore through one of its walls."""
    length, width, height, wall = rng.uniform([40, 30, 20, 2], [90, 60, 40, 6])
    radius = rng.uniform(1, 0.3 * (height - wall))
    x = rng.uniform(wall + radius + 1, length - wall - radius - 1)
    z = rng.uniform(wall + radius + 1, height - radius - 1)
    body = decomp.Block((0, 0, 0), (length, width, height), name="box")
    inner = (length - 2 * wall, width - 2 * wall, height)
    room = decomp.Block((wall, wall, wall), inner, name="room")
    return body - room - decomp.Cylinder((x, -1, z), (x, wall + 1, z), radius, name="bore")


FAMILIES = {"plate": plate, "angle": angle, "housing": housing}


def drawn(count: int, digits: int | None, turned: bool) -> Iterator[tuple[str, Make]]:
    """Parts of every family, their sizes rounded to some digits."""
    for family, make in FAMILIES.items():
        for seed in range(count):

            def one(make: Callable[..., Solid] = make, seed: int = seed) -> Solid:
                rng = np.random.default_rng(seed)
                solid = make(_Rounded(rng, digits))
                return solid.rotate(rng.normal(size=3), 360 * rng.random()) if turned else solid

            yield f"{family} {seed}", one


class _Rounded:
    """Uniform random numbers, rounded."""

    def __init__(self, rng: np.random.Generator, digits: int | None) -> None:
        self._rng, self._digits = rng, digits

    def uniform(self, low: Any, high: Any) -> Any:
        found = self._rng.uniform(low, high)
        return found if self._digits is None else np.round(found, self._digits)


def files(folders: list[Path]) -> Iterator[tuple[str, Make]]:
    """All models below some folders."""
    for folder in folders:
        for path in sorted(folder.rglob("*")):
            if path.suffix.removeprefix(".") in FORMATS:
                yield str(path), lambda path=path: path


def outcome(make: Make, meshes: str | None, limit: int) -> dict[str, Any]:
    """What becomes of a part in a process of its own, and its seconds."""
    reader, writer = os.pipe()
    start = time.perf_counter()
    pid = os.fork()
    if pid == 0:
        os.close(reader)
        resource.setrlimit(resource.RLIMIT_CPU, (limit, limit + 5))
        result = {"what": CERTIFIED, "why": ""}
        try:
            if meshes is None:
                decomp.skeleton(make())
            else:
                decomp.mesh(make(), cells=meshes)
        except decomp.DecompError as error:
            where = Path(error.__traceback__.tb_frame.f_code.co_filename).name
            trace = error.__traceback__
            while trace.tb_next is not None:
                trace = trace.tb_next
                where = Path(trace.tb_frame.f_code.co_filename).name
            result = {"what": REFUSED, "why": f"{type(error).__name__} in {where}: {error}"}
        except Exception as error:
            result = {"what": CRASHED, "why": repr(error)}
        os.write(writer, json.dumps(result).encode()[:60_000])
        os._exit(0)
    os.close(writer)
    with os.fdopen(reader, "rb") as pipe:
        said = pipe.read()
    _, _, used = os.wait4(pid, 0)
    found = json.loads(said) if said else {"what": STOPPED, "why": ""}
    seconds = used.ru_utime + used.ru_stime
    return {**found, "seconds": seconds, "clock": time.perf_counter() - start}


def main() -> None:
    """Run all parts and print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folders", nargs="*", type=Path, help="of models; by default own parts")
    parser.add_argument("--count", type=int, default=20, help="of own parts in each family")
    parser.add_argument("--digits", type=int, help="that sizes of own parts are rounded to")
    parser.add_argument("--turned", action="store_true", help="turn own parts at random")
    parser.add_argument("--mesh", choices=("skeleton", "none"), help="mesh, with such cells")
    parser.add_argument("--limit", type=int, default=120, help="seconds of computing for each")
    options = parser.parse_args()
    given = options.folders
    parts = files(given) if given else drawn(options.count, options.digits, options.turned)
    found: list[dict[str, Any]] = []
    for name, make in parts:
        each = outcome(make, options.mesh, options.limit)
        found.append(each)
        if each["what"] != CERTIFIED:
            print(f"{name}: {each['what']} {each['why'][:200]}", flush=True)
    if not found:
        sys.exit("there are no models")
    counts = Counter(each["what"] for each in found)
    for what, count in counts.most_common():
        print(f"{what:<12} {count:>5} of {len(found)}  {100 * count / len(found):.1f} %")
    good = [each["seconds"] for each in found if each["what"] == CERTIFIED]
    if good:
        print(f"seconds of computing: median {median(good):.2f}, most {max(good):.2f}")
    places = Counter(each["why"].split(":")[0] for each in found if each["why"])
    for place, count in places.most_common():
        print(f"{count:>5}  {place}")


if __name__ == "__main__":
    main()
