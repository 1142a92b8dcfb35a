"""Sheets that end in the centre of a ball, drawn around it.

From there an edge on the ball's face is equally far all along, so that the centre has no foot on
it: in the edge's footprint it is a whole line, and the normal from a vertex to it a point. Turned
about the centre by the place of the foot, and as far from it as in space, points are told apart.
"""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree  # type: ignore[import-untyped]

from decomp.boundary.topology import Edge, RegionBoundary
from decomp.vectors import Array, dot, norm

ALONG = 2049
"""Samples of an edge between which lengths along it are read off."""
SECTOR = np.pi / 2
"""The angle that the feet of an open edge's sheets take up."""


def lengths_along(edge: Edge, feet: Array) -> tuple[Array, float]:
    """How far (k,) along an edge feet (k, 3) on it are, and its length."""
    samples = edge.curve.point(edge.curve.wrapped(np.linspace(edge.start, edge.end, ALONG)))
    lengths = np.append(0.0, np.cumsum(norm(np.diff(samples, axis=0))))
    nearest = cKDTree(samples).query(feet)[1]
    before = np.clip(nearest, 1, ALONG - 2)
    way = samples[before + 1] - samples[before - 1]
    part = dot(feet - samples[before], way) / norm(way)
    return lengths[before] + part, float(lengths[-1])


def about_centre(
    boundary: RegionBoundary, edge: Edge, points: Array, feet: Array, near: float
) -> Array | None:
    """Plane coordinates (k, 2) of points (k, 3) with feet (k, 3) on an edge.

    Args:
        boundary: of the region.
        edge: of it.
        points, feet: of sheets between the edge and another site.
        near: a point so near to a ball's centre is that.

    Returns:
        None if none of the points is the centre of a ball on whose face the edge lies.
    """
    balls = [c for c in (boundary.carriers[k] for k in edge.carriers) if c.locus == 0]
    for ball in balls:
        away = norm(points - ball.place)
        inner = away <= near
        if not inner.any() or inner.all():
            continue
        along, length = lengths_along(edge, feet)
        if edge.closed:
            angle = 2 * np.pi * along / length
        else:
            low, high = along[~inner].min(), along[~inner].max()
            angle = SECTOR * (along - low) / max(high - low, near)
        away = np.where(inner, 0.0, away)
        return np.stack([away * np.cos(angle), away * np.sin(angle)], axis=1)
    return None
