"""`decomp describe`: a table of a model's sheets and what surface each of them lies on."""

from __future__ import annotations

import argparse
import json
from collections import Counter
from typing import TYPE_CHECKING, Any

from decomp.cli.said import say

if TYPE_CHECKING:
    from decomp.skeletons.model import RegionSkeleton, Skeleton


def register(commands: Any) -> None:
    """Add the subcommand to a parser."""
    from decomp.cli.computing import add_options

    parser: argparse.ArgumentParser = commands.add_parser(
        "describe",
        help="what surface every sheet of the skeleton lies on, with its equation",
        description="Compute the interior skeleton of a CSG model and print a table of its "
        "sheets: sites, parity, kind of surface, area, least and greatest distance to the "
        "boundary, equation.",
    )
    add_options(parser)
    parser.add_argument("--json", action="store_true", help="print everything as JSON")
    parser.add_argument(
        "--digits", type=int, default=6, help="of the equations' coefficients (default 6)"
    )
    parser.set_defaults(run=run)


def run(options: argparse.Namespace) -> None:
    """Compute, print."""
    from decomp.cli.computing import computed
    from decomp.errors import InputError
    from decomp.skeletons.files.as_json import counted_from

    if not 1 <= options.digits <= 17:
        raise InputError(f"--digits must be from 1 to 17, not {options.digits}")
    skeleton = computed(options)
    rows = [
        sheet_rows(skeleton, region, options.digits, first)
        for region, first in zip(skeleton.regions, _first_sheets(skeleton), strict=True)
    ]
    if options.json:
        regions = [
            {
                "name": region.name,
                "method": region.method.value,
                "cause": region.cause,
                "sheets": own,
            }
            for region, own in zip(skeleton.regions, rows, strict=True)
        ]
        head = {"model": skeleton.name, **counted_from(skeleton)}
        print(json.dumps({**head, "regions": regions}, indent=1))
    else:
        say(as_text(skeleton, rows))


def _first_sheets(skeleton: Skeleton) -> list[int]:
    from decomp.skeletons.files.elements import first_sheets

    return list(first_sheets(skeleton))


def sheet_rows(
    skeleton: Skeleton, region: RegionSkeleton, digits: int, first: int = 0
) -> list[dict[str, Any]]:
    """Each sheet of a region as JSON values; lengths in the model's units, angles in radians."""
    from decomp.skeletons.files.labels import site_labels
    from decomp.skeletons.files.surfaces import surface_values

    labels = site_labels(skeleton.sites)
    return [
        {
            "id": first + k,
            "sites": [labels[site] for site in sheet.sites],
            "parity": None if sheet.parity is None else sheet.parity.value,
            "area": sheet.area,
            "radius": list(sheet.radius),
            **surface_values(skeleton, region, sheet, digits),
        }
        for k, sheet in enumerate(region.sheets)
    ]


def as_text(skeleton: Skeleton, rows: list[list[dict[str, Any]]]) -> list[str]:
    """The tables as lines for people."""
    from decomp.cli.computing import method_text
    from decomp.places import MOST_DIGITS, triple

    lines = [f"model {skeleton.name}"]
    if skeleton.offset.any():
        origin = triple(skeleton.offset, MOST_DIGITS)
        lines.append(f"  x, y, z of equations are counted from {origin}")
    for region, own in zip(skeleton.regions, rows, strict=True):
        counts = Counter((row["kind"], row["degree"]) for row in own)
        lines += ["", f"region {region.name}: {len(own)} sheet{'' if len(own) == 1 else 's'}"]
        lines += method_text(region)
        table = [
            (
                str(row["id"]),
                " / ".join(row["sites"]),
                row["parity"] or "-",
                " + ".join(_kind(piece) for piece in (row, *row.get("also", ()))),
                f"{row['area']:.6g}",
                f"{row['radius'][0]:.4g} to {row['radius'][1]:.4g}",
                _short(row["equation"]) if row["equation"] else row.get("remark", "-"),
            )
            for row in own
        ]
        heads = ("sheet", "sites", "parity", "kind", "area", "radius", "equation")
        lines += _aligned([heads, *table])
        lines += [
            f"  {count:>4}  {kind}{'' if degree is None else f', degree {degree}'}"
            for (kind, degree), count in counts.most_common()
        ]
    return lines


def _kind(piece: dict[str, Any]) -> str:
    whole = piece.get("part_of")
    return str(piece["kind"] if whole is None else f"{piece['kind']} ({whole['kind']})")


def _aligned(table: list[tuple[str, ...]]) -> list[str]:
    widths = [max(len(row[k]) for row in table) for k in range(len(table[0]))]
    return [
        "  " + "  ".join(f"{cell:<{w}}" for cell, w in zip(row, widths, strict=True)).rstrip()
        for row in table
    ]


def _short(equation: str, most: int = 60) -> str:
    if len(equation) <= most:
        return equation
    return f"{equation.count(' + ') + equation.count(' - ') + 1} terms"
