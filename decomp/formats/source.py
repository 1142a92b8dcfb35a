"""The text of a model file, and errors that point into it."""

from __future__ import annotations

import re
from bisect import bisect_left
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from decomp.errors import ParseError, UnsupportedError


@dataclass(frozen=True)
class Source:
    """A model's text.

    Args:
        text: the text, lines ended by a newline character alone.
        path: the file it came from, if any.
    """

    text: str
    path: str | Path | None = None

    @cached_property
    def _breaks(self) -> list[int]:
        """Where the lines end."""
        return [found.start() for found in re.finditer("\n", self.text)]

    def line(self, position: int) -> int:
        """The 1-based line of a character."""
        return bisect_left(self._breaks, position) + 1

    def column(self, position: int) -> int:
        """The 1-based column of a character."""
        return position - self.text.rfind("\n", 0, position)

    def wrong(self, message: str, position: int) -> ParseError:
        """An error in the text at a character."""
        return ParseError(message, self.path, self.line(position), self.column(position))

    def unsupported(self, message: str, position: int) -> UnsupportedError:
        """An error for a construct that starts at a character."""
        return UnsupportedError(message, self.path, self.line(position), self.column(position))

    def line_of_text(self, start: int, end: int, longest: int = 120) -> str:
        """A stretch of the text, its blanks condensed, cut off where it is very long."""
        words = " ".join(self.text[start:end].split())
        return words if len(words) <= longest else words[: longest - 3].rstrip() + "..."
