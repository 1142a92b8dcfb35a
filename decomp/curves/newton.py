"""Newton's method onto the intersection of two carriers, for many points at once."""

from __future__ import annotations

import numpy as np

from decomp.carriers import Carrier
from decomp.vectors import Array, cross, dot, norm

SINGULAR = 1e-7
"""Sine of the angle between two normals below which they count as parallel."""


def lateral_step(a: Carrier, b: Carrier, p: Array, along: Array) -> Array:
    """Newton step across the unit vectors `along` that brings p onto both carriers.

    In the plane across `along` the two linear equations n_a.x = -a, n_b.x = -b are solved;
    where the normals are parallel there, the least-norm solution is taken.
    """
    fa, fb = a.signed_distance(p), b.signed_distance(p)
    na, nb = a.normal(p), b.normal(p)
    na = na - dot(na, along)[..., None] * along
    nb = nb - dot(nb, along)[..., None] * along
    det = dot(cross(na, nb), along)
    flat = np.abs(det) < SINGULAR
    safe = np.where(flat, 1.0, det)[..., None]
    # x with n_a.x = -fa and n_b.x = -fb:  (fa n_b - fb n_a) x along / det
    step = -cross(fa[..., None] * nb - fb[..., None] * na, along) / safe
    sign = np.where(dot(na, nb) < 0, -1.0, 1.0)
    least = -((fa + sign * fb) / 2)[..., None] * na
    return np.where(flat[..., None], least, step)


def onto_pair(a: Carrier, b: Carrier, p: Array, along: Array, steps: int = 6) -> Array:
    """Bring points p onto both carriers, moving only across the unit vectors `along`."""
    small = 1e-14 * float(np.max(np.abs(p), initial=0.0))
    for _ in range(steps):
        step = lateral_step(a, b, p, along)
        p = p + step
        if float(np.max(norm(step), initial=0.0)) <= small:
            break
    return p


def cross_direction(a: Carrier, b: Carrier, p: Array) -> tuple[Array, Array]:
    """Unit vectors along n_a x n_b and the lengths of these products (0 where parallel)."""
    product = cross(a.normal(p), b.normal(p))
    size = norm(product)
    return product / np.where(size > 0, size, 1.0)[..., None], size
