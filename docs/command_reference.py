"""Writes docs/commands.md from the parsers of the code: `python docs/command_reference.py`."""

from __future__ import annotations

import argparse
import os
from pathlib import Path

PAGE = Path(__file__).parent / "commands.md"
WIDTH = 84
"""Columns of text that a page of the site shows beside its lists of contents."""


def reference() -> str:
    """The page: what each command says when it is asked for help."""
    from decomp.cli.main import parser

    before = os.environ.get("COLUMNS"), os.environ.get("NO_COLOR")
    os.environ.update(COLUMNS=str(WIDTH), NO_COLOR="1")
    try:
        whole = parser()
        lines = ["# Commands", "", "Made from the code by `docs/command_reference.py`.", ""]
        lines += ["```text", whole.format_help().rstrip(), "```", ""]
        for action in whole._actions:
            if isinstance(action, argparse._SubParsersAction):
                for name, command in action.choices.items():
                    text = command.format_help().rstrip()
                    lines += [f"## decomp {name}", "", "```text", text, "```", ""]
    finally:
        for key, value in zip(("COLUMNS", "NO_COLOR"), before, strict=True):
            if value is None:
                os.environ.pop(key, None)
            else:
                os.environ[key] = value
    return "\n".join(lines)


if __name__ == "__main__":
    PAGE.write_text(reference())
