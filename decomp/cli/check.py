"""`decomp check`: whether a mesh file is a mesh of its model."""

from __future__ import annotations

import argparse
import json
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

from decomp.cli.arguments import input_path, positive
from decomp.cli.models import FILES, Around, add_outside, model_of
from decomp.cli.said import say
from decomp.errors import DecompError, InputError
from decomp.tolerance import OFF_VOLUMES, OUT_OF_CELLS

if TYPE_CHECKING:
    from decomp.checking.check import Checked


def register(commands: Any) -> None:
    """Add the subcommand to a parser."""
    parser: argparse.ArgumentParser = commands.add_parser(
        "check",
        help="verify a mesh file against its model",
        description="Verify a .msh file (Gmsh's format 4.1 or 2.2) against the CSG model that it "
        "is a mesh of: elements, faces, groups and their names, volumes, nodes on their exact "
        "surfaces, no tetrahedron across an interface. Each shortcoming is told in a line; if "
        "there is any, the exit code is 1.",
    )
    parser.add_argument("model", type=input_path, help=FILES)
    parser.add_argument("mesh", type=Path, help="Gmsh .msh")
    parser.add_argument(
        "--epsilon",
        type=positive,
        default=OUT_OF_CELLS,
        metavar="E",
        help="tetrahedra may reach 2 E into another cell, relative to the region's diagonal "
        f"(default {OUT_OF_CELLS:g})",
    )
    parser.add_argument(
        "--volume-error",
        type=positive,
        default=OFF_VOLUMES,
        metavar="E",
        help="of a region, relative, at most, besides what straight edges of their length leave "
        f"out at curved faces (default {OFF_VOLUMES:g})",
    )
    parser.add_argument(
        "--unprojected",
        type=int,
        default=0,
        metavar="N",
        help="so many nodes of faces, interfaces and sheets may be off their exact surfaces, as "
        "the report of `decomp mesh` counts them (default 0)",
    )
    parser.add_argument("--json", action="store_true", help="print everything as JSON")
    add_outside(parser)
    parser.set_defaults(run=run)


def run(options: argparse.Namespace) -> None:
    """Check, print, and fail if anything falls short.

    Raises:
        DecompError: the mesh falls short, or something cannot be read or computed.
    """
    from decomp.checking.check import check
    from decomp.cli.computing import reporting
    from decomp.files.format import suffixes
    from decomp.formats.table import FORMATS
    from decomp.ways.surfaces import surfaces_by

    if options.mesh.suffix.lower() in suffixes(FORMATS):
        raise InputError(f"{options.mesh} is a model: give the model first, then its mesh")
    with reporting(options.quiet) as tell:
        found = check(
            model_of(options.model, Around.of(options)),
            options.mesh,
            epsilon=options.epsilon,
            volume_error=options.volume_error,
            unprojected=options.unprojected,
            surfaces=surfaces_by("auto"),
            progress=tell,
        )
    if options.json:
        print(json.dumps(asdict(found), indent=1))
    elif not options.quiet:
        say(as_text(found, options.mesh))
    if found.shortcomings:
        count = len(found.shortcomings)
        ways = "way" if count == 1 else "ways"
        raise DecompError(f"{options.mesh} falls short of {options.model} in {count} {ways}")


def as_text(found: Checked, path: Path) -> list[str]:
    """What was found, as lines for people."""
    lines = [
        f"{path}: {found.tets} tetrahedra, {found.nodes} nodes, {found.groups} groups",
        f"  volumes of regions within {found.volume_error:.1e}; straight edges of their length "
        f"explain {found.chord_error:.1e}, {found.unexplained_error:.1e} is left",
        f"  nodes within {found.off_surface:.1e} of their exact surfaces, {found.stray} off them",
    ]
    lines += [f"  FAILS: {line}" for line in found.shortcomings]
    if not found.shortcomings:
        lines.append("  nothing falls short")
    return lines
