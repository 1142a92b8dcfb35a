"""Theorem 4.10: two tori."""

from __future__ import annotations

from fractions import Fraction
from math import cos, pi, sin

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from decomp.voronoi import Kind, SphereSite, TorusSite, surface
from decomp.voronoi.elimination import eliminate
from decomp.voronoi.exact import Vector
from tests.voronoi.independent import check
from tests.voronoi.instances import FEW, WAYS, at, numbers, points, radii, ways


@FEW
@given(points, ways, radii, radii, radii, radii, numbers)
def test_coaxial(
    p: Vector,
    way: Vector,
    r: Fraction,
    s: Fraction,
    more: Fraction,
    further: Fraction,
    h: Fraction,
) -> None:
    """An ellipse (odd) or hyperbola (even) turned about the axis, of equal minor radii a line.

    Its axis is at a right angle to the axis of revolution only if the centres of the tubes
    are level or one above the other, which the paper claims for all (erratum).
    """
    f, g = TorusSite(p, way, r + more, r), TorusSite(at(p, way, h), way, s + further, s)
    step, rise = float(g.major - f.major), float(h)
    gap = float(np.hypot(step, rise))
    if gap == 0:
        if r != s:
            odd = surface(f, g, "odd")
            assert odd.kind is Kind.TORUS
            assert odd.degree == 4
            check(odd)
        return
    even, odd = surface(f, g, "even"), surface(f, g, "odd")
    difference, total = abs(float(r - s)), float(r + s)
    if difference == 0:
        level, above = rise == 0, step == 0
        kind = Kind.CIRCULAR_CYLINDER if level else Kind.PLANE if above else Kind.CIRCULAR_CONE
        assert even.kind is kind
        assert even.degree == (1 if above else 2)
        check(even)
    elif difference < gap - 1e-9:
        assert even.kind is Kind.REVOLVED_HYPERBOLA
        assert even.degree == 4
        check(even)
    elif difference > gap + 1e-9:
        assert even.kind is Kind.EMPTY
    for found in (even, odd):
        if found.kind in (Kind.REVOLVED_ELLIPSE, Kind.REVOLVED_HYPERBOLA):
            assert found.shape is not None
            tilt = found.shape.parameters["tilt"]
            assert abs(cos(tilt) * rise - sin(tilt) * step) <= 1e-9 * gap
    if total > gap + 1e-9:
        assert odd.kind is Kind.REVOLVED_ELLIPSE
        assert odd.degree == 4
        check(odd)
    elif total < gap - 1e-9:
        assert odd.kind is Kind.EMPTY


def test_axis_of_the_conic_is_oblique() -> None:
    """The erratum: tube centres one step out and one up make an angle of 45 degrees."""
    f, g = TorusSite((0, 0, 0), (0, 0, 1), 3, 1), TorusSite((0, 0, 1), (0, 0, 1), 4, 1)
    odd = surface(f, g, "odd")
    assert odd.kind is Kind.REVOLVED_ELLIPSE
    assert odd.shape is not None
    assert abs(odd.shape.parameters["tilt"]) % pi == pytest.approx(pi / 4)
    check(odd)


@FEW
@given(points, st.permutations(WAYS), radii, radii)
def test_congruent_with_common_centre(
    p: Vector, some: list[Vector], r: Fraction, more: Fraction
) -> None:
    """A pair of planes through the centre, even, and nothing else."""
    f, g = TorusSite(p, some[0], r + more, r), TorusSite(p, some[1], r + more, r)
    even = surface(f, g, "even")
    assert even.kind is Kind.PLANE_PAIR
    assert even.degree == 2
    assert even.shape is not None
    assert even.shape.parameters["half_angle"] == pytest.approx(pi / 4)
    check(even)
    assert even.polynomial is not None
    # there is no additional component, not even of the equation
    assert eliminate(f, g, 1).raw == even.polynomial.raw


@FEW
@given(points, ways, radii, st.sampled_from([(3, 4, 5), (5, 12, 13), (8, 15, 17)]))
def test_contact(p: Vector, way: Vector, s: Fraction, legs: tuple[int, int, int]) -> None:
    """Theorems 4.7 (iv) and 4.10, tangent along a circle: the line of centres sweeps a cone."""
    step, rise, gap = legs
    r = gap - s
    f = TorusSite(p, way, 40, s)
    g = TorusSite(at(p, way, Fraction(rise)), way, 40 + step, r)
    odd = surface(f, g, "odd")
    assert odd.kind is Kind.CIRCULAR_CONE and odd.degree == 2
    inner = TorusSite(at(p, way, Fraction(rise)), way, 40 + step, s + gap)
    assert surface(f, inner, "even").kind is Kind.CIRCULAR_CONE
    ring = TorusSite(p, way, step, min(s, Fraction(2)))
    ball = SphereSite(at(p, way, Fraction(rise)), gap - ring.minor)
    assert surface(ring, ball, "odd").kind is Kind.CIRCULAR_CONE
