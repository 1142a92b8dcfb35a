"""The skeletons of all models that the tests know, with every figure of their certificates.

Run: python -m benchmarks.skeleton_table [--only NAME ...] [--balls 100000] [--limit 600]

It writes docs/skeletons.md: one row for each region of the shared table of solids and of the Netgen
files. Each model is computed in a process of its own, so that one that fails, or takes longer than
the limit, costs one row. With --only it prints the rows of some models and writes nothing.
"""

from __future__ import annotations

import argparse
import json
import resource
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

import decomp
from decomp.csg.solid import Solid
from decomp.errors import DecompError
from decomp.files.whole_file import write_whole
from decomp.skeletons.model import RegionSkeleton, Skeleton
from tests.corpus.files import FILES
from tests.solids import SOLIDS

ROOT = Path(__file__).parents[1]
OUTPUT = ROOT / "docs" / "skeletons.md"
TOLERANCE = 5e-4

HEADINGS = (
    "model", "region", "sheets", "seams", "junctions", "reflexive", "cells", "triangles",
    "seconds", "residual", "chord error", "flipped", "open cells", "volume error", "Euler",
    "intrusion", "coverage",
)  # fmt: skip

PREFACE = """\
# Skeletons and their certificates

Written by `python -m benchmarks.skeleton_table`; do not edit. Chord tolerance {tolerance:g} of the
diagonal. `triangles` are those of the sheets; `seconds` of CPU time are for the whole model, its
boundary and certificate included, compiled kernels at hand. Lengths are relative to the model's
diagonal, the volume error to the region's volume. Required: residual 1e-12, chord error
{tolerance:g}, nothing flipped or open, volume error 1e-3, Euler characteristic that of the region,
intrusion 1e-9, coverage {coverage:g} by {balls:,} maximal balls. Figures that miss this are
**bold**.

"""


def models() -> dict[str, Solid | Path]:
    """All models by name."""
    return {**{name: case.make() for name, case in SOLIDS.items()}, **FILES}


def measured(name: str, balls: int) -> list[dict[str, Any]]:
    """Compute one model: a row for each region, with coverage measured anew by many balls."""
    from decomp.skeletons.certificate.coverage import coverage
    from decomp.skeletons.certificate.evidence import Evidence
    from decomp.skeletons.compute import skeleton

    start = time.process_time()
    geometry = decomp.Geometry(models()[name])
    found = skeleton(geometry, TOLERANCE)
    seconds = time.process_time() - start
    rows = []
    for number, region in enumerate(found.regions):
        worst = coverage(Evidence.of(found, geometry.index, number), balls, seed=1)
        region = replace(region, certificate=replace(region.certificate, coverage=worst.value))
        rows.append({"seconds": seconds, **row_of(found, region)})
    return rows


def row_of(skeleton: Skeleton, region: RegionSkeleton) -> dict[str, Any]:
    """What is told of a region."""
    from decomp.skeletons.certificate.certificate import shortcomings

    patches = skeleton.complex.patches
    return {
        "region": region.name,
        "sheets": len(region.sheets),
        "seams": len(region.seams),
        "junctions": len(region.junctions),
        "reflexive": len(region.reflexive),
        "cells": len(region.cells),
        "triangles": sum(len(patches[sheet.patch].triangles) for sheet in region.sheets),
        "short": shortcomings(region.certificate, TOLERANCE),
        **asdict(region.certificate),
    }


def in_child(name: str, balls: int, limit: float) -> list[dict[str, Any]]:
    """The rows of a model computed in another process; of one that fails, a row that says why."""
    command = [sys.executable, "-m", "benchmarks.skeleton_table", "--one", name]
    command += ["--balls", str(balls)]
    start = time.perf_counter()
    command += ["--limit", str(limit)]
    done = subprocess.run(command, capture_output=True, text=True, check=False, cwd=ROOT)
    if done.returncode == -signal.SIGXCPU:
        return [{"error": f"not finished in {limit:g} CPU seconds", "seconds": limit}]
    if done.returncode == 0:
        rows: list[dict[str, Any]] = json.loads(done.stdout)
        return rows
    said = done.stderr.strip().splitlines() or [f"exit code {done.returncode}"]
    return [{"error": said[-1], "seconds": time.perf_counter() - start}]


def lines_of(name: str, rows: list[dict[str, Any]]) -> Iterator[str]:
    """A model's rows in Markdown."""
    for row in rows:
        if "error" in row:
            yield f"| {name} | **{row['error'].replace('|', '/')}** |"
            continue
        short = set(row["short"])

        def figure(key: str, form: str, row: Any = row, short: Any = short) -> str:
            text = format(row[key], form)
            return f"**{text}**" if key in short else text

        euler = f"{row['euler']} of {row['expected_euler']}"
        cells = [
            name,
            row["region"],
            *(str(row[key]) for key in HEADINGS[2:8]),
            format(row["seconds"], ".1f"),
            figure("residual", ".1e"),
            figure("chord_error", ".1e"),
            figure("flipped", "d"),
            figure("open_cells", "d"),
            figure("volume_error", ".1e"),
            f"**{euler}**" if "euler" in short else euler,
            figure("intrusion", ".1e"),
            figure("coverage", ".1e"),
        ]
        yield f"| {' | '.join(cells)} |"


def document(results: dict[str, list[dict[str, Any]]], balls: int, limit: float) -> str:
    """The whole of docs/skeletons.md."""
    rows = [row for found in results.values() for row in found]
    good = sum("error" not in row and not row["short"] for row in rows)
    failed = [name for name, found in results.items() if any("error" in row for row in found)]
    lines = [f"| {' | '.join(HEADINGS)} |"]
    lines.append("|" + " --- |" * 2 + " ---: |" * (len(HEADINGS) - 2))
    for name, found in results.items():
        if not any("error" in row for row in found):
            lines += lines_of(name, found)
    summary = (
        f"{len(results)} of {len(models())} models computed, each within {limit:g} CPU seconds; "
        f"{len(rows)} rows, {good} of them with all figures as required."
    )
    text = PREFACE.format(tolerance=TOLERANCE, coverage=2 * TOLERANCE, balls=balls)
    text += summary + "\n\n" + "\n".join(lines) + "\n"
    if failed:
        text += "\n## Models without a skeleton\n\n| model | why |\n| --- | --- |\n"
        text += "\n".join(line for name in failed for line in lines_of(name, results[name])) + "\n"
    return text


def main() -> int:
    """Compute all, write the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--only", nargs="+", default=[], metavar="NAME")
    parser.add_argument("--one", metavar="NAME", help=argparse.SUPPRESS)
    parser.add_argument("--balls", type=int, default=100_000)
    parser.add_argument("--limit", type=float, default=600.0, help="CPU seconds for one model")
    parser.add_argument("--jobs", type=int, default=1, help="models computed at the same time")
    options = parser.parse_args()
    if options.one:
        resource.setrlimit(resource.RLIMIT_CPU, (int(options.limit), int(options.limit) + 5))
        try:
            print(json.dumps(measured(options.one, options.balls)))
        except DecompError as error:
            print(f"{type(error).__name__}: {error}", file=sys.stderr)
            return error.exit_code
        return 0
    unknown = set(options.only) - set(models())
    if unknown:
        parser.error(f"unknown models: {', '.join(sorted(unknown))}")
    results: dict[str, list[dict[str, Any]]] = {}
    names = options.only or list(models())
    pool = ThreadPoolExecutor(options.jobs)
    for name, rows in zip(
        names, pool.map(lambda n: in_child(n, options.balls, options.limit), names), strict=True
    ):
        results[name] = rows
        print("\n".join(lines_of(name, results[name])), flush=True)
        if not options.only:  # after each, so that an interrupted run leaves what it has
            write_whole(OUTPUT, document(results, options.balls, options.limit).encode())
    return 0


if __name__ == "__main__":
    sys.exit(main())
