"""A carrier's polynomial along a conic, as a series in the conic's own parameter.

Circle and ellipse: powers of e^{it}; hyperbola: powers of e^t (its coefficients are found at
imaginary t, where the hyperbola is an ellipse); line and parabola: Chebyshev polynomials.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import cast

import numpy as np
from numpy.polynomial import chebyshev

from decomp.carriers import Carrier
from decomp.curves.base import Curve
from decomp.curves.hyperbola import Hyperbola
from decomp.curves.parabola import Parabola
from decomp.curves.polynomial import (
    Complex,
    circle_roots,
    polynomial_roots,
    trigonometric_derivative,
    trigonometric_fit,
    trigonometric_value,
)
from decomp.vectors import Array

NO_TERM = 1e-14
"""Last coefficients below this part of the largest are left out."""


class Series(ABC):
    """A function f of the curve's parameter."""

    @abstractmethod
    def value(self, t: Array) -> Array:
        """f(t)."""

    @abstractmethod
    def bound(self) -> float:
        """|f| is nowhere larger on the curve's domain."""

    @abstractmethod
    def derivative(self) -> Series:
        """f'."""

    @abstractmethod
    def zeros(self) -> Array:
        """Candidates for all real zeros, increasing; double zeros may come twice."""


class Fourier(Series):
    """Trigonometric polynomial."""

    def __init__(self, c: Complex) -> None:
        self.c = c

    def value(self, t: Array) -> Array:
        return trigonometric_value(self.c, t)

    def bound(self) -> float:
        return float(np.abs(self.c).sum())

    def derivative(self) -> Fourier:
        return Fourier(trigonometric_derivative(self.c))

    def zeros(self) -> Array:
        return circle_roots(self.c, 1e-3)


class Exponential(Series):
    """sum c_k e^{kt}, k = -n..n, on a domain."""

    def __init__(self, c: Complex, domain: tuple[float, float]) -> None:
        self.c, self.domain = c, domain

    def value(self, t: Array) -> Array:
        n = len(self.c) // 2
        return np.asarray((np.exp(np.multiply.outer(t, np.arange(-n, n + 1))) @ self.c).real)

    def bound(self) -> float:
        n, farthest = len(self.c) // 2, max(abs(end) for end in self.domain)
        return float(np.abs(self.c) @ np.exp(np.abs(np.arange(-n, n + 1)) * farthest))

    def derivative(self) -> Exponential:
        n = len(self.c) // 2
        return Exponential(np.arange(-n, n + 1) * self.c, self.domain)

    def zeros(self) -> Array:
        z = polynomial_roots(self.c)
        z = z[(z.real > 0) & (np.abs(z.imag) < 1e-3 * np.abs(z))]
        t = np.sort(np.log(np.abs(z)))
        return t[(t > self.domain[0]) & (t < self.domain[1])]


class Chebyshev(Series):
    """Chebyshev series on a domain."""

    def __init__(self, c: Array, domain: tuple[float, float]) -> None:
        self.c, self.domain = c, domain
        self.middle, self.half = (domain[1] + domain[0]) / 2, (domain[1] - domain[0]) / 2

    def value(self, t: Array) -> Array:
        return np.asarray(chebyshev.chebval((t - self.middle) / self.half, self.c))

    def bound(self) -> float:
        return float(np.abs(self.c).sum())

    def derivative(self) -> Chebyshev:
        slope = np.asarray(chebyshev.chebder(self.c), dtype=np.float64)
        return Chebyshev(slope / self.half, self.domain)

    def zeros(self) -> Array:
        size = np.abs(self.c).max(initial=0.0)
        keep = np.nonzero(np.abs(self.c) > NO_TERM * size)[0]
        if size == 0.0 or keep[-1] == 0:
            return np.empty(0)
        s = chebyshev.chebroots(self.c[: keep[-1] + 1])
        s = np.asarray(s, dtype=complex)
        s = s[(np.abs(s.imag) < 1e-3) & (np.abs(s.real) < 1)]
        return np.sort(self.middle + self.half * s.real)


def series(curve: Curve, carrier: Carrier) -> Series:
    """The carrier's implicit polynomial along a conic."""
    degree = carrier.degree
    if curve.closed:
        t = np.linspace(0.0, 2 * np.pi, 16, endpoint=False)
        values = carrier.implicit(curve.point(t))
        return Fourier(trigonometric_fit(values, degree))
    if isinstance(curve, Hyperbola):
        t = np.linspace(0.0, 2 * np.pi, 16, endpoint=False)[:, None]
        points = (
            curve.centre + np.cos(t) * (curve.a * curve.x) + 1j * np.sin(t) * (curve.b * curve.y)
        )
        values = carrier.implicit(cast(Array, points))
        return Exponential(trigonometric_fit(values, degree), curve.domain)
    degree *= 2 if isinstance(curve, Parabola) else 1
    nodes = np.cos(np.pi * (np.arange(degree + 1) + 0.5) / (degree + 1))
    low, high = curve.domain
    values = carrier.implicit(curve.point((low + high) / 2 + (high - low) / 2 * nodes))
    matrix = chebyshev.chebvander(nodes, degree)
    return Chebyshev(np.asarray(np.linalg.solve(matrix, values), dtype=np.float64), curve.domain)
