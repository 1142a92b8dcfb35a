"""Points on seams, found from the footprint.

Every boundary point q has a maximal ball that touches the boundary there and once more, at a far
site. Between two points of one face whose far sites differ, bisection finds where the site changes;
if the far foot jumps there, the ball has three contacts and its centre lies on a seam.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from scipy.spatial import cKDTree  # type: ignore[import-untyped]

from decomp.boundary.topology import RegionBoundary
from decomp.sites import SiteIndex
from decomp.skeleton.balls import Balls, inscribed_balls
from decomp.vectors import Array, Bools, norm

BISECTIONS = 24
NEIGHBOURS = 3


def seam_seeds(
    index: SiteIndex, boundary: RegionBoundary, region: int, samples: int, seed: int
) -> Iterator[tuple[tuple[int, ...], Array, Array]]:
    """Yield (sites, point, feet) of points close to seams."""
    rng = np.random.default_rng(seed)
    share = sum(face.area for face in boundary.faces)
    for number, face in enumerate(boundary.faces):
        count = max(50, int(samples * face.area / share))
        first, second = _pairs(index, boundary, region, number, count, rng)
        if not len(first):
            continue
        yield from _between(index, boundary, region, number, first, second)


def _pairs(
    index: SiteIndex,
    boundary: RegionBoundary,
    region: int,
    number: int,
    count: int,
    rng: np.random.Generator,
) -> tuple[Array, Array]:
    """Pairs of neighbouring points of a face (k, 3)."""
    face = boundary.faces[number]
    carrier = boundary.carriers[face.carrier]
    bounds = _face_box(boundary, number)
    points = np.empty((0, 3))
    for _ in range(20):
        scatter = bounds[0] + rng.random((4 * count, 3)) * (bounds[1] - bounds[0])
        candidates = carrier.project(scatter)
        points = np.concatenate(
            [points, candidates[_on(index, boundary, region, number, candidates)]]
        )
        if len(points) >= count:
            break
    points = points[:count]
    if len(points) < 2:
        return np.empty((0, 3)), np.empty((0, 3))
    _, near = cKDTree(points).query(points, k=min(NEIGHBOURS + 1, len(points)))
    pairs = {tuple(sorted((i, int(j)))) for i, row in enumerate(near) for j in row[1:]}
    ordered = np.array(sorted(pairs), dtype=np.int64)
    return points[ordered[:, 0]], points[ordered[:, 1]]


def _between(
    index: SiteIndex,
    boundary: RegionBoundary,
    region: int,
    number: int,
    first: Array,
    second: Array,
) -> Iterator[tuple[tuple[int, ...], Array, Array]]:
    face = boundary.faces[number]
    carrier = boundary.carriers[face.carrier]

    def balls(points: Array) -> Balls:
        inward = -face.outward * carrier.normal(points)
        return inscribed_balls(index, boundary, region, points, inward)

    low, high = balls(first), balls(second)
    differ = (low.site != high.site) & (low.site >= 0) & (high.site >= 0)
    first, second = first[differ], second[differ]
    if not len(first):
        return
    low, high = balls(first), balls(second)
    for _ in range(BISECTIONS):
        middle = carrier.project((first + second) / 2)
        there = balls(middle)
        keep = there.site == low.site
        first = np.where(keep[:, None], middle, first)
        second = np.where(keep[:, None], second, middle)
        low, high = _chosen(keep, there, low), _chosen(keep, high, there)
    size = boundary.diagonal
    jump = (norm(low.foot - high.foot) > 1e-4 * size) & (
        norm(low.centre - high.centre) < 1e-4 * size
    )
    own = index.nearest(first + 1e-3 * (low.centre - first)).site
    for k in np.flatnonzero(jump & (low.radius > 1e-5 * size)):
        sites = (int(own[k]), int(low.site[k]), int(high.site[k]))
        yield sites, low.centre[k], np.array([first[k], low.foot[k], high.foot[k]])


def _chosen(first: Bools, a: Balls, b: Balls) -> Balls:
    return Balls(
        np.where(first[:, None], a.centre, b.centre),
        np.where(first, a.radius, b.radius),
        np.where(first, a.site, b.site),
        np.where(first[:, None], a.foot, b.foot),
    )


def _on(
    index: SiteIndex, boundary: RegionBoundary, region: int, number: int, points: Array
) -> Bools:
    """Whether points on a face's carrier are in the face: from a little inside it is nearest."""
    face = boundary.faces[number]
    inward = -face.outward * boundary.carriers[face.carrier].normal(points)
    step = 1e-6 * boundary.diagonal
    found = index.nearest(points + step * inward)
    names = np.array([s.index if s.kind.value == "face" else -1 for s in index.sites])
    return np.asarray(
        (found.region == region)
        & (names[found.site] == number)
        & (np.abs(found.distance - step) <= 1e-3 * step)
    )


def _face_box(boundary: RegionBoundary, number: int) -> Array:
    """A box around a face's edges, or the region's if it has none or bulges."""
    face = boundary.faces[number]
    if boundary.carriers[face.carrier].kind != "plane":
        return boundary.bounds
    points = np.concatenate([boundary.edges[e].samples for loop in face.loops for e, _ in loop])
    return np.array([points.min(axis=0), points.max(axis=0)])
