"""`decomp mesh`: from a model file to a tagged mesh file."""

from __future__ import annotations

import argparse
import json
from dataclasses import replace
from pathlib import Path
from typing import Any

from decomp.cli.arguments import add_output, are_streams, count, input_path, positive
from decomp.cli.mesh_job import MeshJob, done, written
from decomp.cli.mesh_options import add_options
from decomp.cli.models import add_outside
from decomp.cli.said import say

EXAMPLES = """\
examples:
  decomp mesh part.geo                        part.msh, sizes from the model
  decomp mesh part.geo -o part.vtu            for ParaView
  decomp mesh part.geo --size 2 --layers 3    edges of about 2, 3 across walls
  decomp mesh part.geo --order 2 -o part.inp  10-node tetrahedra for CalculiX
  decomp mesh part.geo --group 'bolts=*/bolt*.side' --group fixed=part/base.zmin
                                              names of your own for faces
  decomp mesh part.geo --volumes cells --sheets
                                              cells and sheets as groups too
  decomp mesh part.geo --cells none           without a skeleton: faces, regions
  decomp mesh *.geo -o meshes --jobs 2        many models, two at a time
  decomp mesh part.geo --report part.json     figures for programs too
"""


def register(commands: Any) -> None:
    """Add the subcommand to a parser."""
    from decomp.formats.table import listed
    from decomp.meshes.files.table import FORMATS

    parser: argparse.ArgumentParser = commands.add_parser(
        "mesh",
        help="a tetrahedral mesh with a name on every region, face and interface",
        description="Mesh a CSG model with tetrahedra that conform to its skeleton: every region, "
        "boundary face and interface is a physical group with a name, each tetrahedron knows its "
        "cell, and nodes lie on the exact surfaces.",
        epilog=EXAMPLES,
    )
    parser.add_argument(
        "models",
        type=input_path,
        nargs="+",
        metavar="MODEL",
        help=f"{listed()}; of several, -o names a directory",
    )
    usual = FORMATS[0].name
    add_output(parser, FORMATS, f" (default: the model's name with .{usual}, in this directory)")
    parser.add_argument(
        "--jobs", type=count, metavar="N", help="of several models, N at a time (default 1)"
    )
    parser.add_argument(
        "--format",
        choices=[form.name for form in FORMATS],
        help=f"of several models: what is written (default {usual})",
    )
    add_options(parser)
    _file_options(parser)
    add_outside(parser)
    parser.set_defaults(run=run)


def _file_options(parser: argparse.ArgumentParser) -> None:
    group = parser.add_argument_group("files and limits")
    kind = group.add_mutually_exclusive_group()
    kind.add_argument("--ascii", action="store_true", help=".msh 4.1 as text (default: binary)")
    kind.add_argument("--msh2", action="store_true", help=".msh in Gmsh's format 2.2, as text")
    group.add_argument(
        "--fields",
        type=lambda text: text.split(","),
        default=[],
        metavar="NAME,...",
        help=f"write values into {_with_fields()}: distance and thickness at nodes; nearest "
        "(surface), cell and region of tetrahedra",
    )
    group.add_argument(
        "--report", type=Path, metavar="FILE.json", help="write all figures to a JSON file"
    )
    group.add_argument(
        "--html",
        type=Path,
        metavar="FILE.html",
        help="write a page with a picture, tables, histograms of quality, and the view to turn "
        "and cut",
    )
    group.add_argument(
        "--timeout",
        type=positive,
        metavar="S",
        help="seconds that TetWild may take (default: 600 of computing, and more for very many "
        "tetrahedra)",
    )


def _with_fields() -> str:
    """The suffixes of formats that have values on the mesh."""
    from decomp.files.format import suffixes
    from decomp.meshes.files.table import FORMATS

    return " and ".join(suffixes([form for form in FORMATS if form.fields]))


def run(options: argparse.Namespace) -> None:
    """Check the outputs, mesh, write, print."""
    from decomp.cli.computing import reporting
    from decomp.errors import GeometryError, InputError
    from decomp.files.suffixes import known_suffix
    from decomp.files.targets import check_outputs
    from decomp.files.whole_file import write_whole
    from decomp.meshes.fields import checked_fields
    from decomp.meshes.files import form_of
    from decomp.meshes.report import as_json, as_text

    job = MeshJob.of(options)
    several = len(options.models) > 1 or options.jobs or options.format
    if several or any(path.is_dir() for path in options.output):
        from decomp.cli import batch

        batch.run(options, job)
        return
    outputs = options.output or [_default(job.model)]
    job, asked = replace(job, outputs=tuple(outputs)), job.options
    forms = [form_of(path) for path in outputs]
    checked_fields(asked.fields, with_cells=asked.with_cells)
    if asked.fields and not any(form.fields for form in forms):
        raise InputError(f"--fields are written into {_with_fields()} files; give one with -o")
    more = ((options.report, ".json", "reports"), (options.html, ".html", "pages"))
    for path, suffix, what in more:
        if path is not None:
            known_suffix(path, (suffix,), what)
    others = [path for path, *_ in more if path is not None]
    check_outputs([*outputs, *others], [job.model, options.group_file])
    try:
        with reporting(options.quiet) as tell:
            mesh, figures = done(job, tell)
    except GeometryError as error:
        if options.report is not None:
            write_whole(options.report, _as_bytes({"failed": error.as_json()}))
        raise
    written(mesh, job)
    if options.report is not None:
        write_whole(options.report, _as_bytes(as_json(figures)))
    if options.html is not None:
        from decomp.view import report_page

        write_whole(options.html, report_page.encoded(mesh, figures))
    if not options.quiet:
        lines = [*as_text(figures), f"  written: {', '.join(str(path) for path in outputs)}"]
        say(lines, to_errors=are_streams(outputs))


def _as_bytes(values: dict[str, Any]) -> bytes:
    return (json.dumps(values, indent=1, ensure_ascii=False) + "\n").encode()


def _default(model: Path) -> Path:
    """The file to write if none is named.

    Raises:
        DecompError: it is the model's own, and that is none: the user has given a mesh.
    """
    from decomp.files.targets import same_file
    from decomp.formats import load
    from decomp.meshes.files.table import FORMATS

    output = Path(f"{model.stem or 'model'}.{FORMATS[0].name}")
    if same_file(output, model):
        load(model)
    return output
