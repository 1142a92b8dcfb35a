"""Theorem 4.7: a sphere and a sphere, cylinder, cone or torus."""

from __future__ import annotations

from fractions import Fraction
from math import pi

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from decomp.voronoi import ConeSite, CylinderSite, Kind, SphereSite, TorusSite, surface
from decomp.voronoi.exact import Vector, floats
from tests.voronoi.independent import check
from tests.voronoi.instances import FEW, across, angles, at, numbers, points, radii, spheres, ways


@FEW
@given(spheres, spheres)
def test_sphere(f: SphereSite, g: SphereSite) -> None:
    """(i) Plane or hyperboloid of two sheets (even), prolate spheroid (odd), foci the centres."""
    gap = float(np.linalg.norm(f.carrier.centre - g.carrier.centre))
    assume(gap > 0)
    even, odd = surface(f, g, "even"), surface(f, g, "odd")
    difference, total = abs(float(f.radius - g.radius)), float(f.radius + g.radius)
    if difference == 0:
        assert even.kind is Kind.PLANE
        check(even)
    elif difference < gap:
        assert even.kind is Kind.TWO_SHEETED_HYPERBOLOID
        check(even)
        foci(even, f, g, 1)
    elif difference > gap:
        assert even.kind is Kind.EMPTY
    if total > gap:
        assert odd.kind is Kind.PROLATE_SPHEROID
        check(odd)
        foci(odd, f, g, -1)
    elif total < gap:
        assert odd.kind is Kind.EMPTY


def foci(found, f: SphereSite, g: SphereSite, e: int) -> None:  # type: ignore[no-untyped-def]
    a, b = found.shape.parameters["a"], found.shape.parameters["b"]
    c = np.sqrt(a**2 + e * b**2)
    ends = found.shape.origin + np.array([[c], [-c]]) * found.shape.axes[2]
    for centre in (f.carrier.centre, g.carrier.centre):
        assert np.linalg.norm(ends - centre, axis=1).min() <= 1e-9


@FEW
@given(points, ways, radii, radii, st.sampled_from([1, -1]))
def test_touching_spheres(p: Vector, way: Vector, r: Fraction, s: Fraction, sense: int) -> None:
    """From outside or inside: nothing but a segment or half line between or beyond the centres."""
    f = SphereSite(p, r)
    outside = SphereSite(at(p, way, sense * (r + s)), s)
    assert surface(f, outside, "odd").kind is Kind.LINE
    inside = SphereSite(at(p, way, sense * s), r + s)
    assert surface(f, inside, "even").kind is Kind.LINE


@FEW
@given(points, radii, radii)
def test_concentric_spheres(p: Vector, r: Fraction, s: Fraction) -> None:
    """Not in the paper: a sphere half-way, odd."""
    assume(r != s)
    odd = surface(SphereSite(p, r), SphereSite(p, s), "odd")
    assert odd.kind is Kind.SPHERE
    assert odd.degree == 2
    assert odd.shape is not None
    assert odd.shape.parameters["radius"] == pytest.approx(float(r + s) / 2)
    check(odd)
    assert surface(SphereSite(p, r), SphereSite(p, s), "even").kind is Kind.EMPTY


@FEW
@given(points, ways, radii, radii, numbers)
def test_cylinder_about_centre(
    p: Vector, way: Vector, r: Fraction, s: Fraction, h: Fraction
) -> None:
    """(ii) A plane, or a parabola turned about a line across its axis of symmetry.

    The line goes through the focus: it holds the latus rectum. The parabola cuts it, which
    makes the spindle of figure 14.
    """
    f, g = SphereSite(at(p, way, h), r), CylinderSite(p, way, s)
    for parity, e in (("even", 1), ("odd", -1)):
        found = surface(f, g, parity)
        assert found.shape is not None
        # rho - s = e (|q| - r): the even parabola opens outwards, the odd one inwards
        depth = r - e * s
        if depth < 0:
            assert found.kind is Kind.EMPTY
        elif depth == 0:
            assert found.kind is Kind.PLANE
            assert found.degree == 1
            # the distances only touch there: s_g <= s_f everywhere
            t = np.linspace(0, 6, 7)[:, None]
            u, v, _ = found.shape.axes
            assert found.contains(found.shape.origin + 3 * (np.cos(t) * u + np.sin(t) * v)).all()
        else:
            assert found.kind is Kind.REVOLVED_PARABOLA
            assert found.degree == 4
            values = found.shape.parameters
            assert values["focal_length"] == pytest.approx(float(depth) / 2)
            assert abs(np.sin(values["tilt"])) == pytest.approx(1)
            assert values["centre_rho"] == pytest.approx(-e * float(depth) / 2)
            check(found)
            # it meets the axis at a latus rectum's half length from the centre
            centre = found.f.carrier.centre  # type: ignore[attr-defined]
            tips = centre + np.array([[1], [-1]]) * float(depth) * found.g.carrier.axis  # type: ignore[attr-defined]
            assert found.contains(tips).all()


@FEW
@given(points, ways, angles, radii, numbers)
def test_cone_about_centre(
    p: Vector, way: Vector, angle: tuple[Fraction, Fraction], r: Fraction, h: Fraction
) -> None:
    """(iii) Parabolas turned about a line at an angle to their axis (across f's ruling)."""
    f, g = SphereSite(at(p, way, h), r), ConeSite(p, way, *angle)
    sine, cosine = (float(a) for a in angle)
    for parity, e in (("even", 1), ("odd", -1)):
        found = surface(f, g, parity)
        assert found.shape is not None
        depth = float(r) - e * float(h) * sine
        if abs(depth) < 1e-12:
            continue
        if depth < 0:
            assert found.kind is Kind.EMPTY
            continue
        assert found.kind is Kind.REVOLVED_PARABOLA
        assert found.degree == 4
        values = found.shape.parameters
        assert values["focal_length"] == pytest.approx(depth / 2)
        # v, the axis of symmetry, goes along the ruling's normal (cos, -sin)
        v = np.array([-np.sin(values["tilt"]), np.cos(values["tilt"])])
        assert np.allclose(v, e * np.array([cosine, -sine]), atol=1e-12)
        check(found, needed=False)


@FEW
@given(points, ways, angles, st.integers(1, 6))
def test_cone_touches_sphere(
    p: Vector, way: Vector, angle: tuple[Fraction, Fraction], h: int
) -> None:
    """(iii) A sphere inscribed in a cone: the even surface is a right circular cone."""
    f, g = SphereSite(at(p, way, Fraction(h)), h * angle[0]), ConeSite(p, way, *angle)
    even, odd = surface(f, g, "even"), surface(f, g, "odd")
    assert odd.kind is Kind.REVOLVED_PARABOLA
    assert even.kind is Kind.CIRCULAR_CONE
    assert even.degree == 2
    assert even.shape is not None
    # its rulings are g's normals through the centre
    assert np.allclose(even.shape.origin, floats(f.centre), atol=1e-12)
    assert even.shape.parameters["half_angle"] == pytest.approx(pi / 2 - g.carrier.angle)


@FEW
@given(points, ways, radii, radii, radii, numbers)
def test_torus_about_centre(
    p: Vector, way: Vector, r: Fraction, more: Fraction, s: Fraction, h: Fraction
) -> None:
    """(iv) Ellipse (odd) or hyperbola (even) turned about the axis; cone or cylinder if r = s."""
    f, g = SphereSite(at(p, way, h), s), TorusSite(p, way, r + more, r)
    gap = float(np.hypot(float(r + more), float(h)))
    even, odd = surface(f, g, "even"), surface(f, g, "odd")
    assert even.shape is not None
    if r == s:
        # the bisector of the centres: parallel to the axis if they are level
        assert even.kind is (Kind.CIRCULAR_CONE if h else Kind.CIRCULAR_CYLINDER)
        assert even.degree == 2
        check(even)
    elif abs(float(r - s)) < gap - 1e-9:
        assert even.kind is Kind.REVOLVED_HYPERBOLA
        assert even.degree == 4
        check(even)
    if float(r + s) > gap + 1e-9:
        assert odd.kind is Kind.REVOLVED_ELLIPSE
        assert odd.degree == 4
        check(odd)
        # the foci are the centres: the sphere's is on the axis
        assert odd.shape is not None
        values = odd.shape.parameters
        assert values["centre_rho"] == pytest.approx(float(r + more) / 2)
        assert values["a"] == pytest.approx(float(r + s) / 2)
    elif float(r + s) < gap - 1e-9:
        assert odd.kind is Kind.EMPTY


@FEW
@given(points, ways, radii, radii)
def test_equal_sphere_beside_cylinder(p: Vector, way: Vector, r: Fraction, gap: Fraction) -> None:
    """Not in the paper: of equal radius, with the centre off the axis: a parabolic cylinder."""
    x, _ = across(way)
    even = surface(SphereSite(at(p, x, gap), r), CylinderSite(p, way, r), "even")
    assert even.kind is Kind.PARABOLIC_CYLINDER
    assert even.degree == 2
    assert even.shape is not None
    assert even.shape.parameters["focal_length"] == pytest.approx(float(gap) / 2)
    check(even)


@FEW
@given(points, ways, radii, radii, points)
def test_sphere_with_the_radius_of_a_tube(
    p: Vector, way: Vector, r: Fraction, more: Fraction, q: Vector
) -> None:
    """Not in the paper: anywhere off a torus's axis the even surface is a quadric.

    An elliptic cone with its apex on the axis, or a cylinder if the centre is level with the
    torus: elliptic inside its spine, hyperbolic outside.
    """
    g = TorusSite(p, way, r + more, r)
    axis, away = g.carrier.axis, floats(q) - floats(p)
    height = float(away @ axis)
    off = float(np.linalg.norm(away - height * axis))
    assume(off > 1e-9)
    even = surface(SphereSite(q, r), g, "even")
    if abs(height) > 1e-9:
        assert even.kind is Kind.ELLIPTIC_CONE
    elif abs(off - float(g.major)) > 1e-9:
        inside = off < float(g.major)
        assert even.kind is (Kind.ELLIPTIC_CYLINDER if inside else Kind.HYPERBOLIC_CYLINDER)
    check(even)
