"""Points on seams, found from the footprint.

Every boundary point q has a maximal ball that touches the boundary there and once more, at a far
site. Where the far foot jumps between two neighbouring points of a face, the ball has three
contacts and its centre lies on a seam.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree  # type: ignore[import-untyped]

from decomp.boundary.topology import RegionBoundary
from decomp.sites import SiteIndex
from decomp.tracing.balls import Balls, balls_at
from decomp.tracing.equidistance import equidistant
from decomp.tracing.probing import TOWARDS
from decomp.tracing.shrinking import OSCULATES, TOUCHES
from decomp.vectors import Array, Bools, Ints, norm

BISECTIONS = 18
NEIGHBOURS = 4
LEAST = 60
"""Samples of the smallest face."""
MOVED = 0.01
JUMP = 50.0
"""A far foot jumps if it moves by more than this multiple of the near one's way."""


@dataclass(frozen=True, eq=False)
class Seeds:
    """Points close to seams.

    Args:
        points: (k, 3).
        feet: (k, 3, 3), of three contacts.
    """

    points: Array
    feet: Array


def seam_seeds(
    index: SiteIndex, boundary: RegionBoundary, region: int, samples: int, seed: int
) -> Seeds:
    """Look for seams over all faces of a region.

    Args:
        index: nearest-site queries of the model.
        boundary: of the region.
        region: its index.
        samples: boundary points to start from.
        seed: of the random numbers that place them.
    """
    rng = np.random.default_rng(seed)
    share = sum(face.area for face in boundary.faces)
    pairs = []
    for number, face in enumerate(boundary.faces):
        count = max(LEAST, int(samples * face.area / share))
        first, second = _pairs(index, boundary, region, number, count, rng)
        pairs.append((np.full(len(first), number), first, second))
    faces = np.concatenate([p[0] for p in pairs])
    return _between(
        index,
        boundary,
        region,
        faces,
        np.concatenate([p[1] for p in pairs]),
        np.concatenate([p[2] for p in pairs]),
    )


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
    one = np.repeat(np.arange(len(points)), near.shape[1] - 1)
    other = near[:, 1:].ravel()
    ordered = np.unique(np.sort(np.stack([one, other], axis=1), axis=1), axis=0)
    return points[ordered[:, 0]], points[ordered[:, 1]]


def _between(
    index: SiteIndex,
    boundary: RegionBoundary,
    region: int,
    faces: Ints,
    first: Array,
    second: Array,
) -> Seeds:
    def normals(which: Ints, points: Array) -> Array:
        result = np.empty_like(points)
        for number in np.unique(which):
            face = boundary.faces[number]
            rows = which == number
            result[rows] = -face.outward * boundary.carriers[face.carrier].normal(points[rows])
        return result

    def project(which: Ints, points: Array) -> Array:
        result = np.empty_like(points)
        for number in np.unique(which):
            rows = which == number
            result[rows] = boundary.carriers[boundary.faces[number].carrier].project(points[rows])
        return result

    def balls(which: Ints, points: Array) -> Balls:
        found, state = balls_at(index, boundary, region, points, normals(which, points))
        # a point between two of a face can be off it
        found.site[(state != TOUCHES) & (state != OSCULATES)] = -1
        return found

    size = boundary.diagonal
    both, place = np.unique(np.concatenate([first, second]), axis=0, return_inverse=True)
    there = np.zeros(len(both), dtype=np.int64)
    there[place] = np.concatenate([faces, faces])
    every = balls(there, both)
    low, high = _rows(every, place[: len(first)]), _rows(every, place[len(first) :])
    keep = _differ(low, high, first, second)
    first, second, faces = first[keep], second[keep], faces[keep]
    low, high = _rows(low, keep), _rows(high, keep)
    for _ in range(BISECTIONS):
        if not len(first):
            break
        middle = project(faces, (first + second) / 2)
        new = balls(faces, middle)
        # the half in which the far foot moves more
        to_low, to_high = norm(new.foot - low.foot), norm(new.foot - high.foot)
        upper = to_low <= to_high
        first = np.where(upper[:, None], middle, first)
        second = np.where(upper[:, None], second, middle)
        low, high = _chosen(upper, new, low), _chosen(upper, high, new)
        keep = _differ(low, high, first, second)
        first, second, faces = first[keep], second[keep], faces[keep]
        low, high = _rows(low, keep), _rows(high, keep)
    if not len(first):
        return Seeds(np.empty((0, 3)), np.empty((0, 3, 3)))
    near = norm(low.centre - high.centre) <= 1e-3 * np.minimum(low.radius, high.radius)
    near &= norm(low.foot - high.foot) > JUMP * norm(first - second)
    near &= low.radius > 1e-6 * size
    feet = np.stack([first, low.foot, high.foot], axis=1)[near]
    return _exact(index, boundary, low.centre[near], feet)


def _exact(index: SiteIndex, boundary: RegionBoundary, points: Array, feet: Array) -> Seeds:
    """Seeds put onto the seams of their sites."""
    towards = points[:, None] + TOWARDS * (feet - points[:, None])
    which = index.nearest(towards.reshape(-1, 3)).site.reshape(-1, 3).astype(np.int64)
    found = equidistant(boundary, index.sites, which, points, feet)
    good = found.converged & (norm(found.points - points) <= MOVED * found.radius)
    return Seeds(
        np.where(good[:, None], found.points, points),
        np.where(good[:, None, None], found.feet, feet),
    )


def _differ(low: Balls, high: Balls, first: Array, second: Array) -> Bools:
    """Whether the far foot changes more than the near one explains."""
    way = norm(first - second)
    return np.asarray(
        (low.site >= 0)
        & (high.site >= 0)
        & ((low.site != high.site) | (norm(low.foot - high.foot) > 4 * way))
    )


def _rows(balls: Balls, which: Ints | Bools) -> Balls:
    return Balls(balls.centre[which], balls.radius[which], balls.site[which], balls.foot[which])


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
