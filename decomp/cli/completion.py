"""`decomp completion`: what a shell needs to complete commands, options and files."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from decomp.cli.arguments import input_path, output_path

SHELLS = ("bash", "zsh", "tcsh")

EXAMPLES = """\
examples:
  eval "$(decomp completion bash)"              in ~/.bashrc
  decomp completion zsh > ~/.zfunc/_decomp      with fpath+=~/.zfunc in ~/.zshrc
"""


def register(commands: Any) -> None:
    """Add the subcommand to a parser."""
    parser: argparse.ArgumentParser = commands.add_parser(
        "completion",
        help="print what a shell needs to complete this command line",
        description="Print a script that has a shell complete commands, options, choices and "
        "names of files.",
        epilog=EXAMPLES,
    )
    parser.add_argument("shell", choices=SHELLS, help="which it is for")
    parser.set_defaults(run=run)


def run(options: argparse.Namespace) -> None:
    """Print the script."""
    import shtab

    _complete_files(options.whole)
    print(shtab.complete(options.whole, options.shell))


def _complete_files(parser: argparse.ArgumentParser) -> None:
    """Have arguments that are paths completed as names of files."""
    import shtab

    for action in parser._actions:
        if isinstance(action, argparse._SubParsersAction):
            for command in action.choices.values():
                _complete_files(command)
        elif action.type in (Path, input_path, output_path):
            action.complete = shtab.FILE  # type: ignore[attr-defined]
