"""Regions' parts put one behind the other into one complex; how finely their curves are sampled."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import TypeVar

from decomp.complex.model import Line, Patch, PatchKind
from decomp.skeletons.assembly import RegionParts
from decomp.skeletons.model import TrimSurface
from decomp.skeletons.sheets.drawn_sheets import CrossingError

FINER = 4.0
"""How much more finely curves are sampled where they cross."""
LEVELS = 5
"""How often at most they are sampled."""

Made = TypeVar("Made")


@dataclass(frozen=True, eq=False)
class Numbers:
    """Where one region's parts are in the complex.

    Args:
        sheets: the patch of each of its sheets.
        trims: its trim surfaces; their patch is -1 where they were left out.
        lines: the line of each of its parts' lines.
    """

    sheets: tuple[int, ...]
    trims: tuple[TrimSurface, ...]
    lines: tuple[int, ...]


class Joined:
    """The patches and lines of a complex to which regions' parts are added.

    Args:
        patches, lines: those that are there before.
        with_trims: whether trim surfaces are to be in the complex.

    Attributes:
        patches, lines: all so far, in order.
    """

    def __init__(self, patches: Iterable[Patch], lines: Iterable[Line], with_trims: bool) -> None:
        self.patches, self.lines = list(patches), list(lines)
        self._with_trims = with_trims

    def add(self, parts: RegionParts) -> Numbers:
        """Add a region's sheets and lines, and its trim surfaces if these are wanted."""
        first_sheet, first_line = len(self.patches), len(self.lines)
        self.patches += [Patch(PatchKind.SHEET, s.surface, s.triangles) for s in parts.sheets]
        self.lines += parts.lines
        trims = []
        for trim, patch in parts.trims:
            trims.append(TrimSurface(len(self.patches) if self._with_trims else -1, trim.faces))
            if self._with_trims:
                self.patches.append(patch)
        if self._with_trims:
            self.lines += parts.rulings
        sheets = range(first_sheet, first_sheet + len(parts.sheets))
        lines = range(first_line, first_line + len(parts.lines))
        return Numbers(tuple(sheets), tuple(trims), tuple(lines))


def fine_enough_to_part(draw: Callable[[float, int, bool], Made]) -> Made:
    """What is drawn with curves sampled so finely that they do not cross.

    A curve that is straight in space is bent in a footprint, where its chords may cross others.

    Args:
        draw: is given by what to divide the chord tolerance along curves, how many chords there are
            at least to every curve, and whether it will not be asked for finer ones.

    Raises:
        CrossingError: as the last call of `draw` does.
    """
    for level in range(LEVELS - 1):
        try:
            return draw(FINER**level, 2**level, False)
        except CrossingError:
            continue
    return draw(FINER ** (LEVELS - 1), 2 ** (LEVELS - 1), True)
