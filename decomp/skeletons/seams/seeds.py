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
from decomp.carriers.on_carriers import normals_at, projected
from decomp.kernels.compiled import scalar
from decomp.sites.on_boundary import NOWHERE, on_boundary
from decomp.skeletons.balls.balls import Balls, balls_at
from decomp.skeletons.balls.equidistance import equidistant
from decomp.skeletons.balls.probing import TOWARDS, Probe, inside
from decomp.skeletons.balls.queries import RegionQueries
from decomp.skeletons.balls.region_context import RegionContext
from decomp.skeletons.balls.shrinking import OSCULATES, TOUCHES
from decomp.skeletons.seams.edge_seeds import edge_jumps
from decomp.vectors import Array, Bools, Ints, frame, norm

BISECTIONS = 18
NEIGHBOURS = 4
LEAST = 60
"""Samples of the smallest face."""
WIDER = 0.5
"""Face samples are looked for in a box wider than the face's edges by this part."""
MOVED = 0.01
JUMP = 50.0
"""A far foot jumps if it moves by more than this multiple of the near one's way."""
INWARD = 1e-7
SMALL = 1e-6
"""Balls smaller than this part of the size lie in an edge: their feet tell of no seam."""
CLOSE = 1e-3
"""Centres on both sides of a jump are closer to each other than this part of the radius."""


@dataclass(frozen=True, eq=False)
class Seeds:
    """Points close to seams.

    Args:
        points: (k, 3).
        feet: (k, 3, 3), of three contacts.
    """

    points: Array
    feet: Array


@dataclass(frozen=True, eq=False)
class _Samples:
    """Boundary points (k, 3) with the carriers (k,) that hold them and the signs (k,) by which the
    carriers' normals point inwards."""

    points: Array
    carriers: Ints
    signs: Array


def seam_seeds(context: RegionContext, samples: int, seed: int) -> Seeds:
    """Look for seams over all faces and curved reentrant edges of a region.

    Args:
        context: of the region.
        samples: boundary points to start from; small faces get more than their share.
        seed: of the random numbers that place them.
    """
    boundary, queries = context.boundary, context.queries
    rng = np.random.default_rng(seed)
    share = sum(face.area for face in boundary.faces)
    scatter, carriers = [], []
    for number, face in enumerate(boundary.faces):
        count = max(LEAST, int(samples * face.area / share))
        scatter.append(_scattered(boundary, number, count, rng))
        carriers.append(np.full(len(scatter[-1]), face.carrier))
    points, which = np.concatenate(scatter), np.concatenate(carriers)
    signs = _inward_signs(queries, points, which)
    kept = signs != 0
    found = _Samples(points[kept], which[kept], signs[kept])
    first, second = _pairs(found)
    spots = _between(queries, found, first, second)
    more = edge_jumps(boundary, queries, samples, rng)
    points, feet = (np.concatenate(both) for both in zip(spots, more, strict=True))
    return _exact(context, points, feet)


def _scattered(
    boundary: RegionBoundary, number: int, count: int, rng: np.random.Generator
) -> Array:
    """About `count` points of a face, with others of its carrier."""
    face = boundary.faces[number]
    carrier = boundary.carriers[face.carrier]
    edges = [boundary.edges[e].samples for loop in face.loops for e, _ in loop]
    around = np.concatenate([*edges, face.point[None]])
    if carrier.flat:
        x, y = frame(carrier.normal(face.point))
        flat = np.stack([around @ x, around @ y], axis=1)
        _, _, turn = np.linalg.svd(flat - flat.mean(axis=0), full_matrices=False)
        flat = flat @ turn.T
        low, high = flat.min(axis=0), flat.max(axis=0)
        spot = (low + rng.random((2 * count, 2)) * (high - low)) @ turn
        height = float(face.point @ carrier.normal(face.point))
        return np.asarray(spot[:, :1] * x + spot[:, 1:] * y + height * carrier.normal(face.point))
    low, high = around.min(axis=0), around.max(axis=0)
    wider = WIDER * (high - low)
    near = low - wider + rng.random((2 * count, 3)) * (high - low + 2 * wider)
    box = boundary.bounds
    far = box[0] + rng.random((2 * count, 3)) * (box[1] - box[0])
    return carrier.project(np.concatenate([near, far]) if edges else far)


def _inward_signs(queries: RegionQueries, points: Array, carriers: Ints) -> Array:
    """The sign by which a carrier's normal points into the region, 0 off its boundary."""
    normals = normals_at(queries.probe.occupancy.table, carriers, points)
    signs = np.zeros(len(points))
    sides(queries.probe, points, normals, carriers, INWARD * queries.size, signs)
    return signs


@scalar
def sides(
    probe: Probe, points: Array, normals: Array, carriers: Ints, step: float, signs: Array
) -> None:
    """Fill in on which side of its carrier the region lies, 0 for points off its boundary."""
    for i in range(len(points)):
        x, y, z = points[i, 0], points[i, 1], points[i, 2]
        if on_boundary(probe.occupancy, probe.label, carriers[i], x, y, z) == NOWHERE:
            continue
        for side in range(2):
            s = step if side == 0 else -step
            if inside(probe, x + s * normals[i, 0], y + s * normals[i, 1], z + s * normals[i, 2]):
                signs[i] = 1.0 if side == 0 else -1.0
                break


def _pairs(samples: _Samples) -> tuple[Ints, Ints]:
    """Pairs (k,), (k,) of neighbours on the same side of the same carrier."""
    found = []
    side = 2 * samples.carriers + (samples.signs > 0)
    order = np.argsort(side, kind="stable")
    for rows in np.split(order, np.flatnonzero(np.diff(side[order])) + 1):
        if len(rows) < 2:
            continue
        points = samples.points[rows]
        _, near = cKDTree(points).query(points, k=min(NEIGHBOURS + 1, len(points)))
        one = np.repeat(np.arange(len(points)), near.shape[1] - 1)
        both = np.sort(np.stack([one, near[:, 1:].ravel()], axis=1), axis=1)
        found.append(rows[np.unique(both, axis=0)])
    pairs = np.concatenate([*found, np.empty((0, 2), dtype=np.int64)]).astype(np.int64)
    return pairs[:, 0], pairs[:, 1]


def _between(
    queries: RegionQueries, samples: _Samples, one: Ints, other: Ints
) -> tuple[Array, Array]:
    """Where the far foot jumps between samples, by bisection: points (k, 3), feet (k, 3, 3)."""
    size, table = queries.size, queries.probe.occupancy.table

    def balls(carriers: Ints, signs: Array, points: Array) -> Balls:
        inward = signs[:, None] * normals_at(table, carriers, points)
        found, state = balls_at(queries, points, inward, size)
        found.site[(state != TOUCHES) & (state != OSCULATES)] = -1
        return found

    every = balls(samples.carriers, samples.signs, samples.points)
    low, high = _rows(every, one), _rows(every, other)
    first, second = samples.points[one], samples.points[other]
    carriers, signs = samples.carriers[one], samples.signs[one]
    keep = _differ(low, high, first, second)
    for step in range(BISECTIONS + 1):
        first, second, carriers, signs = first[keep], second[keep], carriers[keep], signs[keep]
        low, high = _rows(low, keep), _rows(high, keep)
        if step == BISECTIONS or not len(first):
            break
        middle = projected(table, carriers, (first + second) / 2)
        # between two points of a face one can be off it
        off = _inward_signs(queries, middle, carriers) != signs
        new = balls(carriers, signs, middle)
        new.site[off] = -1
        # the half in which the far foot moves more
        upper = norm(new.foot - low.foot) <= norm(new.foot - high.foot)
        first = np.where(upper[:, None], middle, first)
        second = np.where(upper[:, None], second, middle)
        low, high = _chosen(upper, new, low), _chosen(upper, high, new)
        keep = _differ(low, high, first, second)
    near = norm(low.centre - high.centre) <= CLOSE * np.minimum(low.radius, high.radius)
    near &= norm(low.foot - high.foot) > JUMP * norm(first - second)
    near &= low.radius > SMALL * size
    feet = np.stack([first, low.foot, high.foot], axis=1)[near]
    return low.centre[near], feet


def _exact(context: RegionContext, points: Array, feet: Array) -> Seeds:
    """Seeds put onto the seams of their sites; those without are left out."""
    towards = points[:, None] + TOWARDS * (feet - points[:, None])
    which = context.queries.nearest(towards.reshape(-1, 3)).site.reshape(-1, 3).astype(np.int64)
    inner = np.flatnonzero((which >= 0).all(axis=1))
    points, feet, which = points[inner], feet[inner], which[inner]
    found = equidistant(context, which, points, feet)
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
