"""The eight equations of section 3.1, for all pairs of the five carriers."""

from __future__ import annotations

from itertools import combinations_with_replacement

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from decomp.errors import GeometryError, InputError
from decomp.vectors import Array, frame
from decomp.voronoi import (
    ConeSite,
    CylinderSite,
    Kind,
    Parity,
    PlaneSite,
    Polynomial,
    SphereSite,
    surface,
)
from decomp.voronoi.procedure import Status, solve, voronoi_points
from tests.voronoi.independent import equidistant_points
from tests.voronoi.instances import FEW, SITES

CARRIERS = ("plane", "sphere", "cylinder", "cone", "torus")
PAIRS = list(combinations_with_replacement(CARRIERS, 2))


def implicit_curvatures(polynomial: Polynomial, p: Array, normal: Array) -> Array:
    """Principal curvatures (2,) of the polynomial's surface, for a given sense of its normal."""
    gradient = polynomial.gradient(p)
    size = np.linalg.norm(gradient)
    sign = np.sign(gradient @ normal)
    across = np.stack(frame(normal))
    return np.linalg.eigvalsh(sign * across @ polynomial.hessian(p) @ across.T / size)


@pytest.mark.parametrize(("one", "two"), PAIRS)
@FEW
@given(st.data())
def test_solutions_are_points_of_the_surface(one: str, two: str, data: st.DataObject) -> None:
    """Normal and curvatures agree with those of the eliminated polynomial."""
    f, g = data.draw(SITES[one]), data.draw(SITES[two])
    for parity in Parity:
        try:
            found = surface(f, g, parity)
        except InputError:
            assume(False)
        if found.kind.dimension < 2:
            continue
        assert found.polynomial is not None
        for p in equidistant_points(found, seed=4, count=12)[:2]:
            solutions = [
                s
                for s in voronoi_points(f, g, p, 1e-6 * found.size)
                if s.status is Status.TRUE and s.parity is parity
            ]
            scale = found.size
            if np.linalg.norm(found.difference_gradient(p)) < 1e-3:
                continue
            if abs(float(f.signed_distance(p))) < 1e-6 * scale:
                continue
            assert solutions
            if len(solutions) > 1:
                # close to a reflexive locus, where one site has two nearest points
                feet = np.array([s.feet for s in solutions])
                assert np.ptp(feet, axis=0).max() > 1e-3 * scale
                continue
            solution = solutions[0]
            assert solution.residual <= 1e-11 * scale
            assert np.allclose(solution.feet, [f.foot(p), g.foot(p)], atol=1e-6 * scale)
            assert solution.distance == pytest.approx(abs(float(f.signed_distance(p))), abs=1e-6)
            slope = found.polynomial.gradient(solution.point)
            spread = np.abs(found.polynomial.hessian(solution.point)).max()
            if np.linalg.norm(slope) < 1e-4 * spread * scale:
                continue
            unit = slope / np.linalg.norm(slope)
            assert abs(float(unit @ solution.normal)) == pytest.approx(1, abs=1e-9)
            expected = implicit_curvatures(found.polynomial, solution.point, solution.normal)
            assert np.allclose(solution.curvatures, expected, rtol=1e-5, atol=1e-5 / found.size)


def test_extraneous_solutions_are_recognised() -> None:
    """Two cylinders: 2 x 2 feet; beyond a tip of the odd surface its zeros are not true."""
    f = CylinderSite((0, "1/4", 0), (0, 0, 1), 1)
    g = CylinderSite((0, "-1/4", 0), (1, 0, 0), 1)
    odd = surface(f, g, "odd")
    assert odd.polynomial is not None
    # on the axis of f, beyond its tip, one foot of g is farther than the other
    start = np.array([0.02, 0.25, 2.3])
    solutions = voronoi_points(f, g, start, 1.0)
    kinds = {(s.parity, s.status) for s in solutions}
    assert (Parity.ODD, Status.NOT_NEAREST) in kinds
    for s in solutions:
        assert s.residual <= 1e-12
        both = surface(f, g, s.parity)
        # the polynomial of its parity vanishes, true or not
        assert both.polynomial is not None
        slope = np.linalg.norm(both.polynomial.gradient(s.point))
        assert abs(float(both.polynomial(s.point))) <= 1e-9 * slope
        if s.status is Status.TRUE:
            assert both.contains(s.point)
    assert {s.status for s in solutions} <= set(Status)


def test_example_of_the_paper() -> None:
    """Equations (1): unit cylinders about (0, 2, *) and (*, -2, 0)."""
    f, g = CylinderSite((0, 2, 0), (0, 0, 1), 1), CylinderSite((0, -2, 0), (1, 0, 0), 1)
    for s in voronoi_points(f, g, np.array([1.0, 0.1, 0.5]), 2.0):
        (x, y, z), (u1, u2, u3), (v1, v2, v3), d = s.point, *s.feet, s.distance
        values = [
            u1**2 + (u2 - 2) ** 2 - 1,
            (x - u1) ** 2 + (y - u2) ** 2 + (z - u3) ** 2 - d**2,
            v3**2 + (v2 + 2) ** 2 - 1,
            (x - v1) ** 2 + (y - v2) ** 2 + (z - v3) ** 2 - d**2,
            z - u3,
            (x - u1) * (2 - u2) + (y - u2) * u1,
            x - v1,
            -(y - v2) * v3 + (z - v3) * (v2 + 2),
        ]
        assert np.abs(values).max() <= 1e-12
        if s.status is Status.TRUE:
            assert s.parity is Parity.EVEN
            assert abs(x**2 - 8 * y - z**2) <= 1e-12


def test_singular_feet_are_refused() -> None:
    """At a cone's apex the tangents vanish, and every point would satisfy the equations."""
    f, g = ConeSite((0, 0, 0), (0, 0, 1), "3/5", "4/5"), PlaneSite((0, 0, -2), (0, 0, 1))
    one, two = (Polynomial.of(s.offset(0), s.reference) for s in (f, g))
    p = np.array([0.1, 0.0, -1.0])
    with pytest.raises(GeometryError, match="singular"):
        solve(one, two, p, np.zeros(3), g.foot(p))
    with pytest.raises(InputError, match="not for a line"):
        voronoi_points(CylinderSite((0, 0, 0), (0, 0, 1), 0), g, p, 1.0)


def test_kinds_are_not_needed() -> None:
    """The procedure knows nothing of special positions."""
    f, g = CylinderSite((0, 2, 0), (0, 0, 1), 1), CylinderSite((0, -2, 0), (0, 0, 1), 1)
    assert surface(f, g, "even").kind is Kind.PLANE
    (s,) = [
        s
        for s in voronoi_points(f, g, np.array([1.0, 0.0, 0.5]), 1.0)
        if s.status is Status.TRUE and s.parity is Parity.EVEN
    ]
    assert np.allclose(s.curvatures, 0, atol=1e-12)


def test_where_there_is_no_tangent_plane() -> None:
    """On the normal at a contact the distances change alike: refused, not left out."""
    f, g = PlaneSite((0, 0, 0), (0, 0, 1)), SphereSite((0, 0, 1), 1)
    with pytest.raises(GeometryError, match="change alike"):
        voronoi_points(f, g, np.array([0.0, 0.0, 0.5]), 0.1)
