"""Theorem 4.9: a cone and a cone or torus."""

from __future__ import annotations

from fractions import Fraction
from math import pi

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from decomp.voronoi import ConeSite, Kind, TorusSite, surface
from decomp.voronoi.exact import Vector, floats
from tests.voronoi.independent import check, equidistant_points
from tests.voronoi.instances import FEW, across, angles, at, numbers, on, points, radii, ways

Angle = tuple[Fraction, Fraction]


def reverse(way: Vector) -> Vector:
    return on((Fraction(0), Fraction(0), Fraction(0)), way, Fraction(-1))


@FEW
@given(points, ways, angles, angles, numbers)
def test_coaxial(p: Vector, way: Vector, one: Angle, two: Angle, h: Fraction) -> None:
    """(i) Cones: the bisectors of the rulings, turned. One inside the other there is no even one.

    It is the apex alone if they share it.
    """
    assume(one != two)
    f, g = ConeSite(p, way, *one), ConeSite(at(p, way, h), way, *two)
    a, b = f.carrier.angle, g.carrier.angle
    for parity, half in (("odd", (a + b) / 2), ("even", pi / 2 - (a + b) / 2)):
        found = surface(f, g, parity)
        if parity == "even" and float(h) * (b - a) <= 0:
            assert found.kind is (Kind.EMPTY if h else Kind.POINT)
            check(found, needed=False)
            continue
        assert found.kind is Kind.CIRCULAR_CONE
        assert found.degree == 2
        assert found.shape is not None
        assert found.shape.parameters["half_angle"] == pytest.approx(half)
        check(found, needed=False)


@FEW
@given(points, ways, angles, angles, st.integers(0, 9))
def test_back_to_back(p: Vector, way: Vector, one: Angle, two: Angle, h: int) -> None:
    """(i) Opening away from each other: a plane half-way for equal angles, else a cone (even).

    Its half-angle is 90 degrees less half the difference. There is no odd surface, but the apex
    if they share it.
    """
    f, g = ConeSite(p, way, *one), ConeSite(at(p, way, Fraction(-h)), reverse(way), *two)
    even, odd = surface(f, g, "even"), surface(f, g, "odd")
    assert odd.kind is (Kind.EMPTY if h else Kind.POINT)
    assert even.shape is not None
    if one == two:
        assert (even.kind, even.degree) == (Kind.PLANE, 1)
        assert even.shape.deviation(floats(at(p, way, Fraction(-h, 2)))) <= 1e-12
    else:
        half = pi / 2 - abs(f.carrier.angle - g.carrier.angle) / 2
        assert (even.kind, even.degree) == (Kind.CIRCULAR_CONE, 2)
        assert even.shape.parameters["half_angle"] == pytest.approx(half)
    check(even)
    assert not len(equidistant_points(odd, seed=1, count=60))


@FEW
@given(points, ways, angles, st.integers(1, 9))
def test_coaxial_of_equal_angle(p: Vector, way: Vector, angle: Angle, h: int) -> None:
    """Shifted along the axis: a cone (odd). Facing each other: a plane (even), a cylinder (odd)."""
    f, g = ConeSite(p, way, *angle), ConeSite(at(p, way, Fraction(h)), way, *angle)
    odd = surface(f, g, "odd")
    assert odd.kind is Kind.CIRCULAR_CONE
    assert odd.shape is not None
    assert odd.shape.parameters["half_angle"] == pytest.approx(f.carrier.angle)
    assert surface(f, g, "even").kind is Kind.EMPTY
    back = ConeSite(at(p, way, Fraction(h)), reverse(way), *angle)
    even, odd = surface(f, back, "even"), surface(f, back, "odd")
    assert even.kind is Kind.PLANE
    assert odd.kind is Kind.CIRCULAR_CYLINDER
    assert odd.shape is not None
    assert odd.shape.parameters["radius"] == pytest.approx(h * np.tan(f.carrier.angle) / 2)
    check(even)
    check(odd)


@FEW
@given(points, ways, angles, numbers, radii)
def test_parallel_axes_and_equal_angle(
    p: Vector, way: Vector, angle: Angle, h: Fraction, gap: Fraction
) -> None:
    """Not in the paper: rho_f -+ rho_g is constant, a cylinder over a conic about both axes.

    A plane or hyperbolic cylinder (even) if both open the same way, an elliptic cylinder (odd) if
    they face each other.
    """
    x, _ = across(way)
    f, top = ConeSite(p, way, *angle), at(at(p, way, h), x, gap)
    climb = abs(float(h)) * np.tan(f.carrier.angle)
    assume(abs(climb - float(gap)) > 1e-9)
    even = surface(f, ConeSite(top, way, *angle), "even")
    if h == 0:
        assert even.kind is Kind.PLANE
    elif climb < gap:
        assert even.kind is Kind.HYPERBOLIC_CYLINDER
    else:
        assert even.kind is Kind.EMPTY
    check(even, needed=climb < gap) if even.kind is not Kind.EMPTY else None
    odd = surface(f, ConeSite(top, reverse(way), *angle), "odd")
    if h > 0 and climb > gap:
        assert odd.kind is Kind.ELLIPTIC_CYLINDER
        assert odd.degree == 2
        check(odd)
    else:
        assert odd.kind is Kind.EMPTY


@FEW
@given(points, ways, angles, radii, radii, numbers)
def test_torus(
    p: Vector, way: Vector, angle: Angle, r: Fraction, more: Fraction, h: Fraction
) -> None:
    """(ii) A parabola turned about a line that is not across its axis; a cone if they touch."""
    f, g = ConeSite(p, way, *angle), TorusSite(at(p, way, h), way, r + more, r)
    sine, cosine = angle
    for parity, e in (("even", 1), ("odd", -1)):
        found = surface(f, g, parity)
        assert found.shape is not None
        depth = r + e * ((r + more) * cosine - h * sine)
        if depth < 0:
            assert found.kind is Kind.EMPTY
        elif depth == 0:
            assert found.kind is Kind.CIRCULAR_CONE
            assert found.shape.parameters["half_angle"] == pytest.approx(pi / 2 - f.carrier.angle)
        else:
            assert found.kind is Kind.REVOLVED_PARABOLA
            assert found.degree == 4
            values = found.shape.parameters
            v = np.array([-np.sin(values["tilt"]), np.cos(values["tilt"])])
            assert np.allclose(v, e * np.array([float(cosine), -float(sine)]), atol=1e-12)
            check(found, needed=False)


@FEW
@given(points, ways, angles, radii, st.integers(1, 6))
def test_cone_touches_torus(p: Vector, way: Vector, angle: Angle, r: Fraction, k: int) -> None:
    """(ii) Tangent along a circle: the half line of centres sweeps a cone."""
    sine, cosine = angle
    f = ConeSite(p, way, *angle)
    # the tube's centre at distance r from a ruling, outside
    major, height = k * sine + r * cosine, k * cosine - r * sine
    assume(major > r)
    found = surface(f, TorusSite(at(p, way, height), way, major, r), "odd")
    assert found.kind is Kind.CIRCULAR_CONE
    assert found.degree == 2
