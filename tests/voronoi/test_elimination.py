"""Elimination of the offset: the paper's section 3.2 and its example."""

from __future__ import annotations

from itertools import combinations_with_replacement

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from decomp.errors import InputError
from decomp.voronoi import CylinderSite, Kind, Polynomial, surface
from decomp.voronoi.elimination import by_subtraction, eliminate, in_two_steps, squarefree
from decomp.voronoi.polynomial import X, Y, Z, polynomial
from tests.voronoi.independent import check, equidistant_points
from tests.voronoi.instances import FEW, SITES

F = CylinderSite((0, 2, 0), (0, 0, 1), 1)
G = CylinderSite((0, -2, 0), (1, 0, 0), 1)

PAIRS = list(combinations_with_replacement(SITES, 2))


def test_even_surface_of_the_example() -> None:
    even = surface(F, G, "even")
    assert even.kind is Kind.HYPERBOLIC_PARABOLOID
    assert even.degree == 2
    assert even.polynomial is not None
    assert even.polynomial.raw == X**2 - 8 * Y - Z**2
    check(even)


def test_odd_surface_of_the_example() -> None:
    odd = surface(F, G, "odd")
    paper = X**2 + (Y - 2) ** 2 - (1 + (X**2 - 8 * Y - Z**2) / 4) ** 2
    assert odd.polynomial is not None
    assert odd.polynomial.raw == polynomial(paper).raw
    assert odd.degree == 4
    # the cylinders do not meet: no point is inside one and outside the other at equal distance
    assert not len(equidistant_points(odd, seed=1))


@pytest.mark.parametrize(("one", "two"), PAIRS)
@FEW
@given(st.data())
def test_all_ways_agree(one: str, two: str, data: st.DataObject) -> None:
    """One subtraction, two steps and the resultant have the same irreducible factors.

    The subtraction and the two steps may only lose factors that the resultant has from the
    leading coefficients.
    """
    f, g = data.draw(SITES[one]), data.draw(SITES[two])
    for e in (1, -1):
        a, b = f.offset(1), g.offset(e)
        full = a.resultant(b, "d")
        assume(len(full))
        whole = Polynomial.of(squarefree(full), f.reference)
        for way in (by_subtraction, in_two_steps):
            raw = way(a, b)
            if raw is None or raw.is_constant():
                continue
            found = Polynomial.of(squarefree(raw), f.reference)
            if way is by_subtraction:
                assert found.divides(whole)
                assert whole.degree == found.degree
            else:
                assert whole.divides(found) or found.divides(whole)


@pytest.mark.parametrize(("one", "two"), PAIRS)
@FEW
@given(st.data())
def test_recognised_equations_divide_the_elimination(
    one: str, two: str, data: st.DataObject
) -> None:
    """The equation of a special kind is a factor of what elimination finds."""
    f, g = data.draw(SITES[one]), data.draw(SITES[two])
    for parity in ("even", "odd") if f.two_sided or g.two_sided else ("even",):
        try:
            found = surface(f, g, parity)
            whole = eliminate(f, g, found.parity.sign)
        except InputError:
            assume(False)
        if found.polynomial is not None and found.kind.dimension == 2:
            assert found.polynomial.divides(whole)
