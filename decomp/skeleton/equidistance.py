"""Points at equal distance from two, three or more sites, by minimum-norm Newton (design: 3.3).

Two sites leave a point two ways to go (a sheet), three one (a seam), four none (a junction); more
than four meet at degenerate junctions, where the system is consistent though overdetermined. Each
step is the shortest that solves the linearised equations, so a point moves straight across to its
element and not along it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from decomp.boundary.topology import RegionBoundary
from decomp.sites.site import Site
from decomp.skeleton.fields import site_fields
from decomp.vectors import Array, Bools, Ints, norm

STEPS = 30
RANK = 1e-7
"""Directions in which the equations change less than this part of the most are left alone."""


@dataclass(frozen=True, eq=False)
class Equidistant:
    """Points brought onto their Voronoi elements.

    Args:
        points: (k, 3).
        radius: their common distance from the sites (k,).
        feet: (k, m, 3), on each site.
        residual: (k,), largest difference between the distances.
        converged: (k,), whether Newton's method came to rest.
    """

    points: Array
    radius: Array
    feet: Array
    residual: Array
    converged: Bools


def equidistant(
    boundary: RegionBoundary, sites: Sequence[Site], which: Ints, points: Array, feet: Array
) -> Equidistant:
    """Move points to where they are equally far from all their sites.

    Args:
        boundary: of the region.
        sites: all sites, into which `which` points.
        which: (k, m) sites of each point, m at least 2.
        points: (k, 3), near their elements.
        feet: (k, m, 3), a foot on each site, or close to it.
    """
    x, feet = np.array(points), np.array(feet)
    size = boundary.diagonal
    moving = np.ones(len(x), dtype=np.bool_)
    distances = np.empty(which.shape)
    for _ in range(STEPS):
        rows = np.flatnonzero(moving)
        if not len(rows):
            break
        distance, gradient = _at(boundary, sites, which[rows], x[rows], feet, rows)
        distances[rows] = distance
        f = distance[:, 1:] - distance[:, :1]
        jacobian = gradient[:, 1:] - gradient[:, :1]
        step = -(np.linalg.pinv(jacobian, rcond=RANK) @ f[..., None])[..., 0]
        length = norm(step)
        # a step beyond the distance itself has left the neighbourhood where the sites are known
        limit = 0.5 * np.abs(distance).min(axis=1) + 1e-3 * size
        step *= np.minimum(1.0, limit / np.maximum(length, 1e-300))[:, None]
        x[rows] += step
        moving[rows] = length > 4e-16 * size
    distance, _ = _at(boundary, sites, which, x, feet, np.arange(len(x)))
    residual = distance.max(axis=1) - distance.min(axis=1)
    return Equidistant(x, distance.mean(axis=1), feet, residual, residual <= 1e-12 * size)


def _at(
    boundary: RegionBoundary,
    sites: Sequence[Site],
    which: Ints,
    points: Array,
    feet: Array,
    rows: Ints,
) -> tuple[Array, Array]:
    """Distances (k, m) and gradients (k, m, 3); the feet at `rows` are brought up to date."""
    distance = np.empty(which.shape)
    gradient = np.empty((*which.shape, 3))
    for column in range(which.shape[1]):
        field = site_fields(boundary, sites, which[:, column], points, feet[rows, column])
        distance[:, column], gradient[:, column] = field.distance, field.gradient
        feet[rows, column] = field.foot
    return distance, gradient
