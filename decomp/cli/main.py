"""The command `decomp`: one subcommand per file, errors as one line, exit codes."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence

from decomp.cli import cells, check, convert, describe, info, mesh, skeleton, view
from decomp.cli.said import say
from decomp.errors import DecompError

EXAMPLES = """\
examples:
  decomp mesh part.geo                 part.msh: a mesh with a name on every cell and face
  decomp check part.geo part.msh       whether a mesh is one of its model
  decomp info part.geo                 what is in a model: volume, faces, edges
  decomp info part.csg --json          the same for programs
  decomp convert part.geo part.json    from Netgen or OpenSCAD to decomp's own form
  decomp skeleton part.geo -o part.vtu its skeleton, for ParaView
  decomp describe part.geo             what surface every sheet of it lies on
  decomp cells part.geo -o cells       the parts into which the skeleton cuts it
  decomp view part.geo -o part.html    a page to turn, slice and explode it
"""

INTERRUPTED = 130
COMMANDS = (mesh, check, info, skeleton, describe, cells, view, convert)


def parser() -> argparse.ArgumentParser:
    """The argument parser with all subcommands."""
    result = argparse.ArgumentParser(
        prog="decomp",
        description="Meshes, exact boundaries and skeletons of solids defined by constructive "
        "solid geometry (CSG).",
        epilog=EXAMPLES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    result.add_argument("--version", action="store_true", help="print the version and exit")
    commands = result.add_subparsers(title="commands", metavar="COMMAND", dest="command")
    for module in COMMANDS:
        module.register(commands)
    return result


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line.

    Args:
        arguments: without the program's name; by default those of the process.

    Returns:
        0 on success, 1 to 4 for errors (see `decomp.errors`), 130 when interrupted.
    """
    options = parser().parse_args(arguments)
    if options.version:
        from importlib.metadata import version

        print(version("decomp"))
        return 0
    if options.command is None:
        parser().print_help()
        return 2
    try:
        options.run(options)
    except DecompError as error:
        say([f"decomp: error: {error}"], to_errors=True)
        return error.exit_code
    except KeyboardInterrupt:
        print("decomp: interrupted", file=sys.stderr)
        return INTERRUPTED
    except BrokenPipeError:
        # the reader of our output has gone (as `head` does): nothing is left to say
        sys.stderr.close()
        return 0
    return 0


if __name__ == "__main__":
    sys.exit(main())
