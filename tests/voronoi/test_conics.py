"""Ellipses, parabolas and hyperbolas as edge sites, and curves without an equation."""

from __future__ import annotations

import numpy as np
import pytest

from decomp.curves.base import Curve
from decomp.curves.ellipse import Ellipse
from decomp.curves.hyperbola import Hyperbola
from decomp.curves.parabola import Parabola
from decomp.vectors import Array, norm
from decomp.voronoi import (
    ConeSite,
    ConicSite,
    CurveSite,
    CylinderSite,
    Kind,
    PlaneSite,
    SphereSite,
    site_of,
    surface,
)
from tests.voronoi.independent import check

CENTRE, X, Y, Z = np.array([0.5, -0.25, 1.0]), *np.eye(3)
CONICS = [
    Ellipse(CENTRE, X, Y, 2.0, 1.0),
    Ellipse(CENTRE, Y, Z, 0.75, 1.5),
    Parabola(CENTRE, Y, Z, 0.5, domain=(-40.0, 40.0)),
    Hyperbola(CENTRE, Z, X, 0.5, 0.75, domain=(-5.0, 5.0)),
]
OTHERS = [
    PlaneSite((0, 0, "-1/2"), (1, 2, 2)),
    SphereSite((1, 2, 1), "3/4"),
    SphereSite((1, 0, 2), 0),
    CylinderSite((0, 1, 2), (2, 3, 6), "1/2"),
    CylinderSite((0, 1, 2), (2, 3, 6), 0),
    ConeSite((0, 2, 0), (0, 0, 1), "3/5", "4/5"),
]


@pytest.mark.parametrize("curve", CONICS)
@pytest.mark.parametrize("other", OTHERS)
def test_equidistant_points_lie_on_the_equation(curve: Curve, other: PlaneSite) -> None:
    for parity in ("even", "odd") if other.two_sided else ("even",):
        found = surface(curve, other, parity, size=5)
        assert found.kind in (Kind.GENERAL, Kind.EMPTY)
        assert isinstance(found.f, ConicSite)
        # outside another site, or inside it, there is always something
        points = check(found, count=24, needed=False)
        assert bool(len(points)) == (found.kind is Kind.GENERAL)


@pytest.mark.parametrize("curve", CONICS)
def test_distance_is_that_of_the_nearest_sample(curve: Curve) -> None:
    p = np.random.default_rng(1).uniform(-2, 3, size=(40, 3))
    site = site_of(curve)
    samples = curve.point(np.linspace(*curve.domain, 200001))
    nearest = np.array([norm(samples - q).min() for q in p])
    found = site.signed_distance(p)
    assert (found <= nearest + 1e-12).all()
    assert np.allclose(found, nearest, atol=1e-6)


def test_ellipse_with_equal_axes_is_a_circle() -> None:
    found = surface(Ellipse(CENTRE, X, Y, 1.0, 1.0), PlaneSite((0, 0, 0), (0, 0, 1)))
    assert found.kind is Kind.REVOLVED_PARABOLA
    assert found.degree == 4


def test_curve_without_an_equation() -> None:
    """A helix: no polynomial, but true points all the same."""

    class Helix(Ellipse):
        kind = "helix"

        def __post_init__(self) -> None:
            super().__post_init__()
            object.__setattr__(self, "closed", False)

        def point(self, t: Array) -> Array:
            return super().point(t) + 0.1 * np.asarray(t)[..., None] * Z

        def derivative(self, t: Array) -> Array:
            return np.asarray(super().derivative(t) + 0.1 * Z)

    found = surface(CurveSite(Helix(CENTRE, X, Y, 1.0, 1.0)), PlaneSite((0, 0, 0), (0, 0, 1)))
    assert found.kind is Kind.GENERAL
    assert found.polynomial is None and found.degree is None and found.equation is None
    on = found.project(CENTRE + np.random.default_rng(1).uniform(0, 0.3, size=(20, 3)))
    assert np.abs(found.difference(on)).max() <= 1e-12
