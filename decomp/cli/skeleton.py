"""`decomp skeleton`: compute a model's skeleton, tell what it has, write it to files."""

from __future__ import annotations

import argparse
import json
from dataclasses import fields
from typing import TYPE_CHECKING, Any

from decomp.cli.arguments import add_output, are_streams
from decomp.cli.said import say
from decomp.errors import InputError

if TYPE_CHECKING:
    from decomp.midsurfaces.facing import MidSurface
    from decomp.skeletons.model import Certificate, RegionSkeleton, Skeleton


def register(commands: Any) -> None:
    """Add the subcommand to a parser."""
    from decomp.cli.computing import add_options
    from decomp.files.format import told
    from decomp.midsurfaces import table as midsurfaces
    from decomp.skeletons.files.table import FORMATS

    parser: argparse.ArgumentParser = commands.add_parser(
        "skeleton",
        help="the exact interior skeleton (medial axis) of each region",
        description="Compute the interior skeleton of a CSG model: sheets, seams, junctions and "
        "reflexive curves, with a certificate of what was measured on it. Without -o it is only "
        "told what it has. With --facing, -o takes its mid-surface: the parts that lie between "
        "walls which face each other, with the thickness at every point.",
    )
    add_options(parser)
    add_output(parser, FORMATS, f"; with --facing {told(midsurfaces.FORMATS)}")
    parser.add_argument(
        "--facing",
        type=_angle,
        metavar="DEG",
        help="keep only what sees its two nearest boundary points more than DEG degrees apart "
        "(120 is usual), cut exactly there: the mid-surface of thin parts",
    )
    parser.add_argument("--boundary", action="store_true", help="write the boundary's faces too")
    parser.add_argument("--trims", action="store_true", help="write the trim surfaces too")
    parser.add_argument("--json", action="store_true", help="print everything as JSON")
    parser.add_argument(
        "--certificate", action="store_true", help="print every figure of the certificate"
    )
    parser.set_defaults(run=run)


def run(options: argparse.Namespace) -> None:
    """Check the outputs, compute, write, print."""
    from decomp.cli.computing import computed
    from decomp.files.targets import check_outputs
    from decomp.skeletons.files import form_of, write

    if options.json and are_streams(options.output):
        raise InputError("--json prints to stdout, where -o - writes the skeleton: leave one away")
    if options.facing is not None:
        _run_facing(options)
        return
    for path in options.output:
        form_of(path)
    check_outputs(options.output, [options.model])
    skeleton = computed(options)
    for path in options.output:
        write(skeleton, path, boundary=options.boundary, trims=options.trims)
    if options.json:
        from decomp.skeletons.files.as_json import contents

        print(json.dumps(contents(skeleton), indent=1))
    elif not options.quiet:
        lines = as_text(skeleton, options.tolerance, options.certificate)
        say(lines, to_errors=are_streams(options.output))


def _run_facing(options: argparse.Namespace) -> None:
    """The same for the mid-surface."""
    from decomp.cli.computing import computed
    from decomp.files.targets import check_outputs
    from decomp.midsurfaces.facing import mid_surface
    from decomp.midsurfaces.files import form_of

    for name in ("boundary", "trims", "json"):
        if getattr(options, name):
            raise InputError(f"--facing writes sheets alone; leave --{name} away")
    for path in options.output:
        form_of(path)
    check_outputs(options.output, [options.model])
    skeleton = computed(options)
    surface = mid_surface(skeleton, options.facing)
    for path in options.output:
        surface.write(path)
    if not options.quiet:
        lines = as_text(skeleton, options.tolerance, options.certificate)
        say([*lines, "", *mid_text(surface)], to_errors=are_streams(options.output))


def mid_text(surface: MidSurface) -> list[str]:
    """What a mid-surface has, as lines for people."""
    first = f"mid-surface, facing {surface.facing:g} degrees and more"
    if not len(surface.triangles):
        return [f"{first}: empty; no walls face each other so much"]
    low, high = surface.thickness.min(), surface.thickness.max()
    sheets = len(set(surface.sheet.tolist()))
    return [
        first,
        f"  sheets     {sheets:>7}  area {surface.area:.9g}",
        f"  triangles  {len(surface.triangles):>7}  points {len(surface.points)}",
        f"  thickness           {low:.9g} to {high:.9g}",
    ]


def as_text(skeleton: Skeleton, tolerance: float, figures: bool) -> list[str]:
    """What a skeleton has, as lines for people."""
    count = len(skeleton.regions)
    lines = [f"model {skeleton.name}: {count} region{'' if count == 1 else 's'}"]
    lines.append(f"  diagonal {skeleton.diagonal:.9g}")
    for region in skeleton.regions:
        lines += ["", *_region_text(region, tolerance, figures)]
    return lines


def _region_text(region: RegionSkeleton, tolerance: float, figures: bool) -> list[str]:
    from decomp.cli.computing import method_text

    curves = [locus for locus in region.reflexive if locus.dimension == 1]
    rows = [
        ("sheets", len(region.sheets), f"area {sum(s.area for s in region.sheets):.9g}"),
        ("seams", len(region.seams), f"length {sum(s.length for s in region.seams):.9g}"),
        ("junctions", len(region.junctions), ""),
        (
            "reflexive",
            len(region.reflexive),
            f"length {sum(locus.length for locus in curves):.9g}" if curves else "",
        ),
        ("cells", len(region.cells), f"volume {sum(c.volume for c in region.cells):.9g}"),
        ("Euler", region.certificate.euler, f"region {region.certificate.expected_euler}"),
    ]
    lines = [f"region {region.name}", *method_text(region)]
    lines += [f"  {name:<10} {number:>7}  {more}".rstrip() for name, number, more in rows]
    lines.append(f"  {_verdict(region.certificate, tolerance)}")
    if figures:
        lines += _figures(region.certificate, tolerance)
    return lines


def _verdict(certificate: Certificate, tolerance: float) -> str:
    from decomp.skeletons.certificate.certificate import shortcomings

    short = shortcomings(certificate, tolerance)
    if short:
        return f"certificate FAILS: {', '.join(short)}"
    return (
        f"certificate holds: residual {certificate.residual:.1e}, "
        f"chord error {certificate.chord_error:.1e}, coverage {certificate.coverage:.1e}"
    )


def _figures(certificate: Certificate, tolerance: float) -> list[str]:
    from decomp.skeletons.certificate.certificate import limits, shortcomings

    short = shortcomings(certificate, tolerance)
    most = limits(tolerance)
    lines = []
    for field in fields(certificate):
        name, value = field.name, getattr(certificate, field.name)
        line = f"    {name:<14} {value:>10.3g}"
        if name in most:
            line += f"  at most {most[name]:.3g}"
        elif name == "euler":
            line += f"  must be {certificate.expected_euler}"
        else:
            continue
        lines.append(line + ("  FAILS" if name in short else ""))
    return lines


def _angle(text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r} is no number") from None
    if not 0 <= value < 180:
        raise argparse.ArgumentTypeError(f"must be from 0 to less than 180, not {text}")
    return value
