"""One complex of boundary and walls, smoothed; what stays folded is contracted."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from scipy.spatial import cKDTree  # type: ignore[import-untyped]

from decomp.errors import GeometryError
from decomp.geometry import Geometry
from decomp.sampled.bisecting import Bisected
from decomp.sampled.contracting import thin
from decomp.sampled.extracted import CLOSE_VERTICES, ONE_VERTEX, Extracted, contracted
from decomp.sampled.interior import Interior
from decomp.sampled.loci import pinned_ends
from decomp.sampled.smoothing import unfolded
from decomp.sampled.whole import Drawn, RegionTools, drawn
from decomp.vectors import Array, Ints

UNFOLDINGS = 4
"""So often walls are smoothed, and what is still folded then is contracted."""
MOST_FOLDED = 0.01
"""If more than this part of the triangles stays folded refining them is of no use."""


def smoothly_drawn(
    geometry: Geometry,
    given: Interior,
    mesh: Bisected,
    tools: Sequence[RegionTools],
    extracted: Sequence[Extracted],
    floor: float,
) -> Drawn:
    """The complex, smoothed; triangles that stay folded are contracted.

    Args:
        geometry: of the model.
        given: the boundaries' elements.
        mesh: the tetrahedra whose triangles show the boundaries.
        tools, extracted: of each region.
        floor: a length: about that of edges.

    Raises:
        GeometryError: too many triangles stay folded.
    """
    boundary = len(given.plan.complex.patches)
    extracted = [
        pinned_ends(tool.incidence, tool.loci, found)
        for tool, found in zip(tools, extracted, strict=True)
    ]
    near: Array | None = None
    for left in reversed(range(UNFOLDINGS)):
        shown = drawn(geometry, given, mesh, tools, extracted, floor / 2)
        smooth, folded = unfolded(
            shown.complex, boundary, _pinned(shown, extracted), _at(shown, near)
        )
        if not left or not len(folded):
            break
        bad = {tuple(row) for row in np.sort(folded, axis=1).tolist()}
        fewer = []
        for found, vertices, tool in zip(extracted, shown.vertices, tools, strict=True):
            moved = replace(found, points=smooth.points[vertices])
            corners = np.sort(vertices[found.triangles], axis=1).tolist()
            wanted = np.array([tuple(row) in bad for row in corners], dtype=np.bool_)
            wanted |= thin(moved.points, moved.sites, moved.triangles, tool.placer)
            least = ONE_VERTEX * geometry.diagonal
            fewer.append(
                contracted(
                    moved,
                    wanted,
                    moved.short_edges(CLOSE_VERTICES * geometry.diagonal),
                    least,
                    tool.placer,
                )
            )
        extracted = fewer
        near = smooth.points[np.unique(folded)]
    if len(folded) > MOST_FOLDED * sum(len(found.triangles) for found in extracted):
        at = smooth.points[folded[0]].mean(axis=0)
        raise GeometryError(f"{len(folded)} triangles of walls stay folded, one at {{at}}", at=at)
    return replace(shown, complex=smooth)


def _at(shown: Drawn, places: Array | None) -> Ints | None:
    """The points of a complex that are nearest to some places (k, 3)."""
    if places is None:
        return None
    return np.unique(cKDTree(shown.complex.points).query(places)[1])


def _pinned(shown: Drawn, extracted: Sequence[Extracted]) -> Ints:
    """The points that stay where they are."""
    pairs = zip(shown.vertices, extracted, strict=True)
    return np.concatenate([vertices[found.pinned] for vertices, found in pairs])
