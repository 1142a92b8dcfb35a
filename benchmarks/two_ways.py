"""The traced skeletons and the sampled ones of all models that the tests know, side by side.

Run: python -m benchmarks.two_ways [--only NAME ...] [--limit 120]

Each is the other's check: they share exact queries and the certificate, not the way. Printed for
each model are the seconds of computing of both, the pairs of sites between which only one of them
has sheets, the largest difference of areas by pair (as a part of the sheets' whole area), and both
Euler characteristics. What a way refuses is told instead. Each runs in a process of its own.
"""

from __future__ import annotations

import argparse
import json
import os
import resource
from collections import Counter
from pathlib import Path
from typing import Any

import decomp
from decomp.csg.solid import Solid
from decomp.skeletons.model import Skeleton
from decomp.ways.skeleton import Method
from tests.corpus.files import FILES
from tests.solids import SOLIDS

SAME = 1e-2
"""Areas agree if they differ by no more than this part of the whole."""


def figures(found: Skeleton) -> dict[str, Any]:
    """What is compared: areas by pair of sites, and Euler characteristics."""
    areas: Counter[str] = Counter()
    for region in found.regions:
        for sheet in region.sheets:
            names = sorted(found.sites[k].name for k in sheet.sites)
            areas[f"{region.name}: {' and '.join(names)}"] += sheet.area  # type: ignore[assignment]
    return {"areas": areas, "euler": [region.certificate.euler for region in found.regions]}


def computed(source: Solid | Path, method: Method, limit: int) -> dict[str, Any]:
    """The figures of one way, or why there are none, and its seconds."""
    reader, writer = os.pipe()
    pid = os.fork()
    if pid == 0:
        os.close(reader)
        resource.setrlimit(resource.RLIMIT_CPU, (limit, limit + 5))
        try:
            result = figures(decomp.skeleton(source, method=method))
        except decomp.DecompError as error:
            result = {"refused": str(error)}
        os.write(writer, json.dumps(result).encode())
        os._exit(0)
    os.close(writer)
    with os.fdopen(reader, "rb") as pipe:
        said = pipe.read()
    _, _, used = os.wait4(pid, 0)
    found: dict[str, Any] = json.loads(said) if said else {"refused": "out of time"}
    return {**found, "seconds": used.ru_utime + used.ru_stime}


def compared(one: dict[str, Any], other: dict[str, Any]) -> str:
    """How two ways differ, in words; empty if they agree."""
    for name, each in (("traced", one), ("sampled", other)):
        if "refused" in each:
            return f"{name} refused: {each['refused'][:90]}"
    ours, theirs = one["areas"], other["areas"]
    odd = sorted(ours.keys() ^ theirs.keys())
    whole = sum(ours.values()) or 1.0
    off = max((abs(ours[k] - theirs[k]) for k in ours.keys() & theirs.keys()), default=0.0) / whole
    wrong = [f"only one way has {odd[0]} ({len(odd)} pairs)"] if odd else []
    wrong += [f"areas differ by {off:.1e}"] if off > SAME else []
    if one["euler"] != other["euler"]:
        wrong.append(f"Euler {one['euler']} and {other['euler']}")
    return "; ".join(wrong)


def main() -> None:
    """Compute all models in both ways and print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--only", nargs="*", help="names of models")
    parser.add_argument("--limit", type=int, default=120, help="seconds of computing for each way")
    options = parser.parse_args()
    every: dict[str, Solid | Path]
    every = {**{name: case.make() for name, case in SOLIDS.items()}, **FILES}
    counts: Counter[str] = Counter()
    for name in options.only or every:
        one, other = (
            computed(every[name], method, options.limit) for method in ("traced", "sampled")
        )
        said = compared(one, other)
        refused = "refused" in one or "refused" in other
        counts["refused" if refused else "differ" if said else "agree"] += 1
        seconds = f"{one['seconds']:6.1f} {other['seconds']:6.1f}"
        print(f"{name:<24} {seconds}  {said or 'agree'}", flush=True)
    print(", ".join(f"{what}: {count}" for what, count in counts.most_common()))


if __name__ == "__main__":
    main()
