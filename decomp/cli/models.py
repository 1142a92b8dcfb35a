"""The model that a command is about: from a file, with the space around it if that is asked for."""

from __future__ import annotations

import argparse
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from decomp.cli.arguments import positive
from decomp.formats.table import FORMATS, listed

if TYPE_CHECKING:
    from decomp.csg.model import Model

SHAPES = ("ball", "box")
FILES = f"{listed()}; - or {FORMATS[0].name}:- for stdin"


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


@dataclass(frozen=True)
class Around:
    """The space around a model that is asked for.

    Args:
        shape: `ball` or `box`; None for nothing.
        factor: how far it reaches from the middle, in diagonals of the model; None for as usual.
        only: whether the model's own regions are left out.
    """

    shape: Literal["ball", "box"] | None = None
    factor: float | None = None
    only: bool = False

    @classmethod
    def of(cls, options: argparse.Namespace) -> Around:
        """What the options of `add_outside` ask for.

        Raises:
            InputError: `--outside-only` without `--outside`.
        """
        from decomp.errors import InputError

        if options.outside is None:
            if options.outside_only:
                raise InputError("--outside-only needs --outside ball or --outside box")
            return cls()
        shape, factor = options.outside
        return cls(shape, factor, options.outside_only)


def model_of(path: Path, around: Around) -> Model:
    """The model in a file, with what is asked for around it.

    Raises:
        InputError: the model has such a region already.
        FileError: the file cannot be read.
        GeometryError: there is to be something around a model whose boundary cannot be computed.
    """
    from decomp.formats import load

    if around.shape is None:
        return load(path)
    from decomp.outside import FACTOR, with_outside

    return with_outside(path, around.shape, around.factor or FACTOR, only=around.only)


def _outside(text: str) -> tuple[str, float | None]:
    shape, colon, rest = text.partition(":")
    if shape not in SHAPES:
        raise argparse.ArgumentTypeError(f"must be ball or box, got {shape!r}")
    return shape, positive(rest) if colon else None
