"""`decomp warm`: have all kernels compiled beforehand, as when an image of a container is made."""

from __future__ import annotations

import argparse
import time
from typing import Any

from decomp.cli.said import say


def register(commands: Any) -> None:
    """Add the subcommand to a parser."""
    parser: argparse.ArgumentParser = commands.add_parser(
        "warm",
        help="compile the kernels now, which the first command does otherwise",
        description="Compile all numerical kernels, once for each installation, which "
        "takes about a minute. Without it the first command that needs them does so. They are kept "
        "beside the package or, where that is read-only, in the user's cache directory "
        "(NUMBA_CACHE_DIR names another).",
    )
    parser.set_defaults(run=run)


def run(options: argparse.Namespace) -> None:
    """Use every kernel on a small part."""
    from decomp.cli.computing import reporting

    start = time.perf_counter()
    with reporting(options.quiet) as tell:
        _use_all(tell)
    if not options.quiet:
        say([f"kernels compiled and kept: {time.perf_counter() - start:.1f} s"])


def _use_all(tell: Any) -> None:
    """Skeletons and a mesh of parts with every kind of carrier, edge and query; a picture of it."""
    from decomp.csg.primitives import Block, Cone, Cylinder, Sphere, Torus
    from decomp.geometry import Geometry
    from decomp.meshes.files import encoded, form_of
    from decomp.ways.mesh import mesh
    from decomp.ways.skeleton import skeleton

    block = Block((0, 0, 0), (8, 8, 4))
    bore = Cylinder((2, 2, -1), (2, 2, 5), 1)
    sink = Cone((6, 2, 2), 0.5, (6, 2, 5), 1.25)
    dent = Sphere((2, 6, 4.5), 1)
    groove = Torus((6, 6, 4), (0, 0, 1), 1, 0.25)
    step = Block((4, 4, 2), (5, 5, 3))
    cross = Cylinder((2, -1, 2), (2, 9, 2), 0.5)
    part = Geometry(block - bore - sink - dent - groove)
    drilled = Geometry(block - bore - cross - step)
    plate = Geometry(Block((0, 0, 0), (60, 40, 8)) - Cylinder((-1, 20, 4), (61, 20, 4), 2.5))
    for each in (part, drilled, plate):
        skeleton(each, 2e-3, tell)
    tell("meshing", 0.0)
    made = mesh(part, size=2, cells="none", progress=tell)
    tell("drawing", 1.0)
    encoded(made, form_of("warm.png"))
