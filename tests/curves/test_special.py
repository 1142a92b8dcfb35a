"""Tangent, singular and small intersections whose answer is known."""

from __future__ import annotations

from math import asin, cos, hypot, pi, sin

import numpy as np
import pytest

from decomp.carriers import Carrier, Cone, Cylinder, Plane, Sphere, Torus
from decomp.curves import Circle, Line, intersect
from decomp.errors import ContactError
from tests.curves.cases import ORIGIN, X, Y, Z, kinds, meet, unit

CONE = Cone(ORIGIN, Z, 0.5)
TANGENT = cos(0.5) * X - sin(0.5) * Z
TORUS = Torus(ORIGIN, Z, 2.0, 0.5)
CYLINDER = Cylinder(ORIGIN, Z, 1.0)
BALL = 2 * sin(0.5)
"""Radius of the sphere inscribed in CONE about (0, 0, 2)."""

# name: carriers, curves, contacts, nodes
CASES: dict[str, tuple[Carrier, Carrier, str, int, int]] = {
    "planes": (Plane(ORIGIN, X), Plane(X, unit(1, 1, 0)), "line", 0, 0),
    "parallel planes": (Plane(ORIGIN, X), Plane(X, X), "", 0, 0),
    "plane touches sphere": (Plane(X, X), Sphere(ORIGIN, 1.0), "", 1, 0),
    "plane misses sphere": (Plane(1.1 * X, X), Sphere(ORIGIN, 1.0), "", 0, 0),
    "plane along cylinder": (Plane(0.3 * X, X), CYLINDER, "line line", 0, 0),
    "plane touches cylinder": (Plane(X, X), CYLINDER, "line~", 0, 0),
    "plane misses cylinder": (Plane(2 * X, X), CYLINDER, "", 0, 0),
    "plane across cylinder": (Plane(Z, Z), CYLINDER, "circle", 0, 0),
    "plane oblique": (Plane(Z, unit(1, 0, 1)), CYLINDER, "ellipse", 0, 0),
    "plane almost along cylinder": (
        Plane(ORIGIN, unit(1, 0, 1e-3)),
        CYLINDER,
        "ellipse ellipse",
        0,
        0,
    ),
    "cone cut in ellipse": (Plane(Z, unit(0.2, 0, 1)), CONE, "ellipse", 0, 0),
    "cone cut in circle": (Plane(Z, Z), CONE, "circle", 0, 0),
    "cone cut in parabola": (Plane(Z, TANGENT), CONE, "parabola", 0, 0),
    "cone cut in hyperbola": (Plane(0.3 * X, X), CONE, "hyperbola", 0, 0),
    "other nappe only": (Plane(-Z, unit(0.2, 0, 1)), CONE, "", 0, 0),
    "plane through apex": (Plane(ORIGIN, X), CONE, "line line", 0, 1),
    "plane touches apex": (Plane(ORIGIN, Z), CONE, "", 1, 0),
    "plane touches cone": (Plane(ORIGIN, TANGENT), CONE, "line~", 0, 0),
    "sphere in cylinder": (Sphere(Z, 1.0), CYLINDER, "circle~", 0, 0),
    "sphere in cone": (Sphere(2 * Z, BALL), CONE, "circle~", 0, 0),
    "sphere beside cylinder": (Sphere(2 * X, 1.0), CYLINDER, "", 1, 0),
    "Viviani": (Sphere(ORIGIN, 1.0), Cylinder(0.5 * X, Z, 0.5), "curve curve", 0, 1),
    "sphere through apex": (Sphere(0.2 * X + Z, hypot(0.2, 1)), CONE, "curve", 1, 0),
    "cusp at apex": (
        Sphere(1.5 * unit(1, -1, 0.5), 1.5),
        Cone(ORIGIN, unit(0, -1, 1), pi / 4),
        "curve",
        0,
        1,
    ),
    "spheres": (Sphere(ORIGIN, 1.0), Sphere(X, 1.0), "circle", 0, 0),
    "spheres touch": (Sphere(ORIGIN, 1.0), Sphere(1.5 * X, 0.5), "", 1, 0),
    "spheres touch inside": (Sphere(ORIGIN, 1.0), Sphere(0.5 * X, 0.5), "", 1, 0),
    "concentric": (Sphere(ORIGIN, 1.0), Sphere(ORIGIN, 0.5), "", 0, 0),
    "parallel cylinders": (CYLINDER, Cylinder(X, Z, 0.7), "line line", 0, 0),
    "parallel cylinders touch": (CYLINDER, Cylinder(1.7 * X, Z, 0.7), "line~", 0, 0),
    "nested cylinders touch": (CYLINDER, Cylinder(0.3 * X, Z, 0.7), "line~", 0, 0),
    "nested cylinders": (CYLINDER, Cylinder(ORIGIN, Z, 0.7), "", 0, 0),
    "equal crossing": (CYLINDER, Cylinder(ORIGIN, unit(1, 0.2, 0.4), 1.0), "ellipse ellipse", 0, 2),
    "unequal crossing": (CYLINDER, Cylinder(ORIGIN, X, 0.5), "curve curve", 0, 0),
    "figure eight": (CYLINDER, Cylinder(0.5 * Y, X, 0.5), "curve curve", 0, 1),
    "crossing from outside": (CYLINDER, Cylinder(1.5 * Y, X, 0.5), "", 1, 0),
    "poke": (CYLINDER, Cylinder(1.499 * Y, X, 0.5), "curve", 0, 0),
    "Monge": (CONE, Cylinder(2 * Z, unit(1, 0.3, 0.5), BALL), "ellipse ellipse", 0, 2),
    "Monge cones": (
        CONE,
        Cone(2 * Z + 3 * unit(1, 0, 0.3), -unit(1, 0, 0.3), asin(BALL / 3)),
        "ellipse ellipse",
        0,
        2,
    ),
    "shifted cone": (CONE, Cone(0.5 * X + 0.3 * Z, Z, 0.5), "hyperbola", 0, 0),
    "opposite cone": (CONE, Cone(0.5 * X + 3 * Z, -Z, 0.5), "ellipse", 0, 0),
    "same apex": (CONE, Cone(ORIGIN, unit(0.3, 0.2, 1), 0.45), "line line", 0, 1),
    "same apex touching": (CONE, Cone(ORIGIN, unit(sin(0.2), 0, cos(0.2)), 0.3), "line~", 0, 1),
    "same apex apart": (CONE, Cone(ORIGIN, X, 0.3), "", 1, 0),
    "cone through cylinder": (Cylinder(Z, X, 0.3), CONE, "curve curve", 0, 0),
    "apex on cylinder": (Cylinder(0.3 * X, Y, 0.3), Cone(ORIGIN, X, 0.4), "curve", 1, 0),
    "spiric, two ovals": (Plane(0.2 * X, X), TORUS, "curve curve", 0, 0),
    "spiric, one oval": (Plane(1.7 * X, X), TORUS, "curve", 0, 0),
    "lemniscate": (Plane(1.5 * X, X), TORUS, "curve curve", 0, 1),
    "plane touches torus": (Plane(2.5 * X, X), TORUS, "", 1, 0),
    "plane on torus": (Plane(0.5 * Z, Z), TORUS, "circle~", 0, 0),
    "plane across torus": (Plane(0.2 * Z, Z), TORUS, "circle circle", 0, 0),
    "Villarceau": (Plane(ORIGIN, unit(1, 0, 15**0.5)), TORUS, "curve curve curve curve", 0, 2),
    "sphere through torus": (Sphere(2 * X, 0.8), TORUS, "curve curve", 0, 0),
    "sphere in torus": (Sphere(2 * X, 0.5), TORUS, "circle~", 0, 0),
    "sphere in hole": (Sphere(ORIGIN, 1.5), TORUS, "circle~", 0, 0),
    "sphere beside torus": (Sphere(3 * X, 0.5), TORUS, "", 1, 0),
    "small loop on torus": (Cylinder(2.799 * X, Z, 0.3), TORUS, "curve", 0, 0),
    "cylinder beside torus": (Cylinder(2.8 * X, Z, 0.3), TORUS, "", 1, 0),
    "elbow": (Cylinder(2 * X, Y, 0.5), TORUS, "circle~ curve curve", 0, 2),
    "tori in line": (Torus(5 * X, Z, 3.0, 0.5), TORUS, "circle~ curve curve", 0, 2),
    "interlocked": (Torus(2 * X, Y, 2.0, 0.4), TORUS, "", 0, 0),
    "tori on one axis": (Torus(0.3 * Z, Z, 2.0, 0.5), TORUS, "circle circle", 0, 0),
    "equal tori": (Torus(ORIGIN, X, 2.0, 0.5), TORUS, " ".join(["curve"] * 8), 0, 4),
    "tori touch": (Torus(5.5 * X, Y, 2.5, 0.5), TORUS, "", 1, 0),
}


@pytest.mark.parametrize("name", CASES)
def test_known_answer(name: str) -> None:
    a, b, curves, contacts, nodes = CASES[name]
    for one, two in ((a, b), (b, a)):
        found = meet(one, two, 9.0)
        assert kinds(found) == curves.split()
        assert (len(found.contacts), len(found.nodes)) == (contacts, nodes)


def test_plane_through_the_axis_cuts_the_torus_in_circles() -> None:
    found = meet(Plane(ORIGIN, X), TORUS)
    assert len(found.curves) == 2
    for one in found.curves:
        p = one.curve.point(np.linspace(*one.curve.domain, 50))
        centre = p[0] - p[0] + 2 * np.sign(p[0] @ Y) * Y
        assert np.allclose(np.linalg.norm(p - centre, axis=1), 0.5, atol=1e-12)


def test_four_loops_of_two_tori() -> None:
    found = meet(Torus(ORIGIN, unit(0.1, 1, 0), 2.0, 0.3), TORUS)
    assert kinds(found) == ["curve"] * 4
    assert all(one.curve.closed for one in found.curves)


@pytest.mark.parametrize("depth", [1e-2, 1e-3, 1e-5, 1e-7])
def test_small_loops_are_found(depth: float) -> None:
    tip = Sphere((2.5 + 0.3 - depth) * X, 0.3)
    for carrier in (TORUS, Cylinder(2.2 * X, Y, 0.3), Sphere(2 * X, 0.5)):
        found = meet(tip, carrier)
        assert len(found.curves) == 1
        assert found.curves[0].curve.bounding_ball()[1] < 2 * depth**0.5


@pytest.mark.parametrize("gap", [-5e-10, 0.0, 5e-10])
def test_a_gap_below_the_tolerance_is_a_touch(gap: float) -> None:
    assert kinds(meet_loosely(Plane((1 + gap) * X, X), CYLINDER)) == ["line~"]
    assert len(meet_loosely(Sphere((2 + gap) * X, 1.0), CYLINDER).contacts) == 1
    assert len(meet_loosely(Sphere((3 + gap) * X, 0.5), TORUS).contacts) == 1
    assert len(meet_loosely(Cylinder((1.5 + gap) * Y, X, 0.5), CYLINDER).contacts) == 1


def meet_loosely(a: Carrier, b: Carrier):  # type: ignore[no-untyped-def]
    return intersect(a, b, ORIGIN, 5.0, 1e-9)


def test_coinciding_carriers_are_refused() -> None:
    with pytest.raises(ContactError, match="same surface"):
        intersect(CYLINDER, Cylinder(3 * Z, -Z, 1.0), ORIGIN, 5.0, 1e-9)


def test_higher_contact_is_refused_by_place() -> None:
    cylinder = Cylinder(ORIGIN, unit(0, -1, 1), 1.0)
    torus = Torus(0.5 * X, Z, 1.0, 0.5)
    with pytest.raises(ContactError, match=r"torus and cylinder touch .* at \("):
        intersect(cylinder, torus, ORIGIN, 5.0, 1e-9)


def test_rings_that_fill_each_other_are_refused() -> None:
    """They touch along two circles, a meridian of each, which cross."""
    with pytest.raises(ContactError, match="along a circle"):
        intersect(Torus(ORIGIN, Z, 2.0, 1.0), Torus(2 * X, Y, 2.0, 1.0), ORIGIN, 40.0, 1e-9)


def test_curves_beyond_the_window_are_left_out() -> None:
    assert not intersect(Plane(9 * X, X), Sphere(9 * X, 1.0), ORIGIN, 5.0, 1e-9).curves
    assert not intersect(Plane(9 * X, X), Plane(9 * Y, Y), ORIGIN, 5.0, 1e-9).curves


def test_circles_are_recognised() -> None:
    (one,) = meet(Plane(Z, Z), CONE).curves
    assert isinstance(one.curve, Circle)
    assert one.curve.radius == pytest.approx(np.tan(0.5), rel=1e-14)
    assert one.curve.period == pytest.approx(2 * pi)


@pytest.mark.parametrize("tilt", [1e-12, 1e-11, 1e-10])
@pytest.mark.parametrize("off", [0.0, 0.3, 0.9])
def test_a_plane_all_but_parallel_to_an_axis_meets_the_cylinder_in_its_tangents(
    tilt: float, off: float
) -> None:
    plane, cylinder = Plane(off * X, X), Cylinder(ORIGIN, unit(tilt, 0, 1), 1.0)
    found = meet(plane, cylinder, 3.0)
    assert [type(one.curve) for one in found.curves] == [Line, Line]
