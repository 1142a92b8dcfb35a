"""Lengths of edges from the command line: by pattern and by place."""

from __future__ import annotations

import argparse

from decomp.cli.arguments import positive


def named_length(text: str) -> tuple[str, float]:
    """`PATTERN=H` as the two.

    Raises:
        argparse.ArgumentTypeError: it is none.
    """
    pattern, equals, length = text.rpartition("=")
    if not equals or not pattern.strip():
        raise argparse.ArgumentTypeError(f"must be PATTERN=H, not {text!r}")
    return pattern.strip(), positive(length)


def length_at(text: str) -> tuple[object, ...]:
    """`X,Y,Z=H`, `X,Y,Z,R=H` or `X,Y,Z,X,Y,Z=H` as `decomp.mesh` takes it.

    Raises:
        argparse.ArgumentTypeError: it is none of these.
    """
    where, equals, length = text.rpartition("=")
    try:
        numbers = [float(each) for each in where.split(",")]
    except ValueError:
        numbers = []
    if not equals or len(numbers) not in (3, 4, 6):
        raise argparse.ArgumentTypeError(
            f"must be X,Y,Z=H, X,Y,Z,R=H or X,Y,Z,X,Y,Z=H, not {text!r}"
        )
    first, rest = tuple(numbers[:3]), numbers[3:]
    if len(rest) == 3:
        return first, tuple(rest), positive(length)
    return (first, *rest, positive(length))
