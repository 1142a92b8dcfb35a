"""`decomp convert`: read a model in any format, write it in decomp's own."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any


def register(commands: Any) -> None:
    """Add the subcommand to a parser."""
    parser: argparse.ArgumentParser = commands.add_parser(
        "convert",
        help="write a model in decomp's own JSON form",
        description="Read a CSG model and write it as decomp JSON, which keeps every model "
        "exactly: its tree, names, transforms and options.",
    )
    parser.add_argument("model", type=Path, help="Netgen .geo, OpenSCAD .csg or decomp .json")
    parser.add_argument("output", type=Path, help="file to write, ending in .json")
    parser.set_defaults(run=run)


def run(options: argparse.Namespace) -> None:
    """Check the output, load, save."""
    from decomp.formats import check_saving, load, save

    check_saving(options.output, options.model)
    save(load(options.model), options.output)
