"""The other carrier's polynomial on a chart: F(u, v).

F has degree at most 2 in (cos u, sin u): all carriers vanish on polynomials whose top degree part
is a power of |p|^2 times a quadratic one, and |p|^2 is of degree 1 on every chart but that of an
elliptic cylinder, where all polynomials that are looked at are quadratic. In v it is a quadratic
polynomial on rulings and a trigonometric one of degree 2 on tube circles. With z = e^{iu} and
w = e^{iv} (or w = v on rulings),

    F(u, v) = Re[ phase z^{-m/2} w^{-n/2} P(z, w) ],    P = sum P_jk z^j w^k,

where the factor w^{-n/2} is left out on rulings. A whole isoline u = u0 on the carrier is a
factor z - e^{i u0} of P, and can be divided out.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from decomp.carriers import Carrier
from decomp.curves.intersect.charts import Chart
from decomp.curves.polynomial import Complex
from decomp.vectors import Array

SMALL = 1e-13
"""Coefficients below this part of the largest are zero."""


@dataclass(frozen=True, eq=False)
class Pulled:
    """Coefficients P (m + 1, n + 1) of a bivariate polynomial, real as above."""

    c: Complex
    round: bool
    phase: complex = 1.0

    @property
    def m(self) -> int:
        """Degree in z."""
        return int(self.c.shape[0]) - 1

    @property
    def n(self) -> int:
        """Degree in w."""
        return int(self.c.shape[1]) - 1

    def columns(self, u: Array) -> Complex:
        """Coefficients (..., n + 1) of F as a polynomial in w at each u."""
        z = np.exp(1j * np.multiply.outer(u, np.arange(self.m + 1) - self.m / 2))
        return np.asarray(self.phase * (z @ self.c))

    def derivatives(self, u: Array, v: Array) -> tuple[Array, ...]:
        """F, F_u, F_v, F_uu, F_uv, F_vv."""
        j = np.arange(self.m + 1) - self.m / 2
        z = self.phase * np.exp(1j * np.multiply.outer(u, j))
        z0, z1, z2 = (np.einsum("...j,jk->...k", f * z, self.c) for f in (1, 1j * j, -(j**2)))
        if self.round:
            k = np.arange(self.n + 1) - self.n / 2
            w0 = np.exp(1j * np.multiply.outer(v, k))
            w1, w2 = 1j * k * w0, -(k**2) * w0
        else:
            k = np.arange(self.n + 1.0)
            v = np.asarray(v, dtype=np.float64)[..., None]
            w0 = v**k
            w1 = k * v ** np.maximum(k - 1, 0)
            w2 = k * (k - 1) * v ** np.maximum(k - 2, 0)
        pairs = ((z0, w0), (z1, w0), (z0, w1), (z2, w0), (z1, w1), (z0, w2))
        return tuple(np.einsum("...k,...k->...", p, q).real for p, q in pairs)

    def along(self, u: float, v: float, order: int) -> float:
        """Derivative of F by v of any order (tube circles; 0 beyond the second on rulings)."""
        if not self.round:
            return 0.0
        k = np.arange(self.n + 1) - self.n / 2
        return float(((1j * k) ** order * np.exp(1j * k * v) @ self.columns(np.array(u))).real)

    def without(self, u0: float) -> Pulled:
        """Divide by the isoline u = u0."""
        z0 = np.exp(1j * u0)
        quotient = np.zeros((self.m, self.n + 1), complex)
        carry = np.zeros(self.n + 1, complex)
        for j in range(self.m, 0, -1):
            carry = self.c[j] + z0 * carry
            quotient[j - 1] = carry
        return Pulled(quotient, self.round, realness(quotient, self.round))

    def without_apex(self) -> Pulled:
        """Divide by v (rulings of a cone whose apex lies on the other carrier)."""
        return Pulled(self.c[:, 1:], self.round, self.phase)


def realness(c: Complex, round_: bool) -> complex:
    """The phase that makes F real, from its largest value at some places."""
    plain = Pulled(c, round_)
    u = np.linspace(0.1, 6.2, 13)
    columns = plain.columns(u)
    if round_:
        k = np.arange(plain.n + 1) - plain.n / 2
        values = (columns @ np.exp(1j * np.multiply.outer(k, u))).ravel()
    else:
        values = columns.ravel()
    top = values[np.argmax(np.abs(values))]
    return complex(np.conj(top) / np.abs(top)) if top != 0 else 1.0


def pulled(chart: Chart, b: Carrier) -> Pulled:
    """F by interpolation, scaled so that its largest coefficient is 1."""
    m = 8
    u = 2 * np.pi * np.arange(m) / m
    v = u if chart.round else np.array([-1.0, 0.0, 1.0])
    values = b.implicit(chart.point(u[:, None], v[None, :]))
    half = np.concatenate([np.arange(-2, 0), np.arange(3)])
    c = (np.fft.fft(values, axis=0) / m)[half]
    if chart.round:
        c = (np.fft.fft(c, axis=1) / m)[:, half]
        size = np.abs(c).max()
        if max(np.abs(c[:, [0, 4]]).max(), 0.0) <= SMALL * size:
            c = c[:, 1:4]
    else:
        low, mid, high = c.T
        c = np.stack([mid, (high - low) / 2, (high + low) / 2 - mid], axis=1)
        if np.abs(c[:, 2]).max() <= SMALL * np.abs(c).max():
            c = c[:, :2]
    size = np.abs(c).max()
    if np.abs(c[[0, 4]]).max() <= SMALL * size:
        c = c[1:4]
    c = c / size
    return Pulled(c, chart.round)
