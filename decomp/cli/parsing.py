"""How the command line is parsed, what its help looks like, and what it says of a misspelt one."""

from __future__ import annotations

import argparse
import shutil
from collections.abc import Sequence
from difflib import get_close_matches
from typing import Any, NoReturn

HELP_WIDTH = 80
"""Columns of help at most: longer lines are hard to read."""
MISUSED = 2
"""Exit code where the command line is wrong."""
OPTION_LIKE = 0.75
"""How like an option a misspelt one has to be, from 0 to 1, to be taken for it."""


class Parser(argparse.ArgumentParser):
    """A parser whose help is at most `HELP_WIDTH` wide, and whose errors take two lines."""

    def __init__(self, *args: Any, **named: Any) -> None:
        super().__init__(*args, **{**named, "formatter_class": _Help})

    def parse_known_args(  # type: ignore[override]
        self, args: Sequence[str] | None = None, namespace: argparse.Namespace | None = None
    ) -> tuple[argparse.Namespace, list[str]]:
        """Parse, and refuse here what is unknown: a subcommand's parser knows its own options."""
        found, unknown = super().parse_known_args(args, namespace)
        if unknown:
            self.error(f"unrecognized arguments: {' '.join(unknown)}{self._near(unknown[0])}")
        return found, unknown

    def error(self, message: str) -> NoReturn:
        """Say what is wrong, and where to look."""
        self.exit(MISUSED, f"{self.prog}: error: {message}\nsee {self.prog} --help\n")

    def _near(self, word: str) -> str:
        """The option that may be meant."""
        name = word.split("=")[0]
        known = self._option_string_actions if name.startswith("--") else ()
        near = get_close_matches(name, known, 1, OPTION_LIKE)
        return f"; did you mean {near[0]}?" if near else ""


class _Help(argparse.HelpFormatter):
    """Descriptions are wrapped; examples, which have several lines, are left as they are."""

    def __init__(self, prog: str) -> None:
        super().__init__(prog, width=min(HELP_WIDTH, shutil.get_terminal_size().columns) - 2)

    def _fill_text(self, text: str, width: int, indent: str) -> str:
        if "\n" in text:
            return "".join(indent + line for line in text.splitlines(keepends=True))
        return super()._fill_text(text, width, indent)
