"""The table of degrees, at sites in general position."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest

from decomp.curves.base import Curve
from decomp.curves.ellipse import Ellipse
from decomp.curves.hyperbola import Hyperbola
from decomp.curves.parabola import Parabola
from decomp.voronoi import (
    CarrierSite,
    ConeSite,
    ConicSite,
    CylinderSite,
    Kind,
    Parity,
    PlaneSite,
    SphereSite,
    TorusSite,
    VoronoiSite,
    site_of,
    surface,
)
from decomp.voronoi.degrees import GENERAL_DEGREE, degree_on_line, general_degree
from decomp.voronoi.exact import Vector, unit
from tests.voronoi.instances import WAYS, across

CONICS = ("ellipse", "hyperbola", "parabola")


def draw(rng: np.random.Generator) -> Vector:
    a, b, c = (Fraction(int(k), 16) for k in rng.integers(-80, 80, size=3))
    return a, b, c


def conic(kind: str, rng: np.random.Generator) -> VoronoiSite:
    """One in general position, its frame exact."""
    x, y = across(WAYS[int(rng.integers(3, len(WAYS)))])
    centre = np.array([float(c) for c in draw(rng)])
    b, a = np.cumsum(rng.integers(5, 20, size=2)) / 16
    u, v = unit(x), unit(y)
    curve: Curve = {
        "ellipse": lambda: Ellipse(centre, u, v, a, b),
        "hyperbola": lambda: Hyperbola(centre, u, v, a, b),
        "parabola": lambda: Parabola(centre, u, v, a),
    }[kind]()
    found = site_of(curve)
    assert isinstance(found, ConicSite)
    return replace(found, x=x, y=y)


def site(kind: str, rng: np.random.Generator) -> VoronoiSite:
    """One in general position, with lengths of directions that are rational."""
    if kind in CONICS:
        return conic(kind, rng)
    p = draw(rng)
    ways = [(1, 2, 2), (2, 3, 6), (-3, 6, 2), (4, -4, 7), (8, 4, 1), (2, 6, -9)]
    way = ways[int(rng.integers(len(ways)))]
    r, s = (Fraction(int(k), 16) for k in rng.integers(5, 40, size=2))
    return {
        "plane": lambda: PlaneSite(p, way),
        "sphere": lambda: SphereSite(p, r),
        "cylinder": lambda: CylinderSite(p, way, r),
        "cone": lambda: ConeSite(p, way, Fraction(20, 29), Fraction(21, 29)),
        "torus": lambda: TorusSite(p, way, r + s, r),
        "point": lambda: SphereSite(p, 0),
        "line": lambda: CylinderSite(p, way, 0),
        "circle": lambda: TorusSite(p, way, r, 0),
    }[kind]()


@pytest.mark.parametrize(("one", "two"), GENERAL_DEGREE)
def test_general_degree(one: str, two: str) -> None:
    """By elimination in space and on a line; the equation is irreducible over the rationals."""
    rng = np.random.default_rng(5)
    f, g = site(one, rng), site(two, rng)
    while one == two and getattr(f, "axis", 0) == getattr(g, "axis", 1):
        g = site(two, rng)
    assert general_degree(one, two) == general_degree(two, one)
    for parity in list(Parity) if f.two_sided or g.two_sided else [Parity.EVEN]:
        found = surface(f, g, parity)
        assert isinstance(f, (CarrierSite, ConicSite)) and isinstance(g, (CarrierSite, ConicSite))
        degree = general_degree(one, two)
        assert degree_on_line(f, g, parity.sign, draw(rng), draw(rng)) == degree
        if one in CONICS and two in CONICS:
            assert found.polynomial is None and found.degree == degree
            continue
        if found.kind is Kind.EMPTY:
            continue
        assert found.degree == degree
        assert found.polynomial is not None
        if degree > 16:
            continue
        _, factors = found.polynomial.raw.factor()
        assert [n for _, n in factors] == [1]
    assert found.f.name == one and found.g.name == two


def test_sixteen_is_the_degree_of_both_parities_together() -> None:
    """Two tori: the paper's 16 is that of the product of the even and the odd surface."""
    rng = np.random.default_rng(6)
    f, g = site("torus", rng), site("torus", rng)
    even, odd = surface(f, g, "even").polynomial, surface(f, g, "odd").polynomial
    assert even is not None and odd is not None
    assert (even.raw * odd.raw).total_degree() == 16
