"""The options of `decomp mesh` that say what mesh is wanted, and their value."""

from __future__ import annotations

import argparse
from pathlib import Path

from decomp.cli.arguments import count, positive
from decomp.cli.groups import all_groups, named_patterns
from decomp.cli.sizes import length_at, named_length
from decomp.ways.options import MeshOptions

USUAL = MeshOptions()


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add all but the time limit, which stands with the files."""
    _size_options(parser)
    _tag_options(parser)


def mesh_options(options: argparse.Namespace) -> MeshOptions:
    """What the options ask for.

    Raises:
        InputError: a size is asked for what is not there.
        FileError: the file of groups cannot be read, or holds something else.
    """
    return MeshOptions(
        size=options.size,
        sizes=_sizes(options),
        size_at=options.size_at,
        layers=options.layers,
        elements_per_circle=options.circle,
        order=options.order,
        cells=options.cells,
        volumes=options.volumes,
        sheets=options.sheets,
        groups=all_groups(options.groups, options.group_file),
        split_faces=options.split_faces,
        edges=options.edges,
        fields=options.fields,
        timeout=options.timeout,
        method=options.method,
    )


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
        type=count,
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
        default=USUAL.order,
        help="2: 10-node tetrahedra with curved sides (default 1)",
    )


def _tag_options(parser: argparse.ArgumentParser) -> None:
    from decomp.cli.computing import add_method

    group = parser.add_argument_group("physical groups")
    group.add_argument(
        "--cells",
        choices=("skeleton", "face", "none"),
        default=USUAL.cells,
        help="skeleton: what the skeleton alone bounds (default); face: one cell for each face; "
        "none: regions, faces and interfaces alone, which needs no skeleton",
    )
    add_method(group)
    group.add_argument(
        "--volumes",
        choices=("regions", "cells", "materials"),
        default=USUAL.volumes,
        help="one volume for each region (default), for each cell, or for all regions with one "
        "-material and each without one",
    )
    group.add_argument(
        "--sheets",
        action=argparse.BooleanOptionalAction,
        default=USUAL.sheets,
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
