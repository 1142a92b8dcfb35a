"""Propositions 4.1 to 4.4: Voronoi curves of points, lines and circles in the plane."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from decomp.errors import InputError
from decomp.vectors import Array
from decomp.voronoi.profile import (
    CurveKind,
    Profile,
    ProfileCircle,
    ProfileCurve,
    ProfileLine,
    voronoi_curve,
)
from tests.voronoi.instances import ANGLES, FEW, numbers, radii

UNITS = [*ANGLES, (Fraction(1), Fraction(0)), (Fraction(0), Fraction(-1))]
lines = st.builds(lambda n, c: ProfileLine(*n, c), st.sampled_from(UNITS), numbers)
circles = st.builds(ProfileCircle, numbers, numbers, radii)


def distance(site: Profile, q: Array) -> Array:
    """Signed distance of points (k, 2)."""
    if isinstance(site, ProfileLine):
        n = np.array([float(site.normal_rho), float(site.normal_z)])
        return np.asarray(q @ n - float(site.constant))
    centre = np.array([float(site.rho), float(site.z)])
    return np.asarray(np.hypot(*(q - centre).T) - float(site.radius))


def points_of(curve: ProfileCurve) -> Array:
    """Points of a curve by its canonical parameters."""
    t = np.linspace(-2, 2, 41)
    way = curve.direction
    side = np.array([-way[1], way[0]])
    along, across = {
        CurveKind.LINE: (t, 0 * t),
        CurveKind.RAY: (t + 2, 0 * t),
        CurveKind.SEGMENT: (curve.a * t / 2, 0 * t),
        CurveKind.PARABOLA: (t**2 / (4 * max(curve.focal_length, 1e-300)), t),
        CurveKind.ELLIPSE: (curve.a * np.cos(2 * t), curve.b * np.sin(2 * t)),
        CurveKind.HYPERBOLA: (curve.a * np.cosh(t), curve.b * np.sinh(t)),
        CurveKind.CIRCLE: (curve.a * np.cos(2 * t), curve.a * np.sin(2 * t)),
    }[curve.kind]
    return np.asarray(curve.centre + along[:, None] * way + across[:, None] * side)


def voronoi(f: Profile, g: Profile, e: int) -> ProfileCurve:
    """The curve; its points are checked to be equidistant."""
    curve = voronoi_curve(f, g, e, 1e-12, 1e-12)
    if curve.kind is not CurveKind.EMPTY:
        q = points_of(curve)
        gap = distance(f, q) - e * distance(g, q)
        assert np.abs(gap).max() <= 1e-12 * (1 + np.abs(q).max())
    return curve


@FEW
@given(lines, numbers, numbers)
def test_line_and_point(line: ProfileLine, rho: Fraction, z: Fraction) -> None:
    """Proposition 4.1: a parabola about the point; the perpendicular if it is on the line."""
    point = ProfileCircle(rho, z, Fraction(0))
    side = distance(line, np.array([[float(rho), float(z)]]))[0]
    even, odd = voronoi(line, point, 1), voronoi(line, point, -1)
    if side == 0:
        # the perpendicular, half of it on either side of the line
        assert even.kind is odd.kind is CurveKind.RAY
        assert np.array_equal(even.direction, -odd.direction)
        return
    curve, other = (even, odd) if side > 0 else (odd, even)
    assert other.kind is CurveKind.EMPTY
    assert curve.kind is CurveKind.PARABOLA
    focus = curve.centre + curve.focal_length * curve.direction
    assert np.allclose(focus, [float(rho), float(z)], atol=1e-12)


@FEW
@given(lines, circles)
def test_line_and_circle(line: ProfileLine, circle: ProfileCircle) -> None:
    """Proposition 4.2: parabolas with the circle's centre as focus; a half line if they touch."""
    centre = np.array([float(circle.rho), float(circle.z)])
    side = float(distance(line, centre[None])[0])
    for e in (1, -1):
        curve = voronoi(line, circle, e)
        depth = float(circle.radius) + e * side
        if depth < 0:
            assert curve.kind is CurveKind.EMPTY
        elif depth == 0:
            assert curve.kind is CurveKind.RAY
        else:
            assert curve.kind is CurveKind.PARABOLA
            focus = curve.centre + curve.focal_length * curve.direction
            assert np.allclose(focus, centre, atol=1e-12)


def test_line_touches_circle() -> None:
    """Proposition 4.2: one parabola stays, the other is a half line from the centre."""
    line = ProfileLine(Fraction(1), Fraction(0), Fraction(-2))
    circle = ProfileCircle(Fraction(0), Fraction(1), Fraction(2))
    assert voronoi(line, circle, 1).kind is CurveKind.PARABOLA
    odd = voronoi(line, circle, -1)
    assert odd.kind is CurveKind.RAY
    assert np.allclose(odd.direction, [-1, 0])
    assert np.allclose(odd.centre, [0, 1])


@FEW
@given(circles, circles)
def test_two_circles(f: ProfileCircle, g: ProfileCircle) -> None:
    """Propositions 4.3 and 4.4, for all positions of the circles."""
    gap = float(np.hypot(float(f.rho - g.rho), float(f.z - g.z)))
    r, s = float(f.radius), float(g.radius)
    assume(gap > 0)
    even, odd = voronoi(f, g, 1), voronoi(f, g, -1)
    if r == s:
        assert even.kind is CurveKind.LINE
    elif abs(r - s) < gap:
        assert even.kind is CurveKind.HYPERBOLA
    elif abs(r - s) == gap:
        assert even.kind is CurveKind.RAY
    else:
        assert even.kind is CurveKind.EMPTY
    if r + s > gap:
        assert odd.kind is CurveKind.ELLIPSE
    elif r + s == gap:
        assert odd.kind is CurveKind.SEGMENT
    else:
        assert odd.kind is CurveKind.EMPTY


@FEW
@given(circles, radii)
def test_concentric_circles(f: ProfileCircle, r: Fraction) -> None:
    """Not in the paper: a circle half-way between them, odd only."""
    g = ProfileCircle(f.rho, f.z, r)
    odd = voronoi(f, g, -1)
    assert odd.kind is CurveKind.CIRCLE
    assert odd.a == pytest.approx(float(f.radius + r) / 2)
    if f.radius == r:
        with pytest.raises(InputError, match="coincide"):
            voronoi(f, g, 1)
    else:
        assert voronoi(f, g, 1).kind is CurveKind.EMPTY


@FEW
@given(st.integers(1, 8), st.integers(1, 8), st.sampled_from([1, -1]))
def test_touching_circles(a: int, b: int, sense: int) -> None:
    """From outside the odd curve is the segment between the centres, from inside the even a ray."""
    f = ProfileCircle(Fraction(0), Fraction(0), Fraction(a))
    g = ProfileCircle(Fraction(0), Fraction(sense * (a + b)), Fraction(b))
    assert voronoi(f, g, -1).kind is CurveKind.SEGMENT
    inner = ProfileCircle(Fraction(0), Fraction(sense * b), Fraction(a))
    outer = ProfileCircle(Fraction(0), Fraction(0), Fraction(a + b))
    assert voronoi(outer, inner, 1).kind is CurveKind.RAY
