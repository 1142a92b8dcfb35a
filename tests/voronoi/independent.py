"""Points of Voronoi surfaces, found without any algebra."""

from __future__ import annotations

import numpy as np

from decomp.vectors import Array, Bools, norm
from decomp.voronoi import ConeSite, VoronoiSite, VoronoiSurface


def site_distance(site: VoronoiSite, p: Array) -> Array:
    """The signed distance of points, by the carriers' closed form."""
    return site.signed_distance(p)


def equidistant_points(surface: VoronoiSurface, seed: int, count: int = 200) -> Array:
    """Points that minimise (d_f - e d_g)^2 to rounding, from random starts around the sites.

    The gradients are differences of the distances. Points with the apex of a cone as their foot
    are left out: they belong to the Voronoi surface of the apex.
    """
    rng = np.random.default_rng(seed)
    f, g, e = surface.f, surface.g, surface.parity.sign
    middle = np.array([[float(x) for x in s.reference] for s in (f, g)]).mean(axis=0)
    size = surface.size
    p = middle + rng.uniform(-2.5, 2.5, size=(count, 3)) * size

    def gap(q: Array) -> Array:
        return site_distance(f, q) - e * site_distance(g, q)

    h = 1e-6 * size
    for _ in range(60):
        slope = np.stack(
            [(gap(p + h * axis) - gap(p - h * axis)) / (2 * h) for axis in np.eye(3)], axis=-1
        )
        value, square = gap(p), (slope**2).sum(axis=1)
        length = np.clip(value / np.maximum(square, 1e-3), -size, size)
        p = p - length[:, None] * slope
    good = (np.abs(gap(p)) <= 1e-13 * size) & (norm(p - middle) <= 20 * size)
    for site in (f, g):
        if isinstance(site, ConeSite):
            good &= away_from_apex(site, p, 1e-6 * size)
    return np.asarray(p[good])


def away_from_apex(cone: ConeSite, p: Array, margin: float) -> Bools:
    """Whether the foot of points on a cone is farther than `margin` from its apex."""
    return np.asarray(norm(cone.foot(p) - cone.carrier.apex) > margin)


def off_polynomial(surface: VoronoiSurface, p: Array) -> Array:
    """Distances of points from the polynomial's zeros to first order, in units of the size.

    Where that comes out large for want of digits (close to where the polynomial is singular) its
    value is computed in rational arithmetic.
    """
    polynomial = surface.polynomial
    assert polynomial is not None
    value, slope = polynomial(p), norm(polynomial.gradient(p))
    doubtful = np.abs(value) > 1e-10 * slope * surface.size
    value[doubtful] = polynomial.exactly(p[doubtful])
    return np.asarray(np.abs(value) / np.where(slope > 0, slope, 1.0) / surface.size)


def check(surface: VoronoiSurface, seed: int = 1, count: int = 60, needed: bool = True) -> Array:
    """Assert that points found without algebra lie on the surface's equations; return them.

    Args:
        needed: whether there must be such points.
    """
    points = equidistant_points(surface, seed, count)
    assert len(points) or not needed, "no equidistant points were found"
    assert off_polynomial(surface, points).max(initial=0.0) <= 1e-9
    if surface.shape is not None:
        assert surface.shape.deviation(points).max(initial=0.0) <= 1e-9 * surface.size
    return points
