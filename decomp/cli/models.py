"""The model that a command is about: from a file, with the space around it if that is asked for."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from decomp.cli.arguments import positive

if TYPE_CHECKING:
    from decomp.csg.model import Model

SHAPES = ("ball", "box")
FILES = "Netgen .geo, OpenSCAD .csg or decomp .json; - or geo:- for stdin"


def add_outside(parser: argparse.ArgumentParser) -> None:
    """Add the options that ask for the space around the model."""
    group = parser.add_argument_group("the space around the model")
    group.add_argument(
        "--outside",
        type=_outside,
        metavar="SHAPE[:FACTOR]",
        help="add the region 'outside': what is left of a ball or box around the model, of FACTOR "
        "diagonals of it from the middle (default 2); its far faces are far.surface of a ball, "
        "far.xmin to far.zmax of a box",
    )
    group.add_argument(
        "--outside-only",
        action="store_true",
        help="leave the model's own regions out: they are holes",
    )


def model_of(options: argparse.Namespace, path: Path) -> Model:
    """The model in a file, with what the options ask for around it.

    Raises:
        InputError: `--outside-only` without `--outside`, or the model has such a region already.
        FileError: the file cannot be read.
        GeometryError: there is to be something around a model whose boundary cannot be computed.
    """
    from decomp.errors import InputError
    from decomp.formats import load

    if options.outside is None:
        if options.outside_only:
            raise InputError("--outside-only needs --outside ball or --outside box")
        return load(path)
    from decomp.outside import FACTOR, with_outside

    shape, factor = options.outside
    return with_outside(path, shape, factor or FACTOR, only=options.outside_only)


def _outside(text: str) -> tuple[str, float | None]:
    shape, colon, rest = text.partition(":")
    if shape not in SHAPES:
        raise argparse.ArgumentTypeError(f"must be ball or box, got {shape!r}")
    return shape, positive(rest) if colon else None
