"""The kind of a quadric by its invariants, in rational arithmetic: a check on the geometry."""

from __future__ import annotations

from itertools import pairwise, product

from flint import fmpq, fmpq_mat

from decomp.voronoi import Kind, Polynomial

SHARP = {
    # rank and inertia (larger, smaller) of the leading form, then of the whole
    ((3, 0), (3, 1)): "ellipsoid",
    ((2, 1), (3, 1)): "two-sheeted hyperboloid",
    ((2, 1), (2, 2)): "one-sheeted hyperboloid",
    ((2, 1), (2, 1)): "cone",
    ((2, 0), (3, 1)): "elliptic paraboloid",
    ((1, 1), (2, 2)): "hyperbolic paraboloid",
    ((2, 0), (2, 1)): "elliptic cylinder",
    ((1, 1), (2, 1)): "hyperbolic cylinder",
    ((1, 0), (2, 1)): "parabolic cylinder",
    ((1, 1), (1, 1)): "plane pair",
    ((2, 0), (2, 0)): "line",
    ((0, 0), (1, 1)): "plane",
}

NAMES = {
    ("ellipsoid", 3): Kind.SPHERE,
    ("ellipsoid", 2): Kind.PROLATE_SPHEROID,
    ("two-sheeted hyperboloid", 2): Kind.TWO_SHEETED_HYPERBOLOID,
    ("one-sheeted hyperboloid", 2): Kind.ONE_SHEETED_HYPERBOLOID,
    ("cone", 2): Kind.CIRCULAR_CONE,
    ("cone", 1): Kind.ELLIPTIC_CONE,
    ("elliptic paraboloid", 2): Kind.PARABOLOID,
    ("elliptic cylinder", 2): Kind.CIRCULAR_CYLINDER,
    ("elliptic cylinder", 1): Kind.ELLIPTIC_CYLINDER,
}
"""By how many eigenvalues of the leading form are equal."""

ALIKE = {
    "hyperbolic paraboloid": Kind.HYPERBOLIC_PARABOLOID,
    "hyperbolic cylinder": Kind.HYPERBOLIC_CYLINDER,
    "parabolic cylinder": Kind.PARABOLIC_CYLINDER,
    "plane pair": Kind.PLANE_PAIR,
    "plane": Kind.PLANE,
    "line": Kind.LINE,
}


def quadric_kind(polynomial: Polynomial) -> Kind:
    """What the zeros of a polynomial of degree at most 2 are."""
    whole = fmpq_mat(4, 4)
    for exponents, coefficient in polynomial.terms.items():
        factors = [axis for axis in range(3) for _ in range(exponents[axis])]
        factors += [3] * (2 - len(factors))
        i, j = factors
        share = fmpq(coefficient) if i == j else fmpq(coefficient, 2)
        whole[i, j] += share
        if i != j:
            whole[j, i] += share
    leading = fmpq_mat(3, 3)
    for i, j in product(range(3), repeat=2):
        leading[i, j] = whole[i, j]
    name = SHARP[_inertia(leading, whole)]
    if name in ALIKE:
        return ALIKE[name]
    return NAMES[name, _largest_multiplicity(leading)]


def _inertia(leading: fmpq_mat, whole: fmpq_mat) -> tuple[tuple[int, int], tuple[int, int]]:
    """Of both forms, with the sign chosen so that the leading form's larger part comes first."""
    plus, minus = _signs(leading)
    more, less = _signs(whole)
    if minus > plus or (minus == plus and less > more):
        plus, minus, more, less = minus, plus, less, more
    return (plus, minus), (more, less)


def _signs(matrix: fmpq_mat) -> tuple[int, int]:
    """Positive and negative eigenvalues: all are real, so Descartes' rule is exact."""
    coefficients = [c for c in matrix.charpoly().coeffs() if c != 0]
    changes = sum(a * b < 0 for a, b in pairwise(coefficients))
    zeros = next(k for k, c in enumerate(matrix.charpoly().coeffs()) if c != 0)
    return changes, matrix.nrows() - zeros - changes


def _largest_multiplicity(matrix: fmpq_mat) -> int:
    """Of the eigenvalues that are not zero."""
    _, factors = matrix.charpoly().factor()
    return max(
        (m for factor, m in factors if not (factor.degree() == 1 and factor[0] == 0)), default=0
    )
