"""Arguments that several commands have."""

from __future__ import annotations

import argparse
import re
from collections.abc import Sequence
from math import isfinite
from pathlib import Path, PosixPath

from decomp.files.format import Format, told


class Stream(PosixPath):
    """A stream of this process whose format is named, which its path does not tell."""

    named = ""

    @property
    def suffix(self) -> str:
        """That of a file of its format; empty if none is named."""
        return self.named


def input_path(text: str) -> Path:
    """A file to read; `-` is stdin, `geo:-` stdin in that format."""
    return _stream(text, "/dev/stdin") or Path(text)


def output_path(text: str) -> Path:
    """A file to write; `-` is stdout, `vtu:-` stdout in that format."""
    return _stream(text, "/dev/stdout") or Path(text)


def _stream(text: str, path: str) -> Stream | None:
    found = re.fullmatch(r"(?:(\w+):)?-", text)
    if found is None:
        return None
    stream = Stream(path)
    stream.named = f".{found[1]}" if found[1] else ""
    return stream


def are_streams(paths: Sequence[Path]) -> bool:
    """Whether some are stdin or stdout; where a file is written to that, nothing else may be."""
    return any(isinstance(path, Stream) for path in paths)


def add_output(parser: argparse.ArgumentParser, formats: Sequence[Format], more: str = "") -> None:
    """Add -o, which may be given several times.

    Args:
        parser: of a command.
        formats: that can be written.
        more: what else its help says.
    """
    parser.add_argument(
        "-o",
        "--output",
        type=output_path,
        action="append",
        default=[],
        metavar="OUT",
        help=f"file to write, ending in {told(formats)}; - is stdout, "
        f"{formats[1].name}:- stdout in that format; may be given several times{more}",
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


def count(text: str) -> int:
    """A whole number from 1.

    Raises:
        argparse.ArgumentTypeError: it is none.
    """
    try:
        value = int(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r} is no whole number") from None
    if value < 1:
        raise argparse.ArgumentTypeError(f"must be 1 or more, not {text}")
    return value
