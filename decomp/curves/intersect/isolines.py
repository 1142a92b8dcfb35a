"""Real zeros v of F(u, .) on many isolines at once, and fold points F = F_v = 0.

Folds are where the number of zeros changes. For a quadratic in w they are the zeros of the
discriminant b^2 - 4 a c. For a quartic they are the eigenvalues z of the Sylvester matrix
polynomial S(z) of P_w and n P - w P_w, which vanish together at double roots (24 of them).
"""

from __future__ import annotations

import numpy as np

from decomp.curves.intersect.pulled import Pulled
from decomp.curves.polynomial import Complex, polynomial_roots
from decomp.errors import ContactError
from decomp.tolerance import TINY
from decomp.vectors import Array

REAL = 1e-6
"""Distance of w from the unit circle (logarithm) up to which it counts as on it."""

DOUBLE = 1e-5
"""Zeros nearer than this, and so near to the unit circle, are a double one but for rounding."""
NOT_REAL = 1e-13
"""A discriminant below zero by no more than this part of its terms is a double root."""
NO_LEAD = 1e-14
"""A leading coefficient below this part of the largest is made that: its roots are far off."""
SAME_ISOLINE = 1e-4
"""Isolines are one, but for rounding of a double zero, if half their angle has a lesser sine."""


def zeros(f: Pulled, u: Array, low: float, high: float, count: int | None = None) -> list[Array]:
    """Zeros v in [low, high) on each isoline u, increasing.

    Args:
        f: the function.
        u: angles (k,).
        low: where v begins.
        high: where v ends; one turn above `low` on tube circles.
        count: how many zeros there are on every isoline, if known: then the `count` most real
            ones are taken.
    """
    columns = f.columns(u)
    if not f.round:
        return [_inside(v, low, high, count) for v in _quadratic(columns.real)]
    w = _all_roots(columns)
    off = np.abs(np.log(np.maximum(np.abs(w), TINY)))
    v = low + np.mod(np.angle(w) - low, 2 * np.pi)
    if count is None:
        return [np.sort(v[i, off[i] < REAL]) for i in range(len(u))]
    order = np.argsort(off, axis=1)[:, :count]
    return list(np.sort(np.take_along_axis(v, order, axis=1), axis=1))


def _inside(v: Array, low: float, high: float, count: int | None) -> Array:
    """Real zeros within the limits; the `count` nearest to them if a count is given."""
    v = v[np.isfinite(v)]
    if count is None:
        return np.sort(v[(v > low) & (v < high)])
    beyond = np.maximum(low - v, v - high)
    return np.sort(np.clip(v[np.argsort(beyond)[:count]], low, high))


def _quadratic(c: Array) -> Array:
    """Zeros (k, 2) of c0 + c1 v + c2 v^2, NaN where they are not real."""
    if c.shape[1] == 2:
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.stack([-c[:, 0] / c[:, 1], np.full(len(c), np.nan)], axis=1)
    c0, c1, c2 = c.T
    root = c1**2 - 4 * c0 * c2
    real = root > -NOT_REAL * (c1**2 + np.abs(4 * c0 * c2))
    root = np.where(real, np.sqrt(np.maximum(root, 0)), np.nan)
    q = -(c1 + np.where(c1 < 0, -1.0, 1.0) * root) / 2
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.stack([q / c2, c0 / q], axis=1)


def _all_roots(columns: Complex) -> Complex:
    """Roots (k, n) of the polynomials in w whose coefficients are the rows."""
    k, n = columns.shape[0], columns.shape[1] - 1
    companion = np.zeros((k, n, n), complex)
    companion[:, np.arange(1, n), np.arange(n - 1)] = 1.0
    lead = columns[:, -1:]
    small = np.abs(lead) < NO_LEAD * np.abs(columns).max(axis=1, keepdims=True)
    lead = np.where(small, NO_LEAD * np.abs(columns).max(axis=1, keepdims=True) + TINY, lead)
    companion[:, :, -1] = -columns[:, :-1] / lead
    return np.asarray(np.linalg.eigvals(companion), dtype=complex)


def fold_candidates(f: Pulled, width: float) -> list[tuple[float, float]]:
    """Approximate (u, v) of all points with F = F_v = 0, complex ones near the reals included.

    Args:
        f: the function.
        width: how far from the unit circle (logarithm of the modulus) z may be.

    Raises:
        ContactError: F = F_v = 0 on a whole circle v = const.
    """
    if f.m == 0:
        _refuse_double_zero(f)
        return []
    z = _discriminant_roots(f) if f.n <= 2 else _sylvester_roots(f)
    z = z[(np.abs(z) > 0) & np.isfinite(z)]
    z = z[np.abs(np.log(np.abs(z))) < width]
    found = []
    for u in np.angle(z):
        columns = f.columns(np.array([u]))[0]
        if f.round:
            k = np.arange(f.n + 1)
            slope = (k - f.n / 2) * columns
            w = polynomial_roots(slope)
            w = w[np.abs(w) > 0]
            w = w[np.abs(np.log(np.abs(w))) < max(30 * width, 0.3)]
            values = np.abs(np.exp(1j * np.multiply.outer(np.angle(w), k)) @ columns)
            ranked = np.angle(w)[np.argsort(values)][:2]
            found += [(float(u), float(v)) for v in ranked]
        elif f.n == 2 and columns[2] != 0:
            found.append((float(u), float((-columns[1] / (2 * columns[2])).real)))
    return found


def _refuse_double_zero(f: Pulled) -> None:
    """F is the same on all isolines: zeros are circles, and a double one a contact along one."""
    w = polynomial_roots(f.columns(np.zeros(1))[0])
    w = w[np.abs(np.log(np.maximum(np.abs(w), TINY))) < DOUBLE]
    gaps = np.abs(w[:, None] - w[None])[np.triu_indices(len(w), 1)]
    if (gaps < DOUBLE).any():
        raise ContactError("two carriers touch along a circle that cannot be resolved")


def _discriminant_roots(f: Pulled) -> Complex:
    if f.n < 2:
        return np.empty(0, complex)
    a, b, c = f.c[:, 2], f.c[:, 1], f.c[:, 0]
    return polynomial_roots(np.convolve(b, b) - 4 * np.convolve(a, c))


def _sylvester_roots(f: Pulled) -> Complex:
    from scipy.linalg import eigvals  # type: ignore[import-untyped]  # not needed by models without tori

    n, m = f.n, f.m
    k = np.arange(n + 1)
    one = (k * f.c)[:, 1:]
    two = ((n - k) * f.c)[:, :-1]
    size = 2 * (n - 1)
    s = np.zeros((m + 1, size, size), complex)
    for row in range(n - 1):
        s[:, row, row : row + n] = one
        s[:, n - 1 + row, row : row + n] = two
    left = np.zeros((m * size, m * size), complex)
    right = np.eye(m * size, dtype=complex)
    left[:-size, size:] = np.eye((m - 1) * size)
    left[-size:] = -np.concatenate(list(s[:m]), axis=1)
    right[-size:, -size:] = s[m]
    values = eigvals(left, right, check_finite=False)
    return np.asarray(values)
