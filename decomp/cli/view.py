"""`decomp view`: look at a model, a mesh or a skeleton."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING, Any

from decomp.cli.arguments import add_output
from decomp.cli.said import say

if TYPE_CHECKING:
    from decomp.view.scene import Scene

SUFFIXES = (".html", ".png")


def register(commands: Any) -> None:
    """Add the subcommand to a parser."""
    from decomp.cli.computing import add_options

    parser: argparse.ArgumentParser = commands.add_parser(
        "view",
        help="look at a model's skeleton and cells, a mesh, or a skeleton's file",
        description="Show a model (its skeleton, cells and faces), a mesh (.msh) or a skeleton "
        "(.vtu). Without -o a window opens, which needs pyvista; .html is a page that works "
        "without a network: turn, slice, explode, hide by name, hover for names.",
    )
    add_options(parser, "Netgen .geo, OpenSCAD .csg, decomp .json, .msh, or a skeleton's .vtu")
    add_output(parser, SUFFIXES)
    parser.set_defaults(run=run)


def run(options: argparse.Namespace) -> None:
    """Check the outputs, compute if need be, write or show."""
    from decomp.cli.computing import computed, method_text
    from decomp.files.suffixes import known_suffix
    from decomp.files.targets import check_outputs
    from decomp.files.whole_file import write_whole
    from decomp.view import image, page
    from decomp.view.reading import MODELS, scene_of

    suffixes = [known_suffix(path, SUFFIXES, "views") for path in options.output]
    check_outputs(options.output, [options.model])
    is_model = options.model.suffix.lower() in MODELS
    skeleton = computed(options) if is_model else None
    scene = scene_of(options.model, skeleton)
    for path, suffix in zip(options.output, suffixes, strict=True):
        encode = page.encoded if suffix == ".html" else image.encoded
        write_whole(path, encode(scene))
    if not options.output:
        show(scene)
    elif not options.quiet:
        regions = [] if skeleton is None else skeleton.regions
        say([f"written: {', '.join(str(path) for path in options.output)}"])
        say(line for region in regions for line in method_text(region))


def show(scene: Scene) -> None:
    """Open a window.

    Raises:
        MissingPackageError: pyvista is not installed.
    """
    from decomp.optional import needed
    from decomp.view.window import Window

    pyvista = needed("pyvista", "pyvista", "a window (-o view.html writes a page instead)")
    Window(scene, pyvista).plotter.show()
