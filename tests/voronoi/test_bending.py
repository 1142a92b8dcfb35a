"""Curvatures of Voronoi surfaces of all sites, edge curves included."""

from __future__ import annotations

from itertools import combinations_with_replacement

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from decomp.carriers import Cylinder
from decomp.curves import intersect
from decomp.curves.base import Curve
from decomp.curves.ellipse import Ellipse
from decomp.curves.hyperbola import Hyperbola
from decomp.curves.parabola import Parabola
from decomp.errors import GeometryError
from decomp.vectors import Array, frame, norm
from decomp.voronoi import PlaneSite, SphereSite, VoronoiSite, VoronoiSurface, surface
from decomp.voronoi.curve_site import CurveSite
from tests.voronoi.independent import equidistant_points
from tests.voronoi.instances import FEW, SITES, surfaces_of

PAIRS = list(combinations_with_replacement(SITES, 2))
CENTRE, X, Y, Z = np.array([0.5, -0.25, 1.0]), *np.eye(3)


def crossing_of_cylinders() -> Curve:
    """An edge that is neither line, circle nor conic: where cylinders of two radii cross."""
    one, two = Cylinder(np.zeros(3), Z, 1.0), Cylinder(np.array([0.0, 0.1, 0.0]), X, 0.6)
    (curve, _) = (found.curve for found in intersect(one, two, np.zeros(3), 9.0, 1e-9).curves)
    assert curve.kind == "curve"
    return curve


CURVES = {
    "ellipse": Ellipse(CENTRE, X, Y, 2.0, 1.0),
    "parabola": Parabola(CENTRE, Y, Z, 0.5, domain=(-4.0, 4.0)),
    "hyperbola": Hyperbola(CENTRE, Z, X, 0.5, 0.75, domain=(-2.0, 2.0)),
    "crossing": crossing_of_cylinders(),
}


def differences(site: VoronoiSite, p: Array) -> Array:
    """Hessians (k, 3, 3) of the signed distance at points (k, 3) by differences."""
    h = 1e-4 * np.eye(3)
    steps = np.array([[[u + v, u - v, v - u, -u - v] for v in h] for u in h])
    values = site.signed_distance(p[:, None, None, None] + steps)
    return np.asarray(values @ np.array([1, -1, -1, 1]) / 4e-8)


@pytest.mark.parametrize("curve", CURVES.values(), ids=CURVES)
def test_hessians_of_curves(curve: Curve) -> None:
    """Second derivatives of the distance, beyond an end too."""
    site = CurveSite(curve)
    p = curve.bounding_ball()[0] + np.random.default_rng(1).uniform(-2, 2, size=(20, 3))
    d = np.abs(site.signed_distance(p))
    for known, found, far in zip(site.hessian(p), differences(site, p), d, strict=True):
        # close to a centre of curvature, or between two feet, differences are of no use
        if far > 0.2 and np.abs(found).max() < 20:
            assert np.allclose(known, found, atol=1e-4 * (1 + np.abs(found).max()) ** 3)


@pytest.mark.parametrize(("one", "two"), PAIRS)
@FEW
@given(st.data())
def test_curvatures_agree_with_the_polynomial(one: str, two: str, data: st.DataObject) -> None:
    f, g = data.draw(SITES[one]), data.draw(SITES[two])
    for found in surfaces_of(f, g):
        if found.polynomial is None or found.kind.dimension < 2:
            continue
        for p in equidistant_points(found, seed=3, count=20)[:3]:
            slope = found.polynomial.gradient(p)
            bent = found.polynomial.hessian(p)
            steep = norm(slope) > 1e-3 * np.abs(bent).max() * found.size
            if not steep or norm(found.difference_gradient(p)) < 1e-2:
                continue
            made = found.curvatures(p)
            sign = np.sign(slope @ made.normal)
            across = np.stack(frame(made.normal))
            expected = np.linalg.eigvalsh(sign * across @ bent @ across.T / norm(slope))
            assert abs(float(slope @ made.normal)) == pytest.approx(float(norm(slope)), rel=1e-6)
            assert np.allclose(made.values, expected, rtol=1e-4, atol=1e-4 / found.size)


def surfaces_of_a_crossing() -> list[VoronoiSurface]:
    curve = CURVES["crossing"]
    others = [PlaneSite((0, 0, -2), (0, 0, 1)), SphereSite((3, 0, 0), 1), CURVES["ellipse"]]
    return [surface(curve, other, size=4) for other in others]


@pytest.mark.parametrize("found", surfaces_of_a_crossing(), ids=lambda found: found.g.name)
def test_edge_without_an_equation(found: VoronoiSurface) -> None:
    """Section 3.1 at a point: evaluation, gradient, projection, membership and curvatures."""
    start = np.array([0.9, 0.0, 0.0]) + np.random.default_rng(2).uniform(-0.8, 0.8, size=(30, 3))
    on = found.project(start)
    assert np.abs(found.difference(on)).max() <= 1e-12
    assert found.contains(on).all() and not found.contains(on + 0.01).any()
    made = found.curvatures(on)
    # along the principal directions the surface leaves its tangent plane by k s^2 / 2
    s = 1e-3
    for k in range(2):
        ahead = on + s * made.directions[:, k]
        back = found.project(ahead)
        rise = -np.einsum("ij,ij->i", back - on, made.normal)
        clear = np.abs(made.values[:, k]) < 5
        assert np.allclose(rise[clear] / s**2 * 2, made.values[clear, k], atol=0.05)
    assert found.polynomial is None and found.degree is None
    assert found.remark is not None and "no equation: the distance from an edge" in found.remark
    with pytest.raises(GeometryError, match="change alike"):
        twin = surface((0, 0, 0), (1, 0, 0))
        twin.curvatures(np.array([5.0, 0.0, 0.0]))
