"""Where curves meet carriers."""

from __future__ import annotations

from math import pi, sqrt

import numpy as np
import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

from decomp.carriers import CarrierTable, Cone, Cylinder, Plane, Sphere, Torus
from decomp.curves import (
    Circle,
    Ellipse,
    Hyperbola,
    Line,
    Parabola,
    crossing_candidates,
    crossings,
    may_cross,
    meeting_pairs,
)
from decomp.errors import ContactError
from tests.curves.cases import KINDS, ORIGIN, TOLERANCE, WINDOW, X, Y, Z, carriers, meet, unit

CIRCLE = Circle(ORIGIN, X, Y, 1.0)
TORUS = Torus(ORIGIN, Z, 2.0, 0.5)


@settings(
    max_examples=60,
    deadline=None,
    derandomize=True,
    suppress_health_check=[HealthCheck.too_slow],
)
@given(data=st.data())
def test_every_change_of_sign_is_a_crossing(data: st.DataObject) -> None:
    a, b, c = (data.draw(carriers(data.draw(st.sampled_from(KINDS)))) for _ in range(3))
    assume(not a.coincides(b, 1e-6, WINDOW))
    try:
        found = meet(a, b, WINDOW)
    except ContactError:
        assume(False)
    for one in found.curves:
        curve = one.curve
        hit = crossings(curve, c, TOLERANCE)
        p = curve.point(hit.parameters)
        off = np.abs(c.signed_distance(p))
        assert np.all(off <= np.where(hit.tangential, TOLERANCE, 1e-12 * WINDOW))
        t = np.linspace(*curve.domain, 801)
        path = curve.point(t)
        value = c.signed_distance(path)
        clear = np.minimum(np.abs(value[1:]), np.abs(value[:-1])) > TOLERANCE
        i = np.nonzero((value[1:] * value[:-1] < 0) & clear)[0]
        step = np.linalg.norm(np.diff(path, axis=0), axis=1).max()
        for k in i:
            assert len(p)
            assert np.linalg.norm(p - path[k], axis=1).min() <= 2 * step
        if len(p):
            assert len(crossing_candidates(curve, [c], TOLERANCE)) == 1
            assert may_cross(curve, c).all()


def test_line_through_torus() -> None:
    line = Line(ORIGIN, X, domain=(-5.0, 5.0))
    hit = crossings(line, TORUS, TOLERANCE)
    assert np.allclose(hit.parameters, [-2.5, -1.5, 1.5, 2.5], atol=1e-14)
    assert not hit.tangential.any()


def test_touches_are_found_once() -> None:
    top = Line(0.5 * Z, X, domain=(-5.0, 5.0))
    hit = crossings(top, TORUS, TOLERANCE)
    assert np.allclose(hit.parameters, [-2.0, 2.0], atol=1e-12)
    assert hit.tangential.all()
    side = crossings(CIRCLE, Plane(X, X), TOLERANCE)
    assert side.tangential.tolist() == [True]
    assert np.cos(side.parameters[0]) == pytest.approx(1.0, abs=1e-15)


@pytest.mark.parametrize("miss", [5e-10, -5e-10])
def test_a_near_touch_counts_as_one(miss: float) -> None:
    hit = crossings(CIRCLE, Plane((1 + miss) * X, X), TOLERANCE)
    assert hit.tangential.tolist() == [True]
    assert not len(crossings(CIRCLE, Plane((1 + 1e-6) * X, X), TOLERANCE).parameters)


def test_contained_curves() -> None:
    assert crossings(CIRCLE, Cylinder(ORIGIN, Z, 1.0), TOLERANCE).contained
    assert crossings(CIRCLE, Plane(ORIGIN, Z), TOLERANCE).contained
    (one,) = meet(Plane(0.2 * X + 1.4 * X, X), TORUS).curves
    assert crossings(one.curve, TORUS, TOLERANCE).contained


def test_the_cones_other_nappe_does_not_count() -> None:
    line = Line(0.1 * Y, Z, domain=(-5.0, 5.0))
    hit = crossings(line, Cone(ORIGIN, Z, pi / 4), TOLERANCE)
    assert np.allclose(hit.parameters, [0.1], atol=1e-14)


def test_conics_meet_a_sphere_where_algebra_says() -> None:
    sphere = Sphere(ORIGIN, 1.0)
    parabola = Parabola(ORIGIN, X, Y, 0.25, domain=(-3.0, 3.0))  # x = y^2
    y = sqrt((sqrt(5) - 1) / 2)
    assert np.allclose(crossings(parabola, sphere, TOLERANCE).parameters, [-y, y], atol=1e-14)
    hyperbola = Hyperbola(ORIGIN, X, Y, 0.5, 0.5, domain=(-3.0, 3.0))
    t = np.arccosh(4.0) / 2  # cosh 2t = 4
    assert np.allclose(crossings(hyperbola, sphere, TOLERANCE).parameters, [-t, t], atol=1e-14)
    ellipse = Ellipse(ORIGIN, X, Y, 2.0, 0.5)
    assert len(crossings(ellipse, sphere, TOLERANCE).parameters) == 4


def test_traced_curve_touches_a_plane() -> None:
    (one,) = meet(Sphere(0.5 * X, 1.0), Cylinder(ORIGIN, Z, 1.0)).curves
    top = float(one.curve.point(np.linspace(*one.curve.domain, 4001))[:, 2].max())
    extreme = crossings(one.curve, Plane((top + 1e-3) * Z, Z), TOLERANCE)
    assert not len(extreme.parameters)
    # z^2 = x - 1/4 on both: highest at x = 1
    touch = crossings(one.curve, Plane(sqrt(0.75) * Z, Z), TOLERANCE)
    assert touch.tangential.tolist() == [True]
    assert len(crossings(one.curve, Plane(ORIGIN, Y), TOLERANCE).parameters) == 2


@pytest.mark.parametrize("height", [0.5, 1.0, 2.0])
def test_touches_of_higher_order_are_one(height: float) -> None:
    """Where two carriers' curve osculates a third one it leaves it by the fourth power only."""
    along, upright = Cylinder(ORIGIN, X, height), Cylinder(ORIGIN, Z, height)
    ball = Sphere(height * Z, height)
    touch = height * (X + Z)
    for one, other, third in ((along, upright, ball), (along, ball, upright)):
        met = [
            (found.curve.point(hit.parameters), hit.tangential)
            for found in meet(one, other).curves
            for hit in [crossings(found.curve, third, TOLERANCE)]
        ]
        points = np.concatenate([points for points, _ in met])
        near = np.linalg.norm(points - touch, axis=1) < 0.1 * height
        tangential = np.concatenate([flags for _, flags in met])
        assert tangential[near].tolist() == [True]
        assert np.linalg.norm(points[near] - touch) < 1e-10 * height


def test_a_touch_at_the_end_of_the_domain_is_one() -> None:
    """The ellipse's parameter begins where it touches the sphere."""
    ellipse = Ellipse(ORIGIN, unit(*(X + Z)), Y, sqrt(2.0), 1.0)
    hit = crossings(ellipse, Sphere(Z, 1.0), TOLERANCE)
    assert hit.tangential.tolist() == [True]
    assert np.linalg.norm(ellipse.point(hit.parameters) - (X + Z)) < 1e-12


def test_candidates_of_many_carriers() -> None:
    grid = [Cylinder(i * X + j * Y, Z, 0.3) for i in range(20) for j in range(20)]
    table = CarrierTable(grid)
    circle = Circle(3 * X + 3 * Y, X, Y, 0.3)
    assert crossing_candidates(circle, table).tolist() == [63]
    line = Line(5 * X, Y, domain=(0.0, 7.4))
    assert crossing_candidates(line, table).tolist() == list(range(100, 108))


def test_pairs_that_may_meet() -> None:
    grid = [Cylinder(i * X + j * Y, Z, 0.3) for i in range(20) for j in range(20)]
    planes = [Plane(-Z, -Z), Plane(Z, Z), Plane(30 * X, unit(1, 0, 0))]
    pairs = meeting_pairs([*grid, *planes], 10 * (X + Y), 16.0, TOLERANCE)
    assert pairs == [(i, j) for i in range(400) for j in (400, 401)]
