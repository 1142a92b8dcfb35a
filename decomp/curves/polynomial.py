"""Roots of real and of trigonometric polynomials.

A trigonometric polynomial of degree n is kept as its complex coefficients c_{-n} .. c_n of
e^{ikt}, lowest first. Its zeros are the roots on the unit circle of an ordinary polynomial in
z = e^{it} (J. P. Boyd, Computing the zeros, maxima and inflection points of Chebyshev, Legendre
and Fourier series, 2006), which are eigenvalues of its companion matrix.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from decomp.vectors import Array

Complex = NDArray[np.complex128]

NEGLIGIBLE = 1e-14
"""Coefficients below this part of the largest count as zero."""


def trigonometric_fit(values: Array, degree: int) -> Complex:
    """Coefficients c_{-degree}..c_degree from values at 2 pi j / m along the first axis."""
    c = np.fft.fft(values, axis=0) / len(values)
    return np.concatenate([c[-degree:], c[: degree + 1]]) if degree else c[:1]


def trigonometric_value(c: Complex, t: Any) -> Array:
    """Values at t of a trigonometric polynomial."""
    n = len(c) // 2
    return np.asarray((np.exp(1j * np.multiply.outer(t, np.arange(-n, n + 1))) @ c).real)


def trigonometric_derivative(c: Complex) -> Complex:
    """Coefficients of the derivative."""
    n = len(c) // 2
    return np.asarray(1j * np.arange(-n, n + 1) * c)


def polynomial_roots(c: NDArray[Any]) -> Complex:
    """All complex roots of sum c_k z^k; negligible leading and trailing terms are dropped."""
    size = float(np.abs(c).max(initial=0.0))
    keep = np.nonzero(np.abs(c) > NEGLIGIBLE * size)[0]
    if size == 0.0 or len(keep) == 0:
        return np.empty(0, complex)
    c = c[keep[0] : keep[-1] + 1]
    n = len(c) - 1
    if n == 0:
        return np.empty(0, complex)
    companion = np.zeros((n, n), complex)
    companion[np.arange(1, n), np.arange(n - 1)] = 1.0
    companion[:, -1] = -c[:-1] / c[-1]
    return np.asarray(np.linalg.eigvals(companion), dtype=complex)


def circle_roots(c: Complex, width: float) -> Array:
    """Angles in [0, 2 pi) of the roots whose modulus is within e^{+-width} of 1."""
    z = polynomial_roots(c)
    z = z[np.abs(z) > 0]
    near = np.abs(np.log(np.abs(z))) < width
    return np.sort(np.mod(np.angle(z[near]), 2 * np.pi))
