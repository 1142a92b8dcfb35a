"""`decomp info`: what is in a model."""

from __future__ import annotations

import argparse
import json
from collections import Counter
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from decomp.cli.arguments import input_path
from decomp.cli.models import FILES, Around, add_outside, model_of
from decomp.cli.printed import complain
from decomp.cli.said import say
from decomp.errors import DecompError
from decomp.places import digits_of

if TYPE_CHECKING:
    from decomp.boundary.topology import RegionBoundary
    from decomp.geometry import Geometry


def register(commands: Any) -> None:
    """Add the subcommand to a parser."""
    parser: argparse.ArgumentParser = commands.add_parser(
        "info",
        help="volume, area, faces, edges and vertices of each region",
        description="Print what is in a CSG model: for each region its volume, area, bounding "
        "box, Euler characteristic, faces, edges and vertices. Volume and area come from exact "
        "geometry by quadrature, with an estimate of the error.",
    )
    parser.add_argument(
        "models",
        type=input_path,
        nargs="+",
        metavar="MODEL",
        help=FILES,
    )
    parser.add_argument(
        "--json", action="store_true", help="print everything as JSON; of several models a list"
    )
    add_outside(parser)
    parser.set_defaults(run=run)


def run(options: argparse.Namespace) -> None:
    """Load, compute, print; of several models those that can be computed.

    Raises:
        DecompError: a model cannot be read, or is no solid; the others have been told of.
    """
    several = len(options.models) > 1
    found, failed = [], 0
    for path in options.models:
        try:
            result = _computed(path, options)
        except DecompError as error:
            if not several:
                raise
            complain(f"decomp: error: {error}")
            failed += 1
            continue
        if options.json:
            found.append(as_json(result))
        else:
            say([*as_text(result), *([""] if several else [])])
    if options.json:
        print(json.dumps(found if several else found[0], indent=1))
    if failed:
        raise DecompError(f"{failed} of {len(options.models)} models failed")


def _computed(path: Path, options: argparse.Namespace) -> Geometry:
    from decomp.cli.progress import working
    from decomp.geometry import Geometry

    with working(f"reading {path.name}", options.quiet):
        model = model_of(path, Around.of(options))
    with working(f"computing the boundary of {model.name}", options.quiet):
        return Geometry(model)


def as_json(result: Geometry) -> dict[str, Any]:
    """The model's contents as JSON values; lengths in the model's units."""
    model = result.model
    return {
        "model": model.name,
        "diagonal": result.diagonal,
        "regions": [
            _region_json(region, given.options)
            for region, given in zip(result.regions, model.regions, strict=True)
        ],
        "touching": [[result.regions[k].name for k in pair] for pair in result.boundaries.touching],
        "ignored": [{"statement": i.statement, "line": i.line} for i in model.ignored],
    }


def _region_json(region: RegionBoundary, options: Mapping[str, Any]) -> dict[str, Any]:
    names = [face.name for face in region.faces]
    return {
        "name": region.name,
        **({"options": dict(options)} if options else {}),
        "volume": region.volume,
        "volume_error": region.volume_error,
        "area": region.area,
        "area_error": region.area_error,
        "bbox": region.bounds.tolist(),
        "euler": region.euler,
        "touches": list(region.touches),
        "faces": [
            {
                "name": face.name,
                "carrier": region.carriers[face.carrier].kind,
                "area": face.area,
                **({"options": dict(face.options)} if face.options else {}),
            }
            for face in region.faces
        ],
        "edges": [
            {
                "faces": [names[k] for k in edge.faces],
                "curve": edge.curve.kind,
                "convexity": edge.convexity.value,
                "length": edge.length,
            }
            for edge in region.edges
        ],
        "vertices": [
            {
                "point": vertex.point.tolist(),
                "faces": [names[k] for k in vertex.faces],
                "convexity": vertex.convexity.value,
            }
            for vertex in region.vertices
        ],
    }


def as_text(result: Geometry) -> list[str]:
    """The model's contents as lines for people."""
    model = result.model
    lines = [f"model {model.name}: {_count(len(result.regions), 'region')}"]
    lines.append(f"  diagonal {result.diagonal:.9g}")
    for region, given in zip(result.regions, model.regions, strict=True):
        lines += ["", *_region_text(region, given.options)]
    if result.boundaries.touching:
        touching = result.boundaries.touching
        pairs = (" and ".join(result.regions[k].name for k in pair) for pair in touching)
        lines += ["", f"regions that touch: {', '.join(pairs)}"]
    if model.ignored:
        lines += ["", "ignored statements:"]
        lines += [f"  {entry}" for entry in model.ignored]
    return lines


def _region_text(region: RegionBoundary, options: Mapping[str, Any]) -> list[str]:
    digits = digits_of(float(abs(region.bounds).max()), region.diagonal, 9)
    low, high = (" ".join(f"{x + 0.0:.{digits}g}" for x in corner) for corner in region.bounds)
    lines = [
        f"region {region.name}",
        f"  volume  {region.volume:.12g}  (error below {region.volume_error:.1e})",
        f"  area    {region.area:.12g}  (error below {region.area_error:.1e})",
        f"  box     {low}  to  {high}",
        f"  Euler characteristic {region.euler}",
        *([f"  options {_options(options)}"] if options else []),
        f"  {_count(len(region.faces), 'face')}",
    ]
    width = max(len(face.name) for face in region.faces)
    carriers = [region.carriers[face.carrier].kind for face in region.faces]
    broad = max(8, *map(len, carriers))
    lines += [
        f"    {face.name:<{width}}  {kind:<{broad}}  area {face.area:.9g}"
        for face, kind in zip(region.faces, carriers, strict=True)
    ]
    shapes = Counter((e.curve.kind, e.convexity.value) for e in region.edges)
    lines.append(f"  {_count(len(region.edges), 'edge')}{_shapes(shapes)}")
    kinds = Counter(("", v.convexity.value) for v in region.vertices)
    plural = "vertex" if len(region.vertices) == 1 else "vertices"
    lines.append(f"  {len(region.vertices)} {plural}{_shapes(kinds)}")
    lines += [f"  no skeleton: {said}" for said in region.touches]
    return lines


def _options(options: Mapping[str, Any]) -> str:
    """As they are written: `maxh=3 material=steel`."""
    return " ".join(f"{key}={_value(value)}" for key, value in options.items())


def _value(value: Any) -> str:
    if isinstance(value, tuple):
        return f"({', '.join(f'{each:.9g}' for each in value)})"
    return f"{value:.9g}" if isinstance(value, float) else str(value)


def _shapes(counts: Counter[tuple[str, str]]) -> str:
    parts = [
        f"{count} {convexity} {kind}".rstrip()
        for (kind, convexity), count in sorted(counts.items())
    ]
    return f": {', '.join(parts)}" if parts else ""


def _count(number: int, noun: str) -> str:
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"
