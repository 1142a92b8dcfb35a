"""`decomp view`: look at a model, a mesh or a skeleton."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING, Any

from decomp.cli import look
from decomp.cli.arguments import add_output, are_streams
from decomp.cli.said import say
from decomp.errors import InputError
from decomp.files.format import Format, suffixes
from decomp.formats.table import listed

if TYPE_CHECKING:
    from decomp.drawing.scene import Scene

FORMATS = (
    Format("a page", (".html",), "decomp.view.page"),
    Format("a picture", (".png",), "decomp.drawing.picture"),
)


def register(commands: Any) -> None:
    """Add the subcommand to a parser."""
    from decomp.cli.computing import add_options
    from decomp.meshes.files.table import READ

    meshes = ", ".join(suffixes(READ))
    parser: argparse.ArgumentParser = commands.add_parser(
        "view",
        help="look at a model's skeleton and cells, a mesh, or a skeleton's file",
        description="Show a model (its skeleton, cells and faces), a mesh (.msh) or a skeleton "
        "(.vtu). Without -o a window opens, which needs pyvista; .html is a page that works "
        "without a network: turn, cut, explode, find by name, colour by any field; .png is a "
        "picture with names and a bar of lengths.",
    )
    add_options(parser, f"{listed(last=', ')}, {meshes}, or a skeleton's .vtu")
    add_output(parser, FORMATS)
    look.add_options(parser)
    parser.set_defaults(run=run)


def run(options: argparse.Namespace) -> None:
    """Check the outputs, compute if need be, write or show."""
    from decomp.cli.computing import computed, method_text
    from decomp.drawing import picture
    from decomp.files.suffixes import known_suffix
    from decomp.files.targets import check_outputs
    from decomp.files.whole_file import write_whole
    from decomp.view import page
    from decomp.view.reading import MODELS, scene_of

    given = [known_suffix(path, suffixes(FORMATS), "views") for path in options.output]
    taken = look.checked(options, given)
    check_outputs(options.output, [options.model])
    is_model = options.model.suffix.lower() in MODELS
    if not is_model and options.outside:
        raise InputError(f"--outside is for models; {options.model} is what was made of one")
    skeleton = computed(options) if is_model else None
    scene = scene_of(options.model, skeleton)
    for path, suffix in zip(options.output, given, strict=True):
        is_page = suffix == ".html"
        write_whole(path, page.encoded(scene) if is_page else picture.encoded(scene, taken))
    if not options.output:
        show(scene)
    elif not options.quiet:
        regions = [] if skeleton is None else skeleton.regions
        lines = [f"written: {', '.join(str(path) for path in options.output)}"]
        lines += [line for region in regions for line in method_text(region)]
        say(lines, to_errors=are_streams(options.output))


def show(scene: Scene) -> None:
    """Open a window.

    Raises:
        MissingPackageError: pyvista is not installed.
    """
    from decomp.optional import needed
    from decomp.view.window import Window

    pyvista = needed("pyvista", "pyvista", "a window (-o view.html writes a page instead)")
    Window(scene, pyvista).plotter.show()
