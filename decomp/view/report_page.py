"""A report as a page (.html) that needs nothing else: tables, histograms of quality, times."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import astuple
from html import escape

import numpy as np

from decomp.drawing.colours import CATEGORIES
from decomp.tetra.mesh import TetMesh
from decomp.tetra.quality import dihedral_angles, radius_ratios
from decomp.tetra.report import Report
from decomp.vectors import Array

BINS, WIDE, HIGH, FOOT = 36, 560, 180, 22
STYLE = (
    "body{font:15px/1.45 system-ui,sans-serif;color:#222;max-width:60em;margin:2em auto;"
    "padding:0 1em}table{border-collapse:collapse;margin:.6em 0}"
    "th,td{padding:.2em .8em;border-bottom:1px solid #ccc;text-align:right}"
    "th:first-child,td:first-child{text-align:left;overflow-wrap:anywhere}"
    "figure{margin:1em 0}text{font-size:12px;fill:#222}"
)


def encoded(mesh: TetMesh, found: Report) -> bytes:
    """The contents of a file."""
    tets = mesh.tets[:, :4]
    least = dihedral_angles(mesh.points, tets).min(axis=1)
    ratio = radius_ratios(mesh.points, tets)
    quality = found.quality
    regions = [
        (each.name, each.tets, f"{each.volume:.9g}", _percent(each.error)) for each in found.regions
    ]
    cells = [(e.name, e.tets, f"{e.volume:.6g}", _percent(e.error)) for e in found.cells]
    surfaces = [(each.name, each.triangles) for each in found.surfaces]
    parted = [("all", found.edges), *((each.name, each.edges) for each in found.regions)]
    parted += [(each.name, each.edges) for each in found.surfaces]
    lengths = [
        (name, edges.number, *(_length(value) for value in astuple(edges)[1:]))
        for name, edges in parted
        if edges is not None
    ]
    stages = [(what, f"{seconds:.2f}") for what, seconds in found.stages]
    parts = [
        f"<h1>{escape(found.model)}</h1>",
        f"<p>{found.tets} tetrahedra of order {found.order}, {found.nodes} nodes, "
        f"{found.triangles} tagged triangles. Inverted: {quality.inverted}. Nodes left off their "
        f"exact surfaces: {found.unprojected}.</p>",
        "<h2>Quality</h2>",
        f"<p>Dihedral angles from {quality.least_dihedral:.1f} to "
        f"{quality.greatest_dihedral:.1f} degrees.</p>",
        histogram(least, 0, 75, "least dihedral angle of each tetrahedron, degrees"),
        histogram(ratio, 0, 1, "radius ratio 3 r / R, 1 for a regular tetrahedron"),
        "<h2>Regions</h2>",
        _table(("region", "tetrahedra", "volume", "off the exact one"), regions),
        "<h2>Lengths of edges</h2>",
        _table(
            ("in or on", "edges", "mean", "longest", "asked", "wanted in the mean"),
            lengths,
        ),
        "<h2>Cells</h2>",
        _table(("cell", "tetrahedra", "volume", "off the skeleton's"), cells),
        "<h2>Surfaces</h2>",
        _table(("surface", "triangles"), surfaces),
        *_ignored(found),
        "<h2>Times</h2>",
        _table(("stage", "seconds"), stages),
    ]
    head = (
        '<!DOCTYPE html><html lang="en"><head><meta charset="utf-8">'
        f'<link rel="icon" href="data:,"><title>{escape(found.model)} - decomp mesh</title>'
        f"<style>{STYLE}</style></head><body>"
    )
    return (head + "\n".join(parts) + "</body></html>\n").encode()


def histogram(values: Array, low: float, high: float, what: str) -> str:
    """Bars of how many values (n,) lie where from `low` to `high`, as an inline picture."""
    counts, _ = np.histogram(np.clip(values, low, high), BINS, (low, high))
    most, step = max(int(counts.max(initial=0)), 1), WIDE / BINS
    bars = "".join(
        f'<rect x="{k * step:.1f}" y="{HIGH * (1 - count / most):.1f}" width="{step - 1:.1f}" '
        f'height="{HIGH * count / most:.1f}" fill="{CATEGORIES[0]}"><title>{count}</title></rect>'
        for k, count in enumerate(counts.tolist())
    )
    marks = "".join(
        f'<text x="{WIDE * share:.0f}" y="{HIGH + 15}" text-anchor="{anchor}">'
        f"{low + share * (high - low):g}</text>"
        for share, anchor in ((0, "start"), (0.5, "middle"), (1, "end"))
    )
    return (
        f"<figure><figcaption>{what}; the highest bar is {most}</figcaption>"
        f'<svg viewBox="0 0 {WIDE} {HIGH + FOOT}" width="{WIDE}" role="img">{bars}'
        f'<line x1="0" y1="{HIGH}" x2="{WIDE}" y2="{HIGH}" stroke="#222"/>{marks}</svg></figure>'
    )


def _percent(error: float | None) -> str:
    return "" if error is None else f"{100 * error:+.3f} %"


def _ignored(found: Report) -> list[str]:
    """What was left out of the model's file, if anything was."""
    rows = [(each.line, each.statement) for each in found.ignored]
    return ["<h2>Ignored statements</h2>", _table(("line", "statement"), rows)] if rows else []


def _length(value: float | None) -> str:
    return "" if value is None else f"{value:.4g}"


def _table(head: Sequence[str], rows: Sequence[Sequence[object]]) -> str:
    def line(tag: str, values: Sequence[object]) -> str:
        return "<tr>" + "".join(f"<{tag}>{escape(str(v))}</{tag}>" for v in values) + "</tr>"

    return f"<table>{line('th', head)}{''.join(line('td', row) for row in rows)}</table>"
