"""From a model file to its skeleton, with signs of life, for the commands that need one."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from math import isfinite
from typing import TYPE_CHECKING

from decomp.cli.arguments import input_path
from decomp.cli.models import FILES, Around, add_outside, model_of
from decomp.plain import plain
from decomp.tolerance import CHORDS, COARSEST_CHORDS

if TYPE_CHECKING:
    from decomp.skeletons.model import RegionSkeleton, Skeleton


def add_options(parser: argparse.ArgumentParser, files: str = FILES) -> None:
    """The options that say which skeleton to compute, and how loudly."""
    parser.add_argument("model", type=input_path, help=files)
    parser.add_argument(
        "--tolerance",
        type=_tolerance,
        default=CHORDS,
        metavar="T",
        help="largest distance of a triangle from its exact surface, relative to the model's "
        f"diagonal (default {CHORDS:g})",
    )
    add_method(parser)
    add_outside(parser)


def add_method(parser: argparse.ArgumentParser | argparse._ArgumentGroup) -> None:
    """The option that says how skeletons are found."""
    parser.add_argument(
        "--method",
        choices=("auto", "traced", "sampled"),
        default="traced",
        help="how the skeleton is found: traced curve by curve (default); sampled, as walls "
        "between points with different nearest sites, placed exactly, which many parts with "
        "junctions close together do not hold; auto: traced, and the regions "
        "sampled where that fails",
    )


def computed(options: argparse.Namespace) -> Skeleton:
    """Load the model and compute its skeleton.

    Raises:
        DecompError: the model cannot be read, is no solid, or its skeleton cannot be certified.
    """
    from decomp.geometry import Geometry
    from decomp.ways.skeleton import skeleton

    with reporting(options.quiet) as report:
        report(f"reading {options.model.name}", 0.0)
        model = model_of(options.model, Around.of(options))
        report(f"computing the boundary of {model.name}", 0.0)
        geometry = Geometry(model)
        return skeleton(geometry, options.tolerance, report, options.method)


def method_text(region: RegionSkeleton) -> list[str]:
    """How a region's skeleton was found, and why it was not traced; nothing of one that was."""
    from decomp.skeletons.model import Method

    if region.method is Method.TRACED:
        return []
    why = "" if region.cause is None else f": tracing failed, as {region.cause}"
    return [f"  method     {region.method.value:>7}{why}"]


@contextmanager
def reporting(quiet: bool) -> Iterator[Callable[[str, float], None]]:
    """A bar on stderr; yields what to tell it: a text, and which part (0 to 1) is done.

    There is silence where stderr is no terminal.
    """
    if quiet or not sys.stderr.isatty():
        yield lambda what, done: None
        return
    from rich.console import Console
    from rich.progress import BarColumn, Progress, SpinnerColumn, TextColumn, TimeElapsedColumn

    columns = (
        SpinnerColumn(),
        TextColumn("{task.description}", markup=False),
        BarColumn(),
        TimeElapsedColumn(),
    )
    with Progress(*columns, console=Console(stderr=True), transient=True) as progress:
        task = progress.add_task("", total=1.0)

        def report(what: str, done: float) -> None:
            progress.update(task, description=plain(what), completed=done)

        yield report


def _tolerance(text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r} is no number") from None
    if not isfinite(value) or not 0 < value <= COARSEST_CHORDS:
        raise argparse.ArgumentTypeError(
            f"must be above 0 and at most {COARSEST_CHORDS:g}, not {text}"
        )
    return value
