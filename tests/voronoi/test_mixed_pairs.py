"""Points, lines and circles as sites: the paper's section 2.4."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from decomp.carriers import Cylinder, Plane
from decomp.curves.circle import Circle
from decomp.curves.line import Line
from decomp.errors import GeometryError, InputError
from decomp.voronoi import CylinderSite, Kind, PlaneSite, SphereSite, TorusSite, surface
from decomp.voronoi.exact import Vector
from tests.voronoi.independent import check, equidistant_points
from tests.voronoi.instances import FEW, WAYS, across, at, dots, lines, numbers, points, radii, ways


@FEW
@given(points, ways, radii, radii)
def test_under_the_blind_hole(p: Vector, way: Vector, r: Fraction, h: Fraction) -> None:
    """Figure 4: cone, parabolic torus, plane. h2 is Vor(g, e), not Vor(f1, e) (erratum)."""
    g = PlaneSite(p, way)
    back = (-way[0], -way[1], -way[2])
    bottom = PlaneSite(at(p, way, -h), back)
    hole = CylinderSite(p, way, r)
    e = TorusSite(at(p, way, -h), way, r, 0)
    h1 = surface(hole, g, "odd")
    h2 = surface(g, e)
    h3 = surface(g, bottom, "even")
    assert (h1.kind, h2.kind, h3.kind) == (
        Kind.CIRCULAR_CONE,
        Kind.EMPTY,
        Kind.PLANE,
    )
    # from g's inner side e is seen
    h2 = surface(PlaneSite(p, back), e)
    assert h2.kind is Kind.REVOLVED_PARABOLA
    assert h2.shape is not None
    values = h2.shape.parameters
    assert values["focal_length"] == pytest.approx(float(h) / 2)
    assert abs(np.cos(values["tilt"])) == pytest.approx(1)
    assert values["centre_rho"] == pytest.approx(float(r))
    check(h2)
    # Vor(f1, e) with f1 the hole's own side: nothing but the plane of the edge
    wrong = surface(hole, e)
    assert wrong.kind is Kind.PLANE


@FEW
@given(dots, dots)
def test_points(f: SphereSite, g: SphereSite) -> None:
    assume(f.centre != g.centre)
    found = surface(f, g)
    assert found.kind is Kind.PLANE
    assert found.degree == 1
    check(found)


@FEW
@given(dots, lines)
def test_point_and_line(f: SphereSite, g: CylinderSite) -> None:
    """A parabolic cylinder, or the plane across the line at a point of it."""
    found = surface(f, g)
    off = float(g.signed_distance(f.carrier.centre))
    assert found.kind is (Kind.PARABOLIC_CYLINDER if off > 1e-9 else Kind.PLANE)
    if found.kind is Kind.PARABOLIC_CYLINDER:
        assert found.shape is not None
        assert found.shape.parameters["focal_length"] == pytest.approx(off / 2)
        check(found)


@FEW
@given(points, ways, radii, numbers, radii)
def test_point_and_circle(p: Vector, way: Vector, r: Fraction, h: Fraction, off: Fraction) -> None:
    """Cone with its apex on the circle's axis; level with the circle a cylinder over a conic."""
    x, _ = across(way)
    found = surface(at(at(p, way, h), x, off), TorusSite(p, way, r, 0))
    if h:
        assert found.kind is Kind.ELLIPTIC_CONE
    elif off == r:
        # the point lies on the circle: half the plane across the circle there
        assert found.kind is Kind.PLANE
        return
    else:
        assert found.kind is (Kind.ELLIPTIC_CYLINDER if off < r else Kind.HYPERBOLIC_CYLINDER)
    assert found.degree == 2
    check(found)


@FEW
@given(points, ways, radii, numbers)
def test_point_on_the_axis_of_a_circle(p: Vector, way: Vector, r: Fraction, h: Fraction) -> None:
    found = surface(at(p, way, h), TorusSite(p, way, r, 0))
    assert found.kind is (Kind.CIRCULAR_CONE if h else Kind.CIRCULAR_CYLINDER)
    check(found)


@FEW
@given(points, points, st.permutations(WAYS))
def test_lines(p: Vector, q: Vector, some: list[Vector]) -> None:
    """As cylinders of equal radius: hyperbolic paraboloid, planes, plane."""
    found = surface(CylinderSite(p, some[0], 0), CylinderSite(q, some[1], 0))
    assert found.kind in (Kind.HYPERBOLIC_PARABOLOID, Kind.PLANE_PAIR)
    check(found)
    meeting = surface(CylinderSite(p, some[0], 0), CylinderSite(p, some[1], 0))
    assert meeting.kind is Kind.PLANE_PAIR
    x, _ = across(some[0])
    beside = surface(CylinderSite(p, some[0], 0), CylinderSite(at(p, x, Fraction(1)), some[0], 0))
    assert beside.kind is Kind.PLANE


@FEW
@given(points, ways, radii, radii, numbers)
def test_coaxial_circles(p: Vector, way: Vector, r: Fraction, s: Fraction, h: Fraction) -> None:
    assume(r != s or h)
    found = surface(TorusSite(p, way, r, 0), TorusSite(at(p, way, h), way, s, 0))
    raised = Kind.PLANE if r == s else Kind.CIRCULAR_CONE
    kind = raised if h else Kind.CIRCULAR_CYLINDER
    assert found.kind is kind
    check(found)


def test_what_is_given_may_be_carriers_curves_and_points() -> None:
    x, y, z = np.eye(3)
    plane, tube = Plane(np.zeros(3), z), Cylinder(np.zeros(3), z, 1.0)
    assert surface(plane, tube, "even").kind is Kind.CIRCULAR_CONE
    ring = Circle(np.array([0.0, 0.0, 2.0]), x, y, 1.0)
    assert surface(plane, ring).kind is Kind.REVOLVED_PARABOLA
    assert surface([0, 0, 3], Line(np.zeros(3), x)).kind is Kind.PARABOLIC_CYLINDER


def test_what_cannot_be() -> None:
    with pytest.raises(InputError, match="no odd"):
        surface([0, 0, 0], [1, 0, 0], "odd")
    with pytest.raises(InputError, match="a site is"):
        surface([0, 0], [1, 0, 0])
    apart = surface(SphereSite((0, 0, 0), 1), SphereSite((5, 0, 0), 1), "odd")
    with pytest.raises(GeometryError, match="no point"):
        apart.project(np.array([[2.0, 1.0, 0.0]]))


@FEW
@given(points, st.permutations(WAYS), radii)
def test_projection(p: Vector, some: list[Vector], r: Fraction) -> None:
    """Points close to the surface come to it, and do not go far."""
    found = surface(PlaneSite(p, some[0]), TorusSite(p, some[1], r + 1, r))
    known = equidistant_points(found, seed=2)
    shift = np.random.default_rng(2).uniform(-1, 1, size=known.shape) * 0.01 * found.size
    gradient = np.linalg.norm(found.difference_gradient(known), axis=1)
    known, shift = known[gradient > 0.3], shift[gradient > 0.3]
    on = found.project(known + shift)
    assert np.abs(found.difference(on)).max(initial=0.0) <= 1e-13 * found.size
    assert np.linalg.norm(on - known, axis=1).max(initial=0.0) <= 0.2 * found.size
