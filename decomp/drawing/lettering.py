"""What is written into pictures: names beside their colours, how long a length is, directions."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import floor, log10

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from decomp.drawing.camera import Projection
from decomp.vectors import Array

INK = "#222222"
LETTERS, LEAST_LETTER = 48, 11
"""A letter's height as a part of the picture's, and the least in pixels."""
WIDEST_NAMES = 0.34
"""The greatest share of the picture's width that names take."""
FOOT_LETTERS = 5
"""Height of what is below the drawing, in letters."""
BAR = 0.22
"""The greatest share of the drawing's width that the bar of lengths takes."""


@dataclass(frozen=True)
class Layout:
    """Where a picture has what, in pixels.

    Args:
        width, height: of all.
        letter: height of letters.
        names: the names as they are written, with their colours.
        column: where the names begin, which is where the drawing ends.
        foot: the row where the drawing ends; the bar of lengths and directions are below.
    """

    width: int
    height: int
    letter: int
    names: tuple[tuple[str, str], ...]
    column: int
    foot: int

    @property
    def row(self) -> int:
        """Height of a line of names."""
        return round(1.5 * self.letter)


def layout(names: Sequence[tuple[str, str]], width: int, height: int) -> Layout:
    """Make room for names (with their colours), as many as fit, and for the bar below."""
    letter = max(LEAST_LETTER, height // LETTERS)
    font = ImageFont.load_default(letter)
    room = max(1, int((height - 2 * letter) / (1.5 * letter)))
    listed = list(names)
    if len(listed) > room:
        listed = [*listed[: room - 1], (f"and {len(listed) - room + 1} more", "")]
    space = WIDEST_NAMES * width - 4 * letter
    listed = [(_shortened(name, font, space), colour) for name, colour in listed]
    taken = max((font.getlength(name) for name, _ in listed), default=0.0)
    column = width - round(taken + 3.5 * letter) if listed else width
    return Layout(width, height, letter, tuple(listed), column, height - FOOT_LETTERS * letter)


def _shortened(name: str, font: ImageFont.FreeTypeFont | ImageFont.ImageFont, space: float) -> str:
    """A name without its middle, if it is too long."""
    if font.getlength(name) <= space:
        return name
    for count in range(len(name) - 1, 1, -1):
        short = f"{name[: count - count // 2]}...{name[len(name) - count // 2 :]}"
        if font.getlength(short) <= space:
            return short
    return name[:1] + "..."


def lettered(picture: Image.Image, place: Layout, projection: Projection) -> None:
    """Write all into a picture; the projection is in its pixels."""
    pen, font = ImageDraw.Draw(picture), ImageFont.load_default(place.letter)
    left = place.column + place.letter
    for k, (name, colour) in enumerate(place.names):
        top = place.letter + k * place.row
        if colour:
            box = (left, top, left + place.letter, top + place.letter)
            pen.rectangle(box, fill=colour, outline=INK)
        middle = top + place.letter // 2
        pen.text((left + 1.5 * place.letter, middle), name, fill=INK, font=font, anchor="lm")
    _bar(pen, font, place, projection.scale)
    _directions(pen, font, place, projection.axes)


def bar_length(most: float) -> float:
    """The greatest of 1, 2 and 5 times a power of ten that is not above `most`."""
    power = 10.0 ** floor(log10(most))
    return next(k * power for k in (5, 2, 1) if k * power <= most or k == 1)


def _bar(
    pen: ImageDraw.ImageDraw,
    font: ImageFont.FreeTypeFont | ImageFont.ImageFont,
    place: Layout,
    scale: float,
) -> None:
    """A bar as long as its number says, in units of the model."""
    length = bar_length(BAR * place.column / scale)
    thick = max(2, place.letter // 4)
    left, bottom = place.letter, place.height - place.letter
    right = left + round(length * scale)
    pen.rectangle((left, bottom - thick, right, bottom), fill=INK)
    middle = bottom - thick // 2
    pen.text((right + place.letter / 2, middle), f"{length:g}", fill=INK, font=font, anchor="lm")


def _directions(
    pen: ImageDraw.ImageDraw,
    font: ImageFont.FreeTypeFont | ImageFont.ImageFont,
    place: Layout,
    axes: Array,
) -> None:
    """Where x, y and z point to, in the lower right corner of the drawing."""
    reach = 1.5 * place.letter
    middle = np.array([place.column, place.height]) - FOOT_LETTERS / 2 * place.letter
    for k in np.argsort(axes[2], kind="stable").tolist():  # what comes nearer is drawn last
        way = axes[:2, k] * (1, -1)
        end, sign = middle + reach * way, middle + 1.35 * reach * way
        if np.linalg.norm(way) * reach < 0.5 * place.letter:
            continue  # it points to the eye, or away
        pen.line((*middle, *end), fill=INK, width=max(1, place.letter // 8))
        pen.text(tuple(sign), "xyz"[k], fill=INK, font=font, anchor="mm")
