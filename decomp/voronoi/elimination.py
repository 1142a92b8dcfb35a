"""Elimination of the offset d from two offset equations (the paper's section 3.2)."""

from __future__ import annotations

from flint import fmpq

from decomp.errors import InputError
from decomp.voronoi.conic_site import ConicSite
from decomp.voronoi.polynomial import RING, Polynomial, Raw
from decomp.voronoi.sites import CarrierSite


def eliminate(f: CarrierSite | ConicSite, g: CarrierSite | ConicSite, e: int) -> Polynomial:
    """The squarefree polynomial of the surface s_f = e s_g.

    It is found by one subtraction where that leaves no d, in two steps where it leaves d linear
    or one offset is linear in d, else by a resultant.

    Raises:
        InputError: the offsets have a common factor: the sites coincide.
    """
    raw = without_offset(f.offset(1), g.offset(e))
    if not len(raw):
        raise InputError("the two sites coincide: every point is equidistant from them")
    return Polynomial.of(squarefree(raw), f.reference)


def without_offset(one: Raw, two: Raw) -> Raw:
    """Both offsets without d, zero if they have a common factor."""
    squares = [_in_square(raw) for raw in (one, two)]
    if squares[0] is not None and squares[1] is not None:
        # both know d^2 only, as those of points and curves do
        one, two = squares[0], squares[1]
    raw = by_subtraction(one, two)
    if raw is None:
        raw = in_two_steps(one, two)
    return one.resultant(two, "d") if raw is None else raw


def _in_square(raw: Raw) -> Raw | None:
    """The same with d in place of d^2, None if it has odd powers of d."""
    terms = raw.to_dict().items()
    if any(int(e[3]) % 2 for e, _ in terms):
        return None
    return RING.from_dict({(*e[:3], int(e[3]) // 2): c for e, c in terms})


def by_subtraction(one: Raw, two: Raw) -> Raw | None:
    """Their difference, scaled so that the highest powers of d cancel, if it is free of d."""
    difference = _difference(one, two)
    return None if difference is None or _degree(difference) > 0 else difference


def in_two_steps(one: Raw, two: Raw) -> Raw | None:
    """d from an equation linear in it, put into an offset.

    The linear equation is an offset itself or the difference of the two.
    """
    for linear, other in ((one, two), (two, one), (_difference(one, two), one)):
        if linear is None or _degree(linear) != 1:
            continue
        slope, rest = _coefficient(linear, 1), _coefficient(linear, 0)
        # other(-rest / slope) slope^n
        n = _degree(other)
        total = RING.from_dict({})
        for k in range(n + 1):
            total += _coefficient(other, k) * (-rest) ** k * slope ** (n - k)
        return total
    return None


def squarefree(raw: Raw) -> Raw:
    """The product of the irreducible factors, each once."""
    _, factors = raw.factor_squarefree()
    result = RING.from_dict({(0, 0, 0, 0): 1})
    for factor, _ in factors:
        result *= factor
    return result


def _degree(raw: Raw) -> int:
    return int(raw.degrees()[3]) if len(raw) else 0


def _coefficient(raw: Raw, power: int) -> Raw:
    """Of d to a power."""
    terms = {(*e[:3], 0): c for e, c in raw.to_dict().items() if e[3] == power}
    return RING.from_dict(terms)


def _difference(one: Raw, two: Raw) -> Raw | None:
    """one - c two without the highest power of d, if both have it with constant factors."""
    n = _degree(one)
    if n != _degree(two):
        return None
    a, b = _coefficient(one, n), _coefficient(two, n)
    if not (a.is_constant() and b.is_constant()):
        return None
    ratio = fmpq(a.leading_coefficient()) / fmpq(b.leading_coefficient())
    return one - ratio * two
