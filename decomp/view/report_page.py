"""A report as a page (.html) that needs nothing else: a picture, figures, tables, the view.

What is asked for first is on the first two screens: figures, the picture, sizes, quality. The
view of `decomp view` is in it, and opens in the picture's place.
"""

from __future__ import annotations

import base64
import json
from dataclasses import astuple
from html import escape
from importlib.resources import files

from decomp.drawing import of_mesh, picture
from decomp.drawing.mesh_picture import LOOK
from decomp.meshes.edge_lengths import EdgeLengths
from decomp.meshes.model import TetMesh
from decomp.meshes.quality import dihedral_angles, radius_ratios
from decomp.meshes.report import Report
from decomp.view import page
from decomp.view.histogram import histogram
from decomp.view.reading import brought_near
from decomp.view.table import Entry, Figure, Link, table

ROWS_SEEN = 10
"""Rows of sizes that are seen at once; all are among the details."""
PERCENT = "{:+.3f} %"
LENGTHS = ("edges", "mean", "longest", "asked", "wanted in the mean")


def encoded(mesh: TetMesh, found: Report) -> bytes:
    """The contents of a file."""
    here = files("decomp.view")
    style, script = (
        (here / name).read_text(encoding="utf-8") for name in ("report.css", "report.js")
    )
    scene = brought_near(of_mesh.scene_of(mesh))
    image = base64.b64encode(picture.encoded(scene, LOOK)).decode()
    # no name can end the script that holds the page
    view = json.dumps(page.encoded(scene).decode()).replace("<", "\\u003c")
    title = escape(found.model)
    parts = [
        '<!DOCTYPE html><html lang="en"><head><meta charset="utf-8">'
        '<meta name="viewport" content="width=device-width, initial-scale=1">'
        f'<link rel="icon" href="data:,"><title>{title} - decomp mesh</title>'
        f"<style>{style}</style></head><body><h1>{title}</h1>",
        _figures(found),
        '<div class="two"><div id="view" hidden>'
        '<iframe id="frame" title="the mesh, to be turned and cut"></iframe></div>',
        '<button id="picture" type="button">'
        f'<img src="data:image/png;base64,{image}" alt="the rear half of the mesh" '
        f'width="{picture.PICTURE_WIDTH}" height="{picture.PICTURE_HEIGHT}">'
        "<span>turn it, cut it, search it</span></button>",
        f"<div>{_sizes(found)}{_quality(mesh)}</div></div>",
        *_details(found),
        f'<script type="application/json" id="page">{view}</script>',
        f"<script>{script}</script></body></html>",
    ]
    return ("\n".join(parts) + "\n").encode()


def _figures(found: Report) -> str:
    """The figures that tell whether all is well."""
    quality = found.quality
    seconds = sum(spent for _, spent in found.stages)
    listed = [
        (f"tetrahedra of order {found.order}", str(found.tets), False),
        ("nodes", str(found.nodes), False),
        ("tagged triangles", str(found.triangles), False),
        (
            "dihedral angles, degrees",
            f"{quality.least_dihedral:.1f} to {quality.greatest_dihedral:.1f}",
            False,
        ),
        ("least radius ratio", f"{quality.least_radius_ratio:.3f}", False),
        ("inverted", str(quality.inverted), quality.inverted > 0),
        ("nodes left off their exact surfaces", str(found.unprojected), found.unprojected > 0),
    ]
    if found.stages:
        listed.append(("seconds", f"{seconds:.1f}", False))
    items = "".join(
        f"<li class={'bad' if bad else 'good'}><b>{value}</b>{what}</li>"
        for what, value, bad in listed
    )
    return f'<ul class="figures">{items}</ul>'


def _sizes(found: Report) -> str:
    """The lengths of edges that were reached in all and in each region."""
    rows = _lengths(found)[:ROWS_SEEN]
    return "<h2>Sizes reached</h2>" + table(("in", *LENGTHS), rows)


def _lengths(found: Report) -> list[list[Entry]]:
    """Of all, of the regions, of the surfaces that ask for a length."""
    named: list[tuple[Entry, EdgeLengths | None]] = [("all", found.edges)]
    named += [(Link(each.name), each.edges) for each in found.regions]
    named += [(Link(each.name, each.kind), each.edges) for each in found.surfaces]
    return [
        [name, edges.number, *(Figure(value) for value in astuple(edges)[1:])]
        for name, edges in named
        if edges is not None
    ]


def _quality(mesh: TetMesh) -> str:
    tets = mesh.tets[:, :4]
    least = dihedral_angles(mesh.points, tets).min(axis=1)
    ratio = radius_ratios(mesh.points, tets)
    return (
        "<h2>Quality</h2>"
        + histogram(least, 0, 75, "least dihedral angle of each tetrahedron, degrees")
        + histogram(ratio, 0, 1, "radius ratio 3 r / R, 1 for a regular tetrahedron")
    )


def _details(found: Report) -> list[str]:
    """Tables that are opened one by one; regions are open."""
    regions: list[list[Entry]] = [
        [Link(r.name), r.tets, Figure(r.volume, "{:.9g}"), Figure(_percent(r.error), PERCENT)]
        for r in found.regions
    ]
    cells: list[list[Entry]] = [
        [
            Link(c.name, "cell"),
            c.tets,
            Figure(c.volume, "{:.6g}"),
            Figure(_percent(c.error), PERCENT),
        ]
        for c in found.cells
    ]
    surfaces: list[list[Entry]] = [
        [Link(s.name, s.kind), s.kind, s.triangles] for s in found.surfaces
    ]
    ignored: list[list[Entry]] = [[str(e.line or ""), e.statement] for e in found.ignored]
    stages: list[list[Entry]] = [[what, Figure(spent, "{:.2f}")] for what, spent in found.stages]
    lengths = _lengths(found)
    heads = ("tetrahedra", "volume")
    return [
        _detail("Regions", ("region", *heads, "off the exact one"), regions, is_open=True),
        _detail("Cells", ("cell", *heads, "off the skeleton's"), cells),
        _detail("Surfaces", ("surface", "kind", "triangles"), surfaces),
        _detail("Lengths of edges", ("in or on", *LENGTHS), lengths if lengths[ROWS_SEEN:] else []),
        _detail("Ignored statements", ("line", "statement"), ignored, is_open=True),
        _detail("Times", ("stage", "seconds"), stages),
    ]


def _detail(
    title: str, heads: tuple[str, ...], rows: list[list[Entry]], is_open: bool = False
) -> str:
    """A table under its title, with the number of its rows; nothing for none."""
    if not rows:
        return ""
    state = " open" if is_open else ""
    return f"<details{state}><summary>{title} ({len(rows)})</summary>{table(heads, rows)}</details>"


def _percent(error: float | None) -> float | None:
    return None if error is None else round(100 * error, 3) + 0.0  # no -0
