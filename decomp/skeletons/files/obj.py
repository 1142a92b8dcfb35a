"""Wavefront files (.obj): text, numbers with all their digits, one group for each sheet."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np

from decomp.plain import plain
from decomp.skeletons.files.elements import KINDS, Elements
from decomp.vectors import Array, Ints


def encoded(
    parts: Elements,
    at_points: Mapping[str, Array] | None = None,
    at_triangles: Mapping[str, Array] | None = None,
) -> bytes:
    """Triangles in groups, reflexive curves as lines, reflexive points as points.

    Args:
        parts: what the file holds.
        at_points, at_triangles: have no place here.
    """
    return "\n".join(["# made by decomp", *_vertices(parts.points), *_groups(parts), ""]).encode()


def surface(points: Array, triangles: Ints) -> bytes:
    """Points (n, 3) and triangles (m, 3) alone."""
    lines = ["# made by decomp", *_vertices(points), *_items("f", triangles), ""]
    return "\n".join(lines).encode()


def _vertices(points: Array) -> Iterator[str]:
    for x, y, z in points.tolist():
        yield f"v {x!r} {y!r} {z!r}"


def _groups(parts: Elements) -> Iterator[str]:
    count = len(parts.triangles)
    group = np.stack([parts.kind[:count], parts.sheet[:count]], axis=1)
    starts = np.flatnonzero(np.any(group[1:] != group[:-1], axis=1)) + 1
    for rows in np.split(np.arange(count), starts):
        if len(rows):
            kind, sheet = group[rows[0]]
            name = parts.sheet_names[sheet] if sheet >= 0 else KINDS[kind].replace(" ", "-")
            yield f"g {plain(name)}"
            yield from _items("f", parts.triangles[rows])
    curves = parts.kind[count : count + len(parts.segments)] == KINDS.index("reflexive")
    if curves.any() or len(parts.singles):
        yield "g reflexive"
        yield from _items("l", parts.segments[curves])
        yield from _items("p", parts.singles)


def _items(letter: str, corners: Ints) -> Iterator[str]:
    for row in (corners + 1).tolist():
        yield f"{letter} {' '.join(map(str, row))}"
