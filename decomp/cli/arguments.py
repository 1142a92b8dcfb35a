"""Arguments that several commands have."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from math import isfinite
from pathlib import Path


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
        type=Path,
        action="append",
        default=[],
        metavar="OUT",
        help=f"file to write, ending in {', '.join(suffixes)}; may be given several times{more}",
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
