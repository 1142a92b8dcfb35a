"""The meshes of all models that the tests know, each checked against its model and read by Gmsh.

Run: python -m benchmarks.mesh_table [--only NAME ...] [--limit 3600]

It writes docs/meshes.md: a row for each of the shared table of solids and of the Netgen files, made
with `decomp mesh` at its default size and verified with `decomp check`. A model that fails, or
takes longer than the limit, costs one row. With --only it prints the rows of some models and writes
nothing; with --add it makes these anew in the table that is there.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

import decomp
from benchmarks.skeleton_table import models
from decomp.carriers import Plane
from decomp.files.whole_file import write_whole
from decomp.meshing.repairs.shortening import LONGEST_EDGE

ROOT = Path(__file__).parents[1]
OUTPUT = ROOT / "docs" / "meshes.md"
LEAST, MEAN = 8.0, 45.0
VOLUME, SURFACE = 5e-3, 1e-12
UNMEASURED = " |  |  | "
"""In rows that are older than the columns of lengths."""
SHORT, LONG = 0.75, 1.05
"""The mean edge is at least the first of what was wanted, at most the second of what was asked."""

HEADINGS = (
    "model", "regions", "cells", "tets", "nodes", "seconds", "least dihedral", "mean of the least",
    "mean edge", "longest edge", "volume error", "off surface", "left off", "bridging",
    "groups in Gmsh", "check",
)  # fmt: skip

PREFACE = f"""\
# Meshes and their checks

Written by `python -m benchmarks.mesh_table`; do not edit. Each model is meshed with `decomp mesh`
at its default size, verified with `decomp check` and opened with Gmsh's library. `seconds` are the
report's, all stages together. `mean of the least` is the mean over the tetrahedra of their least
dihedral angle. `mean edge` and `longest edge` are in parts of the length asked for in a region or
on a face with a `-maxh`, the least and the greatest of all such; the longest may have
{LONGEST_EDGE:g}, the mean {LONG:g}, and no less than {SHORT:g} of the mean of what was wanted,
which is less than asked where curvature, thin places, neighbours or the chords on curved faces
want less. `off
surface` is the greatest distance of a boundary node from its surface, but for
those `left off`, which are counted; `bridging` are tetrahedra with all four corners on the
boundary. Required: no shortcoming in the check (nothing inverted, no face in three tetrahedra, no
tetrahedron in a cell that is not its own, every element in one group), angles of {LEAST:g} and
{MEAN:g} degrees (asked only of models that have none sharper than 20), volumes within
{VOLUME:g}, {SURFACE:g} off the surface (relative to the diagonal), nothing bridging where all faces
are plane. Figures that miss this are **bold**.

"""


def measured(name: str, limit: float) -> dict[str, Any]:
    """Mesh one model, check it, open it in Gmsh."""
    made = models()[name]
    with tempfile.TemporaryDirectory() as folder:
        model, mesh = Path(folder, "model.json"), Path(folder, "model.msh")
        report = Path(folder, "report.json")
        if isinstance(made, Path):
            model = made
        else:
            decomp.save(made, model)
        told = _decomp(limit, "mesh", str(model), "-o", str(mesh), "--report", str(report))
        if told.returncode:
            return {"error": _last(told)}
        found = json.loads(report.read_text())
        told = _decomp(limit, "check", str(model), str(mesh), "--json")
        if not told.stdout:  # a mesh that falls short is told of there, too
            return {"error": _last(told)}
        checked = json.loads(told.stdout)
        geometry = decomp.Geometry(made)
        return {
            **found,
            "off_surface": checked["off_surface"] / geometry.diagonal,
            "checked": checked,
            "groups": groups_in_gmsh(mesh),
            "plane": all(
                isinstance(carrier, Plane)
                for region in geometry.regions
                for carrier in region.carriers
            ),
        }


def _decomp(limit: float, *arguments: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "decomp", *arguments]
    return subprocess.run(
        command, capture_output=True, text=True, check=False, cwd=ROOT, timeout=limit
    )


def _last(told: subprocess.CompletedProcess[str]) -> str:
    """The last that a command said before it failed."""
    return (told.stderr.strip().splitlines() or [f"exit code {told.returncode}"])[-1]


def groups_in_gmsh(path: Path) -> tuple[int, int]:
    """How many physical groups Gmsh finds in a file, and how many of them have a name."""
    import gmsh

    gmsh.initialize(interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.open(str(path))
        groups = gmsh.model.getPhysicalGroups()
        return len(groups), sum(bool(gmsh.model.getPhysicalName(*group)) for group in groups)
    finally:
        gmsh.finalize()


def line_of(name: str, row: dict[str, Any]) -> str:
    """A model's row in Markdown."""
    if "error" in row:
        return f"| {name} | **{row['error'].replace('|', '/')}** |"
    quality, checked = row["quality"], row["checked"]
    short = checked["shortcomings"]
    groups, named = row["groups"]
    seconds = sum(stage["seconds"] for stage in row["stages"])

    def told(text: str, good: bool) -> str:
        return text if good else f"**{text}**"

    edges = [each["edges"] for each in (*row["regions"], *row["surfaces"]) if each["edges"]]
    means = sorted(each["mean"] / each["asked"] for each in edges)
    longest = max(each["longest"] / each["asked"] for each in edges)
    about = all(SHORT * e["wanted"] <= e["mean"] <= LONG * e["asked"] for e in edges)
    spread = " to ".join(dict.fromkeys(f"{value:.2f}" for value in (means[0], means[-1])))
    least, mean = quality["least_dihedral"], quality["mean_least_dihedral"]
    cells = [
        name,
        str(len(row["regions"])),
        str(len(row["cells"])),
        f"{row['tets']:,}",
        f"{row['nodes']:,}",
        f"{seconds:.0f}",
        told(f"{least:.1f}", least >= LEAST),
        told(f"{mean:.1f}", mean >= MEAN),
        told(spread, about),
        told(f"{longest:.2f}", longest <= LONGEST_EDGE),
        told(f"{checked['volume_error']:.1e}", checked["volume_error"] <= VOLUME),
        told(f"{row['off_surface']:.1e}", row["off_surface"] <= SURFACE),
        str(row["unprojected"]),
        told(str(row["bridging"]), not (row["plane"] and row["bridging"])),
        told(f"{named} of {groups}", named == groups == checked["groups"]),
        told("; ".join(short).replace("|", "/") if short else "clean", not short),
    ]
    return f"| {' | '.join(cells)} |"


def document(lines: dict[str, str]) -> str:
    """The whole of docs/meshes.md."""
    missing = [name for name in models() if name not in lines]
    text = PREFACE + f"{len(lines)} of {len(models())} models"
    text += f"; not made: {', '.join(missing)}.\n\n" if missing else ".\n\n"
    if any(UNMEASURED in line for line in lines.values()):
        text += "Rows without lengths of edges were made before these were measured and held.\n\n"
    text += f"| {' | '.join(HEADINGS)} |\n"
    text += "| --- |" + " ---: |" * (len(HEADINGS) - 2) + " --- |\n"
    return text + "\n".join(lines.values()) + "\n"


def lines_there() -> dict[str, str]:
    """The rows of the table that was written before."""
    if not OUTPUT.exists():
        return {}
    known = models()
    lines = OUTPUT.read_text(encoding="utf-8").splitlines()
    named = {line.split(" | ")[0].removeprefix("| "): line for line in lines}
    return {name: line for name, line in named.items() if name in known}


def main() -> int:
    """Mesh all, write the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--only", nargs="+", default=[], metavar="NAME", help="print these rows")
    parser.add_argument("--add", nargs="+", default=[], metavar="NAME", help="renew these rows")
    parser.add_argument("--limit", type=float, default=3600.0, help="seconds for one model")
    options = parser.parse_args()
    known = models()
    names = options.only or options.add or list(known)
    if unknown := set(names) - set(known):
        parser.error(f"unknown models: {', '.join(sorted(unknown))}")
    lines = lines_there() if options.add else {}
    for name in names:
        try:
            row = measured(name, options.limit)
        except subprocess.TimeoutExpired:
            row = {"error": f"not finished in {options.limit:g} seconds"}
        lines[name] = line_of(name, row)
        print(lines[name], flush=True)
        if not options.only:  # after each, so that an interrupted run leaves what it has
            write_whole(OUTPUT, document({n: lines[n] for n in known if n in lines}).encode())
    return 0


if __name__ == "__main__":
    sys.exit(main())
