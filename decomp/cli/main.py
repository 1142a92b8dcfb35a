"""The command `decomp`: one subcommand per file, errors as one line, exit codes."""

from __future__ import annotations

import argparse
import signal
import sys
from collections.abc import Sequence
from contextlib import nullcontext
from typing import NoReturn

from decomp.cli import cells, check, completion, convert, describe, info, mesh, skeleton, view, warm
from decomp.cli.ending import EndedError, endings, leave
from decomp.cli.parsing import Parser
from decomp.cli.printed import ReaderGoneError, complain, printing
from decomp.errors import DecompError, GeometryError
from decomp.kernels.news import told_of_compiling
from decomp.meshing.backends.table import sweep

EXAMPLES = """\
examples:
  decomp mesh part.geo                  part.msh: a mesh with all names
  decomp check part.geo part.msh        whether a mesh is one of its model
  decomp info part.geo                  what is in a model: volume, faces, edges
  decomp info part.csg --json           the same for programs
  decomp convert part.geo part.json     from Netgen or OpenSCAD to decomp's form
  decomp skeleton part.geo -o part.vtu  its skeleton, for ParaView
  decomp describe part.geo              what surface every sheet of it lies on
  decomp cells part.geo -o cells        the cells that the skeleton cuts out
  decomp view part.geo -o part.html     a page to turn, slice and explode it
"""

INTERRUPTED = 130
COMMANDS = (mesh, check, info, skeleton, describe, cells, view, convert, warm, completion)


def parser() -> Parser:
    """The argument parser with all subcommands."""
    result = Parser(
        prog="decomp",
        description="Meshes, exact boundaries and skeletons of solids defined by constructive "
        "solid geometry (CSG).",
        epilog=EXAMPLES,
    )
    result.add_argument("--version", action="store_true", help="print the version and exit")
    result.set_defaults(whole=result)
    commands = result.add_subparsers(title="commands", metavar="COMMAND", dest="command")
    for module in COMMANDS:
        module.register(commands)
    for command in dict.fromkeys(commands.choices.values()):
        command.add_argument(
            "--quiet",
            action="store_true",
            help="no summary, no progress: say what was asked for, and errors",
        )
        command.add_argument(
            "--verbose",
            action="store_true",
            help="where a skeleton fails, tell of all that was tried",
        )
    return result


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line.

    Args:
        arguments: without the program's name; by default those of the process.

    Returns:
        0 on success, 1 to 4 for errors (see `decomp.errors`), 130 when interrupted, 128 + n when
        ended by signal n.
    """
    verbose = False
    try:
        with printing():
            options = parser().parse_args(arguments)
            verbose = getattr(options, "verbose", False)
            return _run(options)
    except DecompError as error:
        complain(f"decomp: error: {error}")
        if verbose and isinstance(error, GeometryError):
            for line in tried(error):
                complain(line)
        return error.exit_code
    except KeyboardInterrupt:
        complain("decomp: interrupted")
        return INTERRUPTED
    except EndedError as end:
        complain(f"decomp: ended by {end}")
        return end.exit_code
    except ReaderGoneError:
        return 0


def tried(error: GeometryError) -> list[str]:
    """Where an error arose, and all that was tried, a line each."""
    where = [f"in {error.stage}"] if error.stage else []
    where += [f"region {error.region}"] if error.region else []
    where += [f"at {' and '.join(error.sites)}"] if error.sites else []
    lines = [f"  {', '.join(where)}"] if where else []
    return lines + [f"  tried: {each.what}: {each.kind}: {each.error}" for each in error.tries]


def _run(options: argparse.Namespace) -> int:
    if options.version:
        from importlib.metadata import version

        print(version("decomp"))
        return 0
    if options.command is None:
        parser().print_help()
        return 2
    news = nullcontext() if options.quiet else told_of_compiling(_compiling)
    with endings(), news:
        sweep()
        options.run(options)
    return 0


def _compiling() -> None:
    complain("decomp: compiling kernels (once, a minute; `decomp warm` does it beforehand)")


def program() -> NoReturn:
    """Run the command line as a process, and end it."""
    code = main()
    if code >= INTERRUPTED - signal.SIGINT:
        leave(code)
    sys.exit(code)


if __name__ == "__main__":
    program()
