"""Polynomials in x, y, z with exact rational coefficients, evaluated in floating point."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from math import gcd, lcm
from typing import Any, TypeAlias

import numpy as np
from flint import Ordering, fmpq, fmpq_mpoly, fmpq_mpoly_ctx

from decomp.vectors import Array
from decomp.voronoi.exact import Vector, exact_vector, inner

Raw: TypeAlias = fmpq_mpoly
"""A polynomial in x, y, z and the offset d, as the algebra library has it."""

RING = fmpq_mpoly_ctx.get(("x", "y", "z", "d"), Ordering.degrevlex)
X, Y, Z, D = RING.gens()
NAMES = ("x", "y", "z")


def rational(value: Fraction) -> fmpq:
    """A fraction as the algebra library has it."""
    return fmpq(value.numerator, value.denominator)


def linear(gradient: Vector, constant: Fraction) -> Raw:
    """gradient . (x, y, z) + constant."""
    terms = [rational(g) * v for g, v in zip(gradient, (X, Y, Z), strict=True)]
    return terms[0] + terms[1] + terms[2] + rational(constant)


def height(point: Vector, direction: Vector) -> Raw:
    """(p - point) . direction."""
    return linear(direction, -inner(direction, point))


def squared_distance(point: Vector) -> Raw:
    """|p - point|^2."""
    away = [v - rational(c) for v, c in zip((X, Y, Z), point, strict=True)]
    return away[0] ** 2 + away[1] ** 2 + away[2] ** 2


def squared_distance_from_line(point: Vector, direction: Vector) -> Raw:
    """Squared distance from the line through `point` along `direction` of any length."""
    square = sum((a * a for a in direction), Fraction())
    return squared_distance(point) - height(point, direction) ** 2 / rational(square)


@dataclass(frozen=True, eq=False)
class Polynomial:
    """A polynomial in x, y, z with coprime integer coefficients, the leading one positive.

    Args:
        raw: the polynomial, which does not contain d.
        centre: about which it is expanded for evaluation, to keep rounding errors low.
    """

    raw: Raw
    centre: Vector

    @staticmethod
    def of(raw: Raw, centre: Vector) -> Polynomial:
        """Make one of a multiple of it."""
        numbers = [Fraction(int(c.p), int(c.q)) for c in raw.coeffs()]
        if numbers:
            divisor = gcd(*[n.numerator for n in numbers])
            scale = Fraction(lcm(*[n.denominator for n in numbers]), divisor)
            raw = raw * rational(scale if numbers[0] > 0 else -scale)
        return Polynomial(raw, centre)

    @property
    def degree(self) -> int:
        """Total degree; -1 for the zero polynomial."""
        return int(self.raw.total_degree()) if len(self.raw) else -1

    @property
    def terms(self) -> dict[tuple[int, int, int], int]:
        """Coefficients by the exponents of x, y, z."""
        return {(int(e[0]), int(e[1]), int(e[2])): int(c.p) for e, c in self.raw.to_dict().items()}

    @property
    def text(self) -> str:
        """The equation, as in `x^2 - 8*y - z^2 = 0`."""
        return f"{self.raw} = 0"

    def __call__(self, p: Array) -> Array:
        """Values (...) at points (..., 3), in units of the largest coefficient about the centre."""
        return _values(self._expanded, self._local(p))

    def exactly(self, p: Array) -> Array:
        """The same values, computed in rational arithmetic (slow) and rounded once."""
        flat = np.asarray(p, dtype=np.float64).reshape(-1, 3)
        found = []
        for point in flat:
            x, y, z = (rational(Fraction(float(c))) for c in point)
            value = self.raw(x, y, z, fmpq(0))
            found.append(float(Fraction(int(value.p), int(value.q)) / self._largest))
        return np.array(found).reshape(np.shape(p)[:-1])

    def gradient(self, p: Array) -> Array:
        """Gradients (..., 3) of the values."""
        local = self._local(p)
        parts = [_values(_derivative(self._expanded, k), local) for k in range(3)]
        return np.stack(parts, axis=-1)

    def hessian(self, p: Array) -> Array:
        """Second derivatives (..., 3, 3) of the values."""
        local = self._local(p)
        rows = []
        for i in range(3):
            first = _derivative(self._expanded, i)
            rows.append(np.stack([_values(_derivative(first, j), local) for j in range(3)], -1))
        return np.stack(rows, axis=-2)

    def divides(self, other: Polynomial) -> bool:
        """Whether `other` is a multiple of this polynomial."""
        _, rest = divmod(other.raw, self.raw)
        return not len(rest)

    def _local(self, p: Array) -> Array:
        return np.asarray(p - np.array([float(c) for c in self.centre]), dtype=np.float64)

    @cached_property
    def _shifted(self) -> dict[tuple[int, int, int], Fraction]:
        """The terms about the centre."""
        x, y, z = (v + rational(c) for v, c in zip((X, Y, Z), self.centre, strict=True))
        items = self.raw.compose(x, y, z, D).to_dict().items()
        return {(int(e[0]), int(e[1]), int(e[2])): Fraction(int(c.p), int(c.q)) for e, c in items}

    @cached_property
    def _largest(self) -> Fraction:
        return max((abs(n) for n in self._shifted.values()), default=Fraction(1))

    @cached_property
    def _expanded(self) -> tuple[Array, Any]:
        """Coefficients (m,), the largest 1 in size, and exponents (m, 3) about the centre."""
        exponents = np.array(list(self._shifted), dtype=np.int64).reshape(-1, 3)
        return np.array([float(n / self._largest) for n in self._shifted.values()]), exponents


def polynomial(raw: Raw, centre: Any = (0, 0, 0)) -> Polynomial:
    """A polynomial, expanded about `centre` for evaluation."""
    return Polynomial.of(raw, exact_vector(centre, "centre"))


def _derivative(terms: tuple[Array, Any], axis: int) -> tuple[Array, Any]:
    coefficients, exponents = terms
    lower = exponents.copy()
    lower[:, axis] = np.maximum(lower[:, axis] - 1, 0)
    return coefficients * exponents[:, axis], lower


def _values(terms: tuple[Array, Any], p: Array) -> Array:
    coefficients, exponents = terms
    if not len(coefficients):
        return np.zeros(p.shape[:-1])
    powers = np.ones((int(exponents.max()) + 1, *p.shape))
    for k in range(1, len(powers)):
        powers[k] = powers[k - 1] * p
    total = np.zeros(p.shape[:-1])
    for c, (i, j, k) in zip(coefficients, exponents, strict=True):
        total = total + c * powers[i, ..., 0] * powers[j, ..., 1] * powers[k, ..., 2]
    return total
