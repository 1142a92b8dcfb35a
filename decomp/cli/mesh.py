"""`decomp mesh`: from a model file to a tagged mesh file."""

from __future__ import annotations

import argparse
import json
from collections.abc import Callable, Sequence
from contextlib import nullcontext
from pathlib import Path
from typing import TYPE_CHECKING, Any

from decomp.cli.arguments import add_output, are_streams, input_path, positive
from decomp.cli.groups import all_groups, named_patterns
from decomp.cli.models import add_outside, model_of
from decomp.cli.said import say
from decomp.cli.sizes import length_at, named_length

if TYPE_CHECKING:
    from decomp.meshes.model import TetMesh
    from decomp.meshes.report import Report

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
    from decomp.meshes.files import SUFFIXES

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
        help="Netgen .geo, OpenSCAD .csg or decomp .json; of several, -o names a directory",
    )
    add_output(parser, SUFFIXES, " (default: the model's name with .msh, in this directory)")
    parser.add_argument(
        "--jobs", type=_count, metavar="N", help="of several models, N at a time (default 1)"
    )
    parser.add_argument(
        "--format",
        choices=[suffix[1:] for suffix in SUFFIXES],
        help="of several models: what is written (default msh)",
    )
    _size_options(parser)
    _tag_options(parser)
    _file_options(parser)
    add_outside(parser)
    parser.set_defaults(run=run)


def _size_options(parser: argparse.ArgumentParser) -> None:
    group = parser.add_argument_group("size of elements")
    group.add_argument(
        "--size",
        type=positive,
        metavar="H",
        help="length of edges, in model units: none is longer than 1.5 H, and where nothing asks "
        "for shorter ones they are 0.75 to 1.05 H in the mean (default: from the model)",
    )
    group.add_argument(
        "--maxh",
        dest="sizes",
        type=named_length,
        action="append",
        default=[],
        metavar="PATTERN=H",
        help="length of edges in regions, or at most on faces, that a pattern stands for, such as "
        "'*/bolt*.side=0.5'; may be given several times, the last that fits counts",
    )
    group.add_argument(
        "--size-at",
        type=length_at,
        action="append",
        default=[],
        metavar="X,Y,Z[,R]=H",
        help="length of edges at most at a point, in the ball of radius R about it, or in a box: "
        "X,Y,Z,X,Y,Z=H; may be given several times",
    )
    group.add_argument(
        "--outside-size",
        type=positive,
        metavar="H",
        help="length of edges at the end of what --outside adds; from the model outwards they grow",
    )
    group.add_argument(
        "--layers",
        type=_count,
        metavar="N",
        help="at least N elements across the local thickness",
    )
    group.add_argument(
        "--circle",
        type=positive,
        metavar="N",
        help="at least N elements around a full circle",
    )
    group.add_argument(
        "--order",
        type=int,
        choices=(1, 2),
        default=1,
        help="2: 10-node tetrahedra with curved sides (default 1)",
    )


def _tag_options(parser: argparse.ArgumentParser) -> None:
    from decomp.cli.computing import add_method

    group = parser.add_argument_group("physical groups")
    group.add_argument(
        "--cells",
        choices=("skeleton", "face", "none"),
        default="skeleton",
        help="skeleton: what the skeleton alone bounds (default); face: one cell for each face; "
        "none: regions, faces and interfaces alone, which needs no skeleton",
    )
    add_method(group)
    group.add_argument(
        "--volumes",
        choices=("regions", "cells", "materials"),
        default="regions",
        help="one volume for each region (default), for each cell, or for all regions with one "
        "-material and each without one",
    )
    group.add_argument(
        "--sheets",
        action=argparse.BooleanOptionalAction,
        default=False,
        help="triangles between the cells of a region as groups too (default: they are none)",
    )
    group.add_argument(
        "--group",
        dest="groups",
        type=named_patterns,
        action="append",
        default=[],
        metavar="NAME=PATTERN,...",
        help="one group for all faces, regions or edges that patterns stand for, such as "
        "'bolts=*/bolt*.side'; may be given several times",
    )
    group.add_argument(
        "--groups",
        dest="group_file",
        type=Path,
        metavar="FILE.toml",
        help='the same from a file: lines such as bolts = ["*/bolt*.side", "*/nut*.side"]',
    )
    group.add_argument(
        "--split-faces",
        action="store_true",
        help="pieces of one face (base.zmax, base.zmax@2) as groups of their own (default: one)",
    )
    group.add_argument(
        "--edges",
        action="store_true",
        help="edges and vertices as groups too, named by their faces: part/base.zmax&hole.side",
    )


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
        help="write values into .vtu and .msh: distance and thickness at nodes; nearest (surface), "
        "cell and region of tetrahedra",
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


def run(options: argparse.Namespace) -> None:
    """Check the outputs, mesh, write, print."""
    from decomp.errors import GeometryError, InputError
    from decomp.files.suffixes import known_suffix
    from decomp.files.targets import check_outputs
    from decomp.files.whole_file import write_whole
    from decomp.meshes.fields import checked_fields
    from decomp.meshes.files import suffix_of
    from decomp.meshes.report import as_json, as_text

    options.groups = all_groups(options.groups, options.group_file)
    several = len(options.models) > 1 or options.jobs or options.format
    if several or any(path.is_dir() for path in options.output):
        from decomp.cli import batch

        batch.run(options)
        return
    options.model = options.models[0]
    outputs = options.output or [_default(options.model)]
    suffixes = {suffix_of(path) for path in outputs}
    checked_fields(options.fields, with_cells=options.cells != "none")
    if options.fields and not suffixes & {".msh", ".vtu"}:
        raise InputError("--fields are written into .msh and .vtu files; give one with -o")
    more = ((options.report, ".json", "reports"), (options.html, ".html", "pages"))
    for path, suffix, what in more:
        if path is not None:
            known_suffix(path, (suffix,), what)
    others = [path for path, *_ in more if path is not None]
    check_outputs([*outputs, *others], [options.model, options.group_file])
    try:
        mesh, figures = meshed(options)
    except GeometryError as error:
        if options.report is not None:
            write_whole(options.report, _as_bytes({"failed": error.as_json()}))
        raise
    written(mesh, options, outputs)
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

    output = Path(f"{model.stem or 'model'}.msh")
    if same_file(output, model):
        load(model)
    return output


def written(mesh: TetMesh, options: argparse.Namespace, outputs: Sequence[Path]) -> None:
    """Write a mesh to files as the options say."""
    from decomp.meshes.files import write

    for path in outputs:
        write(mesh, path, text=options.ascii, version="2.2" if options.msh2 else "4.1")


def meshed(
    options: argparse.Namespace, told: Callable[[str, float], None] | None = None
) -> tuple[TetMesh, Report]:
    """Load the model and mesh it, with signs of life.

    Args:
        options: of the command.
        told: what is being done and how far it is; by default a bar on stderr is.

    Raises:
        DecompError: the model cannot be read, is no solid, or cannot be meshed.
    """
    from decomp.cli.computing import reporting
    from decomp.cli.stages import Stages
    from decomp.geometry import Geometry
    from decomp.meshes.report import report
    from decomp.ways.mesh import mesh

    with nullcontext(told) if told else reporting(options.quiet) as tell:
        stages = Stages(tell)
        stages("reading", 0.0)
        model = model_of(options, options.model)
        stages("boundary", 0.0)
        geometry = Geometry(model)
        made = mesh(
            geometry,
            size=options.size,
            sizes=_sizes(options),
            size_at=options.size_at,
            layers=options.layers,
            elements_per_circle=options.circle,
            order=options.order,
            cells=options.cells,
            volumes=options.volumes,
            sheets=options.sheets,
            groups=options.groups,
            split_faces=options.split_faces,
            edges=options.edges,
            fields=options.fields,
            timeout=options.timeout,
            progress=stages,
            method=options.method,
        )
        spent = stages.spent()
    return made, report(made, stages=spent, ignored=geometry.model.ignored)


def _sizes(options: argparse.Namespace) -> dict[str, float]:
    """Lengths by pattern.

    Raises:
        InputError: one is asked for what is not there.
    """
    from decomp.errors import InputError
    from decomp.outside import OUTSIDE

    sizes = dict(options.sizes)
    if options.outside_size is not None:
        if options.outside is None:
            raise InputError("--outside-size needs --outside ball or --outside box")
        sizes[OUTSIDE] = options.outside_size
    return sizes


def _count(text: str) -> int:
    try:
        value = int(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r} is no whole number") from None
    if value < 1:
        raise argparse.ArgumentTypeError(f"must be 1 or more, not {text}")
    return value
