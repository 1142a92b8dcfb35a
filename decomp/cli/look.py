"""Options that say how a picture is taken."""

from __future__ import annotations

import argparse
import re
from collections.abc import Sequence
from math import isfinite
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from decomp.drawing.picture import Look

VIEWS = ("iso", "+x", "-x", "+y", "-y", "+z", "-z")
LEAST_PIXELS, MOST_PIXELS = 64, 8192
"""Pixels along a side of a picture."""


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add --camera, --clip and --size-px."""
    group = parser.add_argument_group("pictures (.png)")
    group.add_argument(
        "--camera",
        type=_camera,
        metavar="VIEW",
        help=f"where it is taken from: {', '.join(VIEWS)}, or the way from the model to the eye "
        "as X,Y,Z (default iso); write --camera=-y with the = before a minus",
    )
    group.add_argument(
        "--clip",
        type=_clip,
        metavar="AXIS[=AT]",
        help="cut it across x, y or z, there or in its middle, and leave away what is nearer to "
        "the eye",
    )
    group.add_argument(
        "--size-px",
        type=_size,
        metavar="WIDTHxHEIGHT",
        help="in pixels (default 1200x900)",
    )


def checked(options: argparse.Namespace, suffixes: Sequence[str]) -> Look:
    """How to take pictures.

    Raises:
        InputError: it is told, and there are none.
    """
    import numpy as np

    from decomp.drawing.picture import Look
    from decomp.errors import InputError

    given = {"eye": options.camera, "clip": options.clip, "size": options.size_px}
    if ".png" not in suffixes and any(value is not None for value in given.values()):
        raise InputError("--camera, --clip and --size-px are of pictures: give a .png with -o")
    look = {key: value for key, value in given.items() if value is not None}
    if "eye" in look:
        look["eye"] = np.array(look["eye"])
    if "size" in look:
        look["width"], look["height"] = look.pop("size")
    return Look(**look)


def _camera(text: str) -> tuple[float, float, float]:
    from decomp.drawing.camera import VIEWS as WAYS

    if text in WAYS:
        return WAYS[text]
    try:
        x, y, z = (float(part) for part in text.split(","))
    except ValueError:
        known = ", ".join(VIEWS)
        raise argparse.ArgumentTypeError(f"{text!r} is none of {known}, nor X,Y,Z") from None
    length = (x * x + y * y + z * z) ** 0.5
    if not isfinite(length) or length == 0:
        raise argparse.ArgumentTypeError(f"{text} tells no direction")
    return x / length, y / length, z / length


def _clip(text: str) -> object:
    from decomp.drawing.picture import Clip

    axis, equals, at = text.partition("=")
    if axis not in ("x", "y", "z"):
        raise argparse.ArgumentTypeError(f"{text!r} is no axis: x, y or z, such as y or y=2.5")
    if not equals:
        return Clip("xyz".index(axis))
    try:
        value = float(at)
    except ValueError:
        value = float("nan")
    if not isfinite(value):
        raise argparse.ArgumentTypeError(f"{at!r} is no number to cut {axis} at")
    return Clip("xyz".index(axis), value)


def _size(text: str) -> tuple[int, int]:
    found = re.fullmatch(r"(\d{1,5})x(\d{1,5})", text)
    if found is None:
        raise argparse.ArgumentTypeError(f"{text!r} is no size such as 1200x900")
    width, height = int(found[1]), int(found[2])
    if not all(LEAST_PIXELS <= side <= MOST_PIXELS for side in (width, height)):
        raise argparse.ArgumentTypeError(
            f"sides must be from {LEAST_PIXELS} to {MOST_PIXELS} pixels, not {text}"
        )
    return width, height
