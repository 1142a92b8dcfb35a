"""Proposition 4.5 and Theorem 4.6: a plane and a plane, sphere, cylinder, cone or torus."""

from __future__ import annotations

from fractions import Fraction
from math import pi

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from decomp.errors import InputError
from decomp.voronoi import ConeSite, CylinderSite, Kind, PlaneSite, SphereSite, TorusSite, surface
from decomp.voronoi.exact import Vector
from tests.voronoi.independent import check, equidistant_points
from tests.voronoi.instances import (
    FEW,
    SITES,
    WAYS,
    across,
    angles,
    numbers,
    on,
    planes,
    points,
    radii,
    spheres,
    ways,
)

PARITIES = ("even", "odd")
DEGREES = {"plane": 1, "sphere": 2, "cylinder": 2, "cone": 2, "torus": 4}


@pytest.mark.parametrize("kind", DEGREES)
@FEW
@given(st.data())
def test_degree_is_at_most_that_of_g(kind: str, data: st.DataObject) -> None:
    """Proposition 4.5."""
    f, g = data.draw(planes), data.draw(SITES[kind])
    for parity in PARITIES:
        try:
            found = surface(f, g, parity)
        except InputError:
            continue
        assert found.degree is None or found.degree <= DEGREES[kind]


@FEW
@given(planes, planes)
def test_plane(f: PlaneSite, g: PlaneSite) -> None:
    """Theorem 4.6 (i)."""
    for parity in PARITIES:
        assume(np.linalg.norm(np.cross(f.carrier.normal_vector, g.carrier.normal_vector)) > 0)
        found = surface(f, g, parity)
        assert found.kind is Kind.PLANE
        assert found.degree == 1
        check(found)


@FEW
@given(points, ways, st.integers(1, 9))
def test_parallel_planes(p: Vector, way: Vector, h: int) -> None:
    """Of equal sense: half-way, odd only; facing each other: half-way, even only."""
    f = PlaneSite(p, way)
    size = Fraction(int(sum(x * x for x in way)))
    g = PlaneSite(on(p, way, Fraction(h)), way)
    back = PlaneSite(on(p, way, Fraction(h)), on((0, 0, 0), way, Fraction(-1)))  # type: ignore[arg-type]
    half = on(p, way, Fraction(h, 2))
    for other, full, empty in ((g, "odd", "even"), (back, "even", "odd")):
        found = surface(f, other, full)
        assert found.kind is Kind.PLANE
        assert found.shape is not None
        assert float(found.shape.deviation(np.array([float(x) for x in half]))) <= 1e-12
        assert surface(f, other, empty).kind is Kind.EMPTY
    assert size > 0


@FEW
@given(planes)
def test_coinciding_planes(f: PlaneSite) -> None:
    """Every point would be equidistant: there is no surface, and that is said."""
    with pytest.raises(InputError, match="coincide"):
        surface(f, f)


@FEW
@given(planes, spheres)
def test_sphere(f: PlaneSite, g: SphereSite) -> None:
    """Theorem 4.6 (ii): a paraboloid of revolution with the centre as focus."""
    side = float(f.carrier.signed_distance(g.carrier.centre))
    for parity, e in (("even", 1), ("odd", -1)):
        found = surface(f, g, parity)
        assert found.shape is not None
        depth = float(g.radius) + e * side
        if depth < 0:
            assert found.kind is Kind.EMPTY
        elif depth > 0:
            assert found.kind is Kind.PARABOLOID
            assert found.degree == 2
            check(found)
            focus = (
                found.shape.origin + found.shape.parameters["focal_length"] * found.shape.axes[2]
            )
            assert np.allclose(focus, g.carrier.centre, atol=1e-12)


@FEW
@given(points, ways, st.sampled_from([1, -1]))
def test_plane_touches_sphere(p: Vector, way: Vector, sense: int) -> None:
    """One paraboloid degenerates into a half line."""
    size = round(float(sum(x * x for x in way)) ** 0.5)
    f = PlaneSite(p, way)
    g = SphereSite(on(p, way, Fraction(sense)), size)
    kinds = {parity: surface(f, g, parity).kind for parity in PARITIES}
    whole, thin = ("even", "odd") if sense > 0 else ("odd", "even")
    assert kinds == {whole: Kind.PARABOLOID, thin: Kind.LINE}


@FEW
@given(points, ways, radii, numbers)
def test_cylinder_parallel_to_plane(p: Vector, way: Vector, r: Fraction, h: Fraction) -> None:
    """Theorem 4.6 (iii): a parabolic cylinder; a half-plane where the two touch."""
    x, _ = across(way)
    size = Fraction(round(float(sum(c * c for c in x)) ** 0.5))
    f = PlaneSite(p, x)
    g = CylinderSite(on(p, x, h / size), way, r)
    for parity, e in (("even", 1), ("odd", -1)):
        found = surface(f, g, parity)
        depth = r + e * h
        if depth < 0:
            assert found.kind is Kind.EMPTY
        elif depth == 0:
            assert found.kind is Kind.PLANE
            assert found.degree == 1
        else:
            assert found.kind is Kind.PARABOLIC_CYLINDER
            assert found.shape is not None
            assert found.shape.parameters["focal_length"] == pytest.approx(float(depth) / 2)
            assert found.degree == 2
            check(found)


@FEW
@given(points, st.permutations(WAYS), radii)
def test_cylinder_across_plane(p: Vector, some: list[Vector], r: Fraction) -> None:
    """Theorem 4.6 (iii): an elliptic cone with its apex on the axis, through f and g's ellipse."""
    f, g = PlaneSite(p, some[0]), CylinderSite(p, some[1], r)
    lean = float(f.carrier.normal_vector @ g.carrier.axis)
    assume(abs(lean) > 1e-9)
    for parity in PARITIES:
        found = surface(f, g, parity)
        assert found.kind is Kind.ELLIPTIC_CONE
        check(found)
        assert found.shape is not None
        away = found.shape.origin - g.carrier.point
        assert np.allclose(np.cross(away, g.carrier.axis), 0, atol=1e-9)
        assert abs(float(f.carrier.signed_distance(found.shape.origin))) == pytest.approx(float(r))
        # the section of f and g, by the azimuth about the axis
        u, v = across(some[1])
        e1, e2 = (np.array([float(c) for c in w]) for w in (u, v))
        e1, e2 = e1 / np.linalg.norm(e1), e2 / np.linalg.norm(e2)
        t = np.linspace(0, 6, 9)[:, None]
        ring = g.carrier.point + float(r) * (np.cos(t) * e1 + np.sin(t) * e2)
        section = ring - (f.carrier.signed_distance(ring) / lean)[:, None] * g.carrier.axis
        assert found.shape.deviation(section).max() <= 1e-9 * float(r)


@FEW
@given(points, ways, radii)
def test_cylinder_upright_on_plane(p: Vector, way: Vector, r: Fraction) -> None:
    """The cone under a blind hole: right circular, with a half-angle of 45 degrees."""
    for parity in PARITIES:
        found = surface(PlaneSite(p, way), CylinderSite(p, way, r), parity)
        assert found.kind is Kind.CIRCULAR_CONE
        assert found.shape is not None
        assert found.shape.parameters["half_angle"] == pytest.approx(pi / 4)
        check(found)


@FEW
@given(points, st.permutations(WAYS), angles, numbers)
def test_cone(p: Vector, some: list[Vector], angle: tuple[Fraction, Fraction], h: Fraction) -> None:
    """Theorem 4.6 (iv): a cone (erratum: "so is f" means "so is h") with its apex on g's axis."""
    f = PlaneSite(on(p, some[0], h), some[0])
    g = ConeSite(p, some[1], *angle)
    for parity in PARITIES:
        found, true = surface(f, g, parity, exists=True), surface(f, g, parity)
        assert found.shape is not None
        if true.kind.dimension < 2:
            # the plane does not meet the cone, or only at its apex
            assert (true.kind is Kind.LINE) == (h == 0)
            assert not len(equidistant_points(true, seed=1, count=60))
        if found.kind in (Kind.CIRCULAR_CONE, Kind.ELLIPTIC_CONE):
            away = found.shape.origin - g.carrier.apex
            assert np.allclose(np.cross(away, g.carrier.axis), 0, atol=1e-9)
            # where f only touches g's apex nothing is inside one and outside the other
            check(found, needed=False)
        else:
            # the apex lies at infinity where e n + sin axis is at right angles to the axis
            e = 1 if parity == "even" else -1
            lean = e * float(f.carrier.normal_vector @ g.carrier.axis) + float(g.sine)
            assert abs(lean) < 1e-12


@FEW
@given(points, ways, angles)
def test_plane_holds_axis_of_cone(p: Vector, way: Vector, angle: tuple[Fraction, Fraction]) -> None:
    """Theorem 4.6 (iv): a cone with its apex at g's, whose sections across f are hyperbolas.

    Equation (2): (d / cos + r / sin^2)^2 - x^2 - r^2 cot^2 = 0 is an error: from
    (r + d / cos)^2 = x^2 + d^2 follows (d tan + r / sin)^2 = x^2 + r^2 cot^2.
    """
    x, y = across(way)
    g = ConeSite(p, way, *angle)
    sine, cosine = (float(a) for a in angle)
    for parity, e in (("even", 1), ("odd", -1)):
        found = surface(PlaneSite(p, x), g, parity)
        assert found.kind is Kind.ELLIPTIC_CONE
        assert found.shape is not None
        assert np.allclose(found.shape.origin, g.carrier.apex, atol=1e-12)
        up, side = (np.array([float(c) for c in w]) for w in (x, y))
        up, side = up / np.linalg.norm(up), side / np.linalg.norm(side)
        # in the section across the axis at height 1, where g's circle has radius r
        r = sine / cosine
        d = np.linspace(0.1, 2, 7)
        x2 = (d * sine / cosine + r / sine) ** 2 - (r * cosine / sine) ** 2
        q = g.carrier.apex + g.carrier.axis + np.sqrt(x2)[:, None] * side + e * d[:, None] * up
        assert found.shape.deviation(q).max() <= 1e-12
        assert found.contains(q).all()


@FEW
@given(points, ways, radii, radii, numbers)
def test_torus_across_axis(
    p: Vector, way: Vector, r: Fraction, more: Fraction, h: Fraction
) -> None:
    """Theorem 4.6 (v): a parabola turned about the torus's axis, parallel to its own (upright)."""
    g = TorusSite(p, way, r + more, r)
    size = Fraction(round(float(sum(c * c for c in way)) ** 0.5))
    f = PlaneSite(on(p, way, -h / size), way)
    for parity, e in (("even", 1), ("odd", -1)):
        found = surface(f, g, parity)
        assert found.shape is not None
        depth = r + e * h
        if depth < 0:
            assert found.kind is Kind.EMPTY
        elif depth == 0:
            # the parabola degenerates into a half line, parallel to the axis
            assert found.kind is Kind.CIRCULAR_CYLINDER
            assert found.shape.parameters["radius"] == pytest.approx(float(r + more))
        else:
            assert found.kind is Kind.REVOLVED_PARABOLA
            assert found.degree == 4
            values = found.shape.parameters
            assert values["focal_length"] == pytest.approx(float(depth) / 2)
            assert values["centre_rho"] == pytest.approx(float(r + more))
            assert abs(np.cos(values["tilt"])) == pytest.approx(1)
            check(found)


def test_the_angles_of_the_cone_of_a_cylinder() -> None:
    """Half-angle 45 degrees in the plane of the axis and f's normal."""
    found = surface(PlaneSite((0, 0, 0), (0, 3, 4)), CylinderSite((0, 0, 0), (0, 0, 1), 1))
    assert found.shape is not None
    assert found.shape.parameters["half_angle_x"] == pytest.approx(pi / 4)


@FEW
@given(points, st.permutations(WAYS), angles, numbers)
def test_base_of_the_cone(
    p: Vector, some: list[Vector], angle: tuple[Fraction, Fraction], h: Fraction
) -> None:
    """Theorem 4.6 (iv): the conic where f and g meet is its base; through g's apex its apex too."""
    f = PlaneSite(on(p, some[0], h), some[0])
    g = ConeSite(p, some[1], *angle)
    u, v = across(some[1])
    e1, e2 = (np.array([float(c) for c in w]) for w in (u, v))
    e1, e2 = e1 / np.linalg.norm(e1), e2 / np.linalg.norm(e2)
    t = np.linspace(0, 6, 9)[:, None]
    sine, cosine = (float(a) for a in angle)
    rulings = sine * (np.cos(t) * e1 + np.sin(t) * e2) + cosine * g.carrier.axis
    depth = float(f.carrier.signed_distance(g.carrier.apex))
    with np.errstate(divide="ignore", invalid="ignore"):
        s = -depth / (rulings @ f.carrier.normal_vector)
    met = np.isfinite(s) & (s >= 0) & (s < 1e3)
    section = g.carrier.apex + s[met, None] * rulings[met]
    for parity in PARITIES:
        found = surface(f, g, parity)
        assert found.shape is not None
        assert found.contains(section).all()
        assert found.shape.deviation(section).max(initial=0.0) <= 1e-9 * (1 + s[met].max(initial=0))
        if h == 0 and found.kind in (Kind.CIRCULAR_CONE, Kind.ELLIPTIC_CONE):
            assert np.allclose(found.shape.origin, g.carrier.apex, atol=1e-12)


def test_plane_touches_cone() -> None:
    """Theorem 4.6 (iv) along a ruling: a cone (even), and half a plane (odd)."""
    f, g = PlaneSite((0, 0, 0), (4, 0, -3)), ConeSite((0, 0, 0), (0, 0, 1), "3/5", "4/5")
    kinds = [surface(f, g, parity).kind for parity in PARITIES]
    for parity in PARITIES:
        found = surface(f, g, parity)
        if found.kind.dimension == 2:
            check(found, needed=False)
    assert Kind.ELLIPTIC_CONE in kinds and Kind.GENERAL not in kinds
