"""`decomp convert`: read a model in any format, write it in decomp's own."""

from __future__ import annotations

import argparse
from typing import Any

from decomp.cli.arguments import input_path, output_path
from decomp.cli.models import FILES, Around, add_outside, model_of
from decomp.files.format import told
from decomp.formats.table import WRITTEN


def register(commands: Any) -> None:
    """Add the subcommand to a parser."""
    parser: argparse.ArgumentParser = commands.add_parser(
        "convert",
        help="write a model in decomp's own JSON form",
        description="Read a CSG model and write it as decomp JSON, which keeps every model "
        "exactly: its tree, names, transforms and options.",
    )
    parser.add_argument("model", type=input_path, help=FILES)
    parser.add_argument(
        "output", type=output_path, help=f"file to write, ending in {told(WRITTEN)}, or -"
    )
    add_outside(parser)
    parser.set_defaults(run=run)


def run(options: argparse.Namespace) -> None:
    """Check the output, load, save."""
    from decomp.formats import check_saving, save

    check_saving(options.output, options.model)
    save(model_of(options.model, Around.of(options)), options.output)
