"""Arguments that several commands have."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from math import isfinite
from pathlib import Path

STDIN, STDOUT = Path("/dev/stdin"), Path("/dev/stdout")
"""What `-` stands for: a model to read, whose first words tell its format, or a file to write."""


def input_path(text: str) -> Path:
    """A file to read; `-` is stdin."""
    return STDIN if text == "-" else Path(text)


def output_path(text: str) -> Path:
    """A file to write; `-` is stdout."""
    return STDOUT if text == "-" else Path(text)


def add_output(parser: argparse.ArgumentParser, suffixes: Sequence[str], more: str = "") -> None:
    """Add -o, which may be given several times.

    Args:
        parser: of a command.
        suffixes: of the files that can be written.
        more: what else its help says.
    """
    parser.add_argument(
        "-o",
        "--output",
        type=output_path,
        action="append",
        default=[],
        metavar="OUT",
        help=f"file to write, ending in {', '.join(suffixes)}, or - for stdout ({suffixes[0]}); "
        f"may be given several times{more}",
    )


def positive(text: str) -> float:
    """A number above 0.

    Raises:
        argparse.ArgumentTypeError: it is none.
    """
    try:
        value = float(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r} is no number") from None
    if not isfinite(value) or value <= 0:
        raise argparse.ArgumentTypeError(f"must be above 0, not {text}")
    return value
