"""The implicit polynomial of a shape, from its canonical equation.

Its coefficients are those of the shape's parameters, which are floats: where sites have exact
parameters, elimination gives the exact equation.
"""

from __future__ import annotations

from fractions import Fraction
from itertools import product

from decomp.voronoi.exact import Vector, exact, exact_vector
from decomp.voronoi.polynomial import (
    RING,
    Polynomial,
    Raw,
    height,
    rational,
    squared_distance_from_line,
)
from decomp.voronoi.shape import QUADRATICS, REVOLVED, Shape


def equation_of(shape: Shape) -> Polynomial:
    """The polynomial of a surface; of a union the product of its parts'."""
    origin = exact_vector(shape.origin, "an origin")
    if shape.parts:
        total = RING.from_dict({(0, 0, 0, 0): 1})
        for part in shape.parts:
            total *= equation_of(part).raw
        return Polynomial.of(total, origin)
    x, y, z = (exact_vector(axis, "an axis") for axis in shape.axes)
    if shape.kind in REVOLVED:
        return Polynomial.of(_revolved(shape, origin, z), origin)
    q, linear, constant = QUADRATICS[shape.kind](shape.parameters)
    w = [height(origin, axis) for axis in (x, y, z)]
    raw = RING.from_dict({}) + _number(constant)
    for i, j in product(range(3), repeat=2):
        raw += _number(q[i, j]) * w[i] * w[j]
    for i in range(3):
        raw += 2 * _number(linear[i]) * w[i]
    return Polynomial.of(raw, origin)


def _revolved(shape: Shape, origin: Vector, axis: Vector) -> Raw:
    """With E(rho, z) = A + B rho: A if B is zero, else A^2 - B^2 rho^2."""
    q, linear, constant = QUADRATICS[shape.kind](shape.parameters)
    square, z = squared_distance_from_line(origin, axis), height(origin, axis)
    even = _number(q[0, 0]) * square + _number(q[1, 1]) * z**2
    even += 2 * _number(linear[1]) * z + _number(constant)
    odd = 2 * _number(q[0, 1]) * z + 2 * _number(linear[0])
    return even if not len(odd) else even**2 - odd**2 * square


def _number(value: float) -> Raw:
    return RING.from_dict({(0, 0, 0, 0): rational(Fraction(exact(float(value))))})
