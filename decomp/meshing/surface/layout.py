"""The skeleton's complex as the mesh needs it: which patches and lines part which cells."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from decomp.complex.model import Complex
from decomp.meshes.faces import TRIANGLE_EDGES
from decomp.meshing.surface.cells import CellMap
from decomp.meshing.surface.surface import MeshSurface
from decomp.vectors import Array, Ints, norm

MOST_PER_SIDE = 64
"""Triangles are sampled with at most so many points along a side."""

Side = tuple[int, int]
"""A region and one of its faces."""


@dataclass(frozen=True, eq=False)
class Layout:
    """What of the complex the mesh keeps.

    Args:
        complex: of the skeleton.
        sides: for each patch the faces that it is part of, by ascending region; none for sheets.
        between: for each pair of cells of one region, lower first, the patches between them.
        inside: patches that have one cell on both their sides, with the cell.
        around_line: for each line the patches that meet along it, ascending.
        corners: (k,) points at which lines end or more patches meet than along any line there.
        around_corner: for each corner the patches that meet there, ascending.
    """

    complex: Complex
    sides: tuple[tuple[Side, ...], ...]
    between: dict[tuple[int, int], tuple[int, ...]]
    inside: dict[int, int]
    around_line: tuple[tuple[int, ...], ...]
    corners: Ints
    around_corner: tuple[tuple[int, ...], ...]

    @property
    def triangles(self) -> Ints:
        """(m, 3) all triangles that the mesh conforms to."""
        return np.concatenate([patch.triangles for patch in self.complex.patches])


def layout(surface: MeshSurface, cells: CellMap) -> Layout:
    """Lay out a complex for its cells."""
    mesh = surface.complex
    sides: list[list[Side]] = [[] for _ in mesh.patches]
    for number, region in enumerate(surface.regions):
        for face, own in enumerate(region.face_sides):
            for patch, _ in own:
                sides[patch].append((number, face))
    on: dict[int, list[int]] = {}
    for number, cell in enumerate(cells.cells):
        for patch, _ in cell.sides:
            on.setdefault(patch, []).append(number)
    between: dict[tuple[int, int], list[int]] = {}
    inside = {}
    for patch in range(len(mesh.patches)):
        if sides[patch] or patch not in on:
            continue
        low, high = min(on[patch]), max(on[patch])
        if low == high:
            inside[patch] = low
        else:
            between.setdefault((low, high), []).append(patch)
    around = _around_edges(mesh)
    lines = tuple(
        around.get((int(min(line.vertices[:2])), int(max(line.vertices[:2]))), ())
        for line in mesh.lines
    )
    corners, at_corner = _corners(mesh, lines)
    return Layout(
        mesh,
        tuple(tuple(sorted(own)) for own in sides),
        {pair: tuple(own) for pair, own in between.items()},
        inside,
        lines,
        corners,
        at_corner,
    )


def _around_edges(mesh: Complex) -> dict[tuple[int, int], tuple[int, ...]]:
    """For each segment of a line the patches whose triangles have it."""
    wanted = {
        (int(min(pair)), int(max(pair)))
        for line in mesh.lines
        for pair in zip(line.vertices[:-1], line.vertices[1:], strict=True)
    }
    found: dict[tuple[int, int], set[int]] = {}
    for patch, own in enumerate(mesh.patches):
        edges = np.sort(own.triangles[:, TRIANGLE_EDGES].reshape(-1, 2), axis=1)
        for pair in map(tuple, np.unique(edges, axis=0).tolist()):
            if pair in wanted:
                found.setdefault(pair, set()).add(patch)
    return {pair: tuple(sorted(these)) for pair, these in found.items()}


def _corners(
    mesh: Complex, lines: Sequence[tuple[int, ...]]
) -> tuple[Ints, tuple[tuple[int, ...], ...]]:
    at_ends: dict[int, int] = {}
    for line, around in zip(mesh.lines, lines, strict=True):
        for vertex in {int(line.vertices[0]), int(line.vertices[-1])} if around else set():
            # alone, a closed line begins anywhere
            closed = line.vertices[0] == line.vertices[-1]
            at_ends[vertex] = at_ends.get(vertex, 0) + (1 if closed else 2)
    ends = sorted(vertex for vertex, count in at_ends.items() if count > 1)
    found: dict[int, set[int]] = {vertex: set() for vertex in ends}
    is_end = np.zeros(len(mesh.points), dtype=np.bool_)
    is_end[ends] = True
    for patch, own in enumerate(mesh.patches):
        used = np.unique(own.triangles)
        for vertex in used[is_end[used]].tolist():
            found[vertex].add(patch)
    return np.array(ends, dtype=np.int64), tuple(tuple(sorted(found[v])) for v in ends)


def samples(points: Array, triangles: Ints, spacing: float) -> tuple[Array, Ints]:
    """Points on triangles (m, 3), about a given distance apart.

    Returns:
        the points (k, 3), and the triangle (k,) of each.
    """
    corners = points[triangles]
    longest = norm(corners - np.roll(corners, 1, axis=1)).max(axis=1)
    steps = np.clip(np.ceil(longest / spacing), 1, MOST_PER_SIDE).astype(np.int64)
    found, which = [np.empty((0, 3))], [np.empty(0, dtype=np.int64)]
    for count in np.unique(steps).tolist():
        rows = np.flatnonzero(steps == count)
        i, j = np.divmod(np.arange((count + 1) ** 2), count + 1)
        i, j = i[i + j <= count], j[i + j <= count]
        weights = np.stack([i, j, count - i - j], axis=1) / count
        found.append(np.einsum("kc,rcd->rkd", weights, corners[rows]).reshape(-1, 3))
        which.append(np.repeat(rows, len(weights)))
    return np.concatenate(found), np.concatenate(which)
