"""`decomp cells`: write the closed surface of every cell of a model."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any

from decomp.cli.said import say

if TYPE_CHECKING:
    from decomp.skeletons.model import Skeleton


def register(commands: Any) -> None:
    """Add the subcommand to a parser."""
    from decomp.cli.computing import add_options
    from decomp.files.format import told
    from decomp.skeletons.files.table import CELL_FORMATS

    parser: argparse.ArgumentParser = commands.add_parser(
        "cells",
        help="the closed surface of each cell that the skeleton cuts out",
        description="Cut every region of a CSG model along its skeleton and write each cell's "
        "closed surface into a directory, with an index.json that tells names, faces and volumes.",
    )
    add_options(parser)
    parser.add_argument(
        "-o",
        "--output",
        type=Path,
        required=True,
        metavar="DIR",
        help="directory to write to; it is made if it does not exist",
    )
    parser.add_argument(
        "--cells",
        choices=("skeleton", "face"),
        default="skeleton",
        help="skeleton: what the skeleton alone bounds (default); face: split further along trim "
        "surfaces, one cell for each face",
    )
    parser.add_argument(
        "--format",
        choices=[form.name for form in CELL_FORMATS],
        default=CELL_FORMATS[0].name,
        help=f"of the files: {told(CELL_FORMATS)} (default {CELL_FORMATS[0].name})",
    )
    parser.set_defaults(run=run)


def run(options: argparse.Namespace) -> None:
    """Check the directory, compute, write, print."""
    from decomp.cli.computing import computed
    from decomp.skeletons.files.cells import check_directory, write_cells

    check_directory(options.output, options.format, options.model)
    skeleton = computed(options)
    files = write_cells(skeleton, options.output, options.cells, options.format)
    if not options.quiet:
        say(as_text(skeleton, options, [file.name for file in files]))


def as_text(skeleton: Skeleton, options: argparse.Namespace, files: list[str]) -> list[str]:
    """The cells as lines for people."""
    from decomp.cli.computing import method_text

    cells = [
        cell
        for region in skeleton.regions
        for cell in (region.cells if options.cells == "skeleton" else region.face_cells)
    ]
    width = max(len(cell.name) for cell in cells)
    methods = [line for region in skeleton.regions for line in method_text(region)]
    lines = [f"{len(cells)} cell{'' if len(cells) == 1 else 's'} in {options.output}"]
    lines += [
        f"  {cell.name:<{width}}  volume {cell.volume:<14.9g}  {file}"
        for cell, file in zip(cells, files, strict=False)
    ]
    return lines + methods
